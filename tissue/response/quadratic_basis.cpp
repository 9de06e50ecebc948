// The contact basis of a quadratic body. Tissue loop, after every step with a tool near.
//
// A is never assembled, and a solve is a few iterations of conjugate gradients. A Galerkin basis
// does not need exact columns: what matters is the space they span, and K in it is exact, because
// each column is multiplied by it. So columns x come from rough solves and are carried with m = M x
//   V = X L^-T, L L^T = X^T M X;  V^T A V = of_m 1 + of_k V^T K V = U (of_m + of_k Lambda) U^T
//
// How rough: a residual of 0.15. Compliances of the contact from the modes against exact ones, a
// block of 495 nodes pressed by up to 30 % of its height at three places, all three directions: off
// by 0.3 % for steps of 10 ms; in statics by up to 1.8 % tangentially, exact columns by 1.6 %, and
// at 1 ms exact ones by 3 % normally and 28 % tangentially, for the modes are those of 10 ms steps
// (tissue_columns_bench). A fixed number of iterations is not as good: three from nothing were
// exact at rest, but off by 13 % at 30 %, where the factor at rest is far from A. Solves start from
// the modes of the step before: one iteration then is off by 0.02 %.
//
// Columns are kept by contact, for a contact that moved on wants new ones and the others do not.
// Its later moments then rest on its columns of before, so that all eleven are solved for at once:
// in one group of sixteen instead of three, one after the other.
#include "tissue/response/basis_parts.h"
#include "tissue/solver/quadratic_columns.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

struct Work {
    Columns x, mass_x, load;
    std::span<double> vector;
};

Work split(ContactBasis& basis, std::size_t n) noexcept {
    double* p = basis.work.data();
    const std::size_t wide = n * kMaxBasis;
    return {{p, n}, {p + wide, n}, {p + 2 * wide, n}, {p + 3 * wide, n}};
}

// One column of those that are kept.
struct Item {
    int slot, column;
};
struct Items {
    std::array<Item, kMaxBasis> item{};
    int count = 0;
    void add(int slot, int column) noexcept { item[count++] = {slot, column}; }
};

int moment_of(bool held, int column) noexcept {
    int moment = 0;
    while (moment + 1 < kMoments && column >= first_of(held, moment + 1))
        ++moment;
    return moment;
}

double* kept(std::vector<double>& columns, std::size_t n, const Item& item) noexcept {
    return columns.data() +
           static_cast<std::size_t>(item.slot * kModesPerContact + item.column) * n;
}

// The load of a column: of the contact itself, or M times a column of the moment before.
void load_of(const QuadraticModel& model, const ContactSurface& surface,
             const BasisContact& contact, const Item& item, ContactBasis& basis,
             double* load) noexcept {
    const auto n = static_cast<std::size_t>(model.unknowns);
    const int moment = moment_of(contact.held, item.column);
    if (moment > 0) {
        const int from =
            first_of(contact.held, moment - 1) + item.column - first_of(contact.held, moment);
        std::copy_n(kept(basis.mass_column, n, {item.slot, from}), n, load);
    } else if (item.column < kCentreLoads) {
        load_centre(model.dof, surface, contact, item.column, {load, n});
    } else {
        load_star(model.dof, surface, contact, item.column - kCentreLoads, {load, n});
    }
}

// x = A^-1 load, roughly, of unit M-norm. A load that moves nothing stays zero.
void solve_items(const QuadraticModel& model, const ContactSurface& surface,
                 std::span<const BasisContact> contacts, std::span<const Item> items,
                 QuadraticSystem& system, const Work& w, ContactBasis& basis) noexcept {
    constexpr QuadraticOptions kRough{.linear_tolerance = 0.15, .max_linear = 8};
    const int count = static_cast<int>(items.size());
    const std::size_t n = w.x.n;
    basis.solved += count;
    for (int j = 0; j < count; ++j) {
        for (std::size_t c = 0; c < contacts.size(); ++c) {
            if (slot_of(contacts, c) == items[j].slot)
                load_of(model, surface, contacts[c], items[j], basis, w.x[j]);
        }
    }
    const std::span<double> all_x = w.x.range(0, count), all_mass = w.mass_x.range(0, count);
    solve_columns(model, kRough, system, all_x, count);
    mass_products(model, all_x, count, system, all_mass);
    for (int j = 0; j < count; ++j) {
        const double *x = w.x[j], *mass_x = w.mass_x[j];
        double norm2 = 0.0;
        for (std::size_t i = 0; i < n; ++i)
            norm2 += x[i] * mass_x[i];
        const double scale = norm2 > 0.0 ? 1.0 / std::sqrt(norm2) : 0.0;
        double* to = kept(basis.column, n, items[j]);
        double* mass_to = kept(basis.mass_column, n, items[j]);
        for (std::size_t i = 0; i < n; ++i) {
            to[i] = scale * x[i];
            mass_to[i] = scale * mass_x[i];
        }
    }
}

// Solves for what is not known. A contact of which nothing is goes moment by moment; whatever waits
// for nothing fills up the sixteens.
void renew_columns(const QuadraticModel& model, const ContactSurface& surface,
                   std::span<const BasisContact> contacts, QuadraticSystem& system, const Work& w,
                   ContactBasis& basis) noexcept {
    Items waiting;
    std::array<Items, kMoments> round;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
        const BasisContact& contact = contacts[c];
        const int slot = slot_of(contacts, c);
        const bool none = contact.kept == KeptColumns::none;
        for (int k = 0; !serve(contact.kept) && k < kModesPerContact; ++k) {
            const int moment = moment_of(contact.held, k);
            const bool star = moment == 0 && k >= kCentreLoads;
            if (none && !star)
                round[moment].add(slot, k);
            else
                waiting.add(slot, k);
        }
    }
    constexpr int kLanes = SingleFactor::kLanes;
    int taken = 0;
    for (int moment = 0; moment < kMoments; ++moment) {
        Items& now = round[moment];
        const bool last = moment + 1 == kMoments || round[moment + 1].count == 0;
        while (taken < waiting.count && (last || now.count % kLanes != 0)) {
            now.item[now.count++] = waiting.item[taken++];
        }
        if (now.count > 0)
            solve_items(model, surface, contacts, std::span(now.item).first(now.count), system, w,
                        basis);
        if (last)
            break;
    }
}

// All columns, moment by moment, into w.x and M times them into w.mass_x. Returns how many.
int gather_columns(std::span<const BasisContact> contacts, const Work& w, ContactBasis& basis,
                   std::array<int, kMoments>& blocks) noexcept {
    int columns = 0;
    for (int moment = 0; moment < kMoments; ++moment) {
        const int first = columns;
        for (std::size_t c = 0; c < contacts.size(); ++c) {
            const bool held = contacts[c].held;
            for (int k = 0; k < columns_of(contacts[c], moment); ++k, ++columns) {
                const Item item{slot_of(contacts, c), first_of(held, moment) + k};
                std::copy_n(kept(basis.column, w.x.n, item), w.x.n, w.x[columns]);
                std::copy_n(kept(basis.mass_column, w.x.n, item), w.x.n, w.mass_x[columns]);
            }
        }
        blocks[moment] = columns - first;
    }
    return columns;
}

// M-orthonormal columns in `q`; by Cholesky factors of the Gram matrix, twice, as in
// contact_basis.cpp. Returns how many.
int orthonormalise(const Work& w, std::span<const int> blocks, int columns, double* q) noexcept {
    const std::size_t n = w.x.n;
    SmallMatrix lower;
    std::array<int, kSmall> kept;
    inner_products(w.x[0], w.mass_x[0], n, columns, lower);
    const int rank = pivoted_cholesky(lower, columns, blocks, kBasisCut * kBasisCut, kept);
    for (int j = 0; j < rank; ++j) {
        std::copy_n(w.x[kept[j]], n, q + static_cast<std::size_t>(j) * n);
        std::copy_n(w.mass_x[kept[j]], n, w.load[j]);
    }
    for (int pass = 0; pass < 2; ++pass) {
        if (pass == 1) {
            inner_products(q, w.load[0], n, rank, lower);
            if (!cholesky(lower, rank))
                return 0;
        }
        divide(lower, q, n, rank);
        divide(lower, w.load[0], n, rank);
    }
    return rank;
}

// A = m M + k K
struct Shares {
    double m, k;
};
Shares shares(const QuadraticModel& model, const QuadraticSystem& system) noexcept {
    const double rate = 1.0 / system.dt_s;
    return {rate * rate + model.material.damping_mass_1ps * rate,
            1.0 + model.material.damping_stiffness_s * rate};
}

// Eigenvectors of Q^T A Q for M-orthonormal columns; false if that is not positive definite.
bool project(const QuadraticModel& model, const Work& w, const double* q, int rank,
             const Shares& of, QuadraticSystem& system, SmallMatrix& turn,
             std::array<double, kSmall>& value) noexcept {
    const std::size_t n = w.x.n;
    stiffness_products(model, {q, n * static_cast<std::size_t>(rank)}, rank, system,
                       w.x.range(0, rank));
    inner_products(q, w.x[0], n, rank, turn);
    for (int j = 0; j < rank; ++j) {
        for (int i = j; i < rank; ++i)
            turn[j][i] = 0.5 * of.k * (turn[j][i] + turn[i][j]) + (i == j ? of.m : 0.0);
    }
    return positive_eigen(turn, rank, value) != 0;
}

// Residual and rate of the modes.
void read_state(const QuadraticModel& model, const QuadraticState& state, QuadraticSystem& system,
                ContactBasis& basis) noexcept {
    const auto n = static_cast<std::size_t>(model.unknowns);
    const Work w = split(basis, n);
    const std::span<double> velocity = w.x.range(0, 1), vector{w.vector.data(), n};
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        for (int k = 0; model.dof[i] >= 0 && k < 3; ++k)
            velocity[model.dof[i] + k] = state.velocity_mps[i][k];
    }
    mass_product(model, velocity, system, vector);
    coefficients(basis, vector, basis.rate);
    internal_force(model, system, vector);
    coefficients(basis, vector, basis.residual);
}

// The modes of M-orthonormal columns in basis.shape; of none if K there is not positive enough even
// without geometric stiffness.
void find_modes(const QuadraticModel& model, const Work& w, int rank, const QuadraticState& state,
                QuadraticSystem& system, ContactBasis& basis) noexcept {
    const std::size_t n = w.x.n;
    double* q = basis.shape.data();
    SmallMatrix turn;
    std::array<double, kSmall> value{};
    const Shares of = shares(model, system);
    bool found = project(model, w, q, rank, of, system, turn, value);
    for (const float share : {0.5f, 0.0f}) { // as in a solve that finds A indefinite
        if (found)
            break;
        scale_geometric_stiffness(share, system);
        found = project(model, w, q, rank, of, system, turn, value);
    }
    basis.modes = found ? rank : 0;
    if (!found)
        return;
    turn_columns(q, turn, n, rank, w.x[0]);
    std::copy_n(w.x[0], n * static_cast<std::size_t>(rank), q);
    for (int j = 0; j < rank; ++j)
        basis.lambda[j] = (value[j] - of.m) / of.k;
    remember_modes(model, basis.shape, {basis.lambda.data(), static_cast<std::size_t>(rank)},
                   system);
    read_state(model, state, system, basis);
}

} // namespace

void follow_contact_basis(const QuadraticModel& model, const QuadraticState& state,
                          QuadraticSystem& system, ContactBasis& basis) noexcept {
    const auto n = static_cast<std::size_t>(model.unknowns);
    basis.solved = 0;
    find_modes(model, split(basis, n), basis.modes, state, system, basis);
}

void compute_contact_basis(const QuadraticModel& model, const ContactSurface& surface,
                           const QuadraticState& state, QuadraticSystem& system,
                           std::span<const BasisContact> contacts, ContactBasis& basis) noexcept {
    basis.modes = basis.solved = 0;
    if (contacts.empty())
        remember_modes(model, {}, {}, system);
    if (contacts.empty() || contacts.size() > kMaxContacts)
        return;
    const auto n = static_cast<std::size_t>(model.unknowns);
    const Work w = split(basis, n);
    std::array<int, kMoments> blocks{};
    renew_columns(model, surface, contacts, system, w, basis);
    const int columns = gather_columns(contacts, w, basis, blocks);
    const int rank = orthonormalise(w, blocks, columns, basis.shape.data());
    find_modes(model, w, rank, state, system, basis);
}

void refresh_contact_basis(const QuadraticModel& model, const QuadraticState& state,
                           QuadraticSystem& system, ContactBasis& basis) noexcept {
    basis.solved = 0;
    read_state(model, state, system, basis);
}

} // namespace tissue
