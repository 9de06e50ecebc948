// tissue/response/contact_basis.cpp
// Moment-matched modes of the tissue around the tools. Tissue loop, every step, on its critical
// path: three or four blocked solves and a few tall-skinny products.
//
// Everything is done in the coordinates y = M^(1/2) x, in which M-orthonormal is orthonormal, and
// every column y is carried together with z = M^(-1/2) A x, which is known: it is the load that
// made it. So V^T A V = Q^T Z needs no product with the sparse matrix, and its eigenvectors are
// those of V^T K V, because A = m M + k K with m = 1/dt^2 + alpha/dt and k = 1 + beta/dt. Columns
// that were solved for with another factor are multiplied: a Galerkin basis may be of any columns,
// as long as what A makes of them is what it makes of them now.
//
// Columns are orthonormalised by Cholesky factors of their Gram matrix, twice (CholeskyQR2,
// Yamamoto et al. 2015), with pivoting inside the blocks: it is BLAS 3 throughout, and a relative
// size of 1e-6 is 1e-12 in the Gram matrix, 1e4 above its roundoff.
#include "tissue/response/basis_parts.h"
#include "tissue/solver/sparse_products.h"

#include <algorithm>
#include <cblas.h>
#include <cmath>
#include <functional>

namespace tissue {
namespace {

using glm::dvec3;

struct Work {
    Columns y, z;
    std::span<double> mass, root; // per unknown: m and m^(1/2)
    std::span<double> momentum;
};

Work split(ContactBasis& basis, std::size_t n) noexcept {
    double* p = basis.work.data();
    const std::size_t wide = n * kMaxBasis;
    return {
        {p, n}, {p + wide, n}, {p + 2 * wide, n}, {p + 2 * wide + n, n}, {p + 2 * wide + 2 * n, n}};
}

// z = M y: the load that makes the next moment.
void next_moment(const Work& w, int from, int to) noexcept {
    const double* y = w.y[from];
    double* z = w.z[to];
    for (std::size_t i = 0; i < w.y.n; ++i)
        z[i] = w.mass[i] * y[i];
}

// Both scaled to unit M-norm of y, which is A^-1 z. A load that moves nothing stays zero, and is
// dropped later.
void scale_column(std::span<const double> mass, double* y, double* z) noexcept {
    double norm2 = 0.0;
    for (std::size_t i = 0; i < mass.size(); ++i)
        norm2 += mass[i] * y[i] * y[i];
    const double scale = norm2 > 0.0 ? 1.0 / std::sqrt(norm2) : 0.0;
    for (std::size_t i = 0; i < mass.size(); ++i) {
        y[i] *= scale;
        z[i] *= scale;
    }
}

// y = A^-1 z for `count` columns.
void solve_columns(const Work& w, int first, int count, SparseFactor& factor) noexcept {
    std::copy_n(w.z[first], w.z.n * static_cast<std::size_t>(count), w.y[first]);
    factor.solve(w.y.range(first, count), count);
    for (int j = first; j < first + count; ++j)
        scale_column(w.mass, w.y[j], w.z[j]);
}

void gram(const double* q, std::size_t n, int columns, SmallMatrix& out) noexcept {
    cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, columns, static_cast<int>(n), 1.0, q,
                static_cast<int>(n), 0.0, out.data(), kSmall);
}

// a <- a L^-T, and the same of L^-1 a, of small ones.
void divide_right(const SmallMatrix& lower, int columns, SmallMatrix& a) noexcept {
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, columns, columns,
                1.0, lower.data(), kSmall, a.data(), kSmall);
}
void divide_left(const SmallMatrix& lower, CBLAS_TRANSPOSE turned, int columns,
                 SmallMatrix& a) noexcept {
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, turned, CblasNonUnit, columns, columns, 1.0,
                lower.data(), kSmall, a.data(), kSmall);
}

// Columns of w.y that are orthonormal but for roundoff times their condition go to `q`; what
// makes them wholly so is `rest`, q rest^-T. Of the loads w.z nothing long is made: `projected` is
// rest^-1 q^T (A q) rest^-T, A as it is in y. Returns how many columns there are.
int orthonormalise(const Work& w, std::span<const int> blocks, int columns, double* q,
                   SmallMatrix& rest, SmallMatrix& projected) noexcept {
    const std::size_t n = w.y.n;
    SmallMatrix lower;
    std::array<int, kSmall> kept;
    gram(w.y[0], n, columns, lower);
    const int rank = pivoted_cholesky(lower, columns, blocks, kBasisCut * kBasisCut, kept);
    for (int j = 0; j < rank; ++j)
        std::copy_n(w.y[kept[j]], n, q + static_cast<std::size_t>(j) * n);
    for (int j = 0; j < rank; ++j)
        std::copy_n(w.z[kept[j]], n, w.y[j]);
    divide(lower, q, n, rank);
    gram(q, n, rank, rest);
    if (!cholesky(rest, rank))
        return 0;
    inner_products(q, w.y[0], n, rank, projected);
    divide_right(lower, rank, projected);
    divide_right(rest, rank, projected);
    divide_left(rest, CblasNoTrans, rank, projected);
    return rank;
}

void fill_masses(const CorotatedModel& model, const CorotatedState& state, const Work& w) noexcept {
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        const double root = std::sqrt(model.mass_kg[i]);
        for (int k = 0; k < 3; ++k) {
            w.mass[model.dof[i] + k] = model.mass_kg[i];
            w.root[model.dof[i] + k] = root;
            w.momentum[model.dof[i] + k] = model.mass_kg[i] * state.velocity_mps[i][k];
        }
    }
}

// The load of a contact's j-th column.
void load_first(const CorotatedModel& model, const ContactSurface& surface,
                const BasisContact& contact, int j, std::span<double> load) noexcept {
    if (j < kCentreLoads)
        load_centre(model.dof, surface, contact, j, load);
    else
        load_star(model.dof, surface, contact, j - kCentreLoads, load);
}

// One moment's loads of a contact, from column `at`; those of the moment before begin at `last`.
void loads_of(const CorotatedModel& model, const ContactSurface& surface,
              const BasisContact& contact, int moment, int last, int at, const Work& w) noexcept {
    for (int k = 0; k < columns_of(contact, moment); ++k) {
        if (moment > 0)
            next_moment(w, last + k, at + k);
        else
            load_first(model, surface, contact, k, w.z.range(at + k, 1));
    }
}

// One moment's columns and loads of a contact between the basis, which keeps them, and the work.
void keep(std::span<const BasisContact> contacts, std::size_t c, int moment, int at, const Work& w,
          ContactBasis& basis) noexcept {
    const auto size = w.y.n * static_cast<std::size_t>(columns_of(contacts[c], moment));
    const std::size_t to = kept_at(contacts, c, first_of(contacts[c].held, moment), w.y.n);
    std::copy_n(w.y[at], size, basis.column.data() + to);
    std::copy_n(w.z[at], size, basis.mass_column.data() + to);
}
void recall(std::span<const BasisContact> contacts, std::size_t c, int moment,
            const ContactBasis& basis, int at, const Work& w) noexcept {
    const auto size = w.y.n * static_cast<std::size_t>(columns_of(contacts[c], moment));
    const std::size_t from = kept_at(contacts, c, first_of(contacts[c].held, moment), w.y.n);
    std::copy_n(basis.column.data() + from, size, w.y[at]);
    std::copy_n(basis.mass_column.data() + from, size, w.z[at]);
}

// One moment of what is not kept, a solve for contacts that stand side by side, and keeps it.
// `begin`: the first column of each contact.
void solve_new(std::span<const BasisContact> contacts, int moment,
               const std::array<int, kMaxContacts>& begin, SparseFactor& factor, const Work& w,
               ContactBasis& basis) noexcept {
    for (std::size_t c = 0; c < contacts.size(); ++c) {
        int count = 0;
        const std::size_t from = c;
        for (; c < contacts.size() && contacts[c].kept == KeptColumns::none; ++c)
            count += columns_of(contacts[c], moment);
        if (count == 0)
            continue;
        solve_columns(w, begin[from], count, factor);
        basis.solved += count;
        for (std::size_t k = from; k < c; ++k)
            keep(contacts, k, moment, begin[k], w, basis);
    }
}

// z = A y of the columns that another factor made.
void multiply_followed(const CorotatedModel& model, const CorotatedSystem& system,
                       std::span<const BasisContact> contacts, const Work& w,
                       ContactBasis& basis) noexcept {
    std::array<const double*, kMaxBasis> from{};
    std::array<double*, kMaxBasis> to{};
    std::size_t count = 0;
    int column = 0;
    for (int moment = 0; moment < kMoments; ++moment) {
        for (const BasisContact& contact : contacts) {
            for (int k = 0; k < columns_of(contact, moment); ++k, ++column) {
                if (contact.kept != KeptColumns::space)
                    continue;
                from[count] = w.y[column];
                to[count++] = w.z[column];
            }
        }
    }
    multiply_each(model.pattern, system.matrix, std::span(from).first(count),
                  std::span(to).first(count), basis.shape);
}

// All columns of contacts of which something is known, in one solve: later moments rest on those of
// before. A solve reads the factor, whatever the number of its columns.
void solve_at_once(const CorotatedModel& model, const ContactSurface& surface,
                   std::span<const BasisContact> contacts, SparseFactor& factor, const Work& w,
                   ContactBasis& basis) noexcept {
    const std::size_t n = w.y.n;
    int columns = 0;
    std::array<double*, kMaxBasis> y{}, z{}; // where each is kept
    const Columns load{basis.shape.data(), n};
    for (std::size_t c = 0; c < contacts.size(); ++c) {
        if (contacts[c].kept != KeptColumns::about)
            continue;
        for (int moment = 0, k = 0; moment < kMoments; ++moment) {
            const int before = first_of(contacts[c].held, std::max(0, moment - 1));
            for (int j = 0; j < columns_of(contacts[c], moment); ++j, ++k, ++columns) {
                y[columns] = basis.column.data() + kept_at(contacts, c, k, n);
                z[columns] = basis.mass_column.data() + kept_at(contacts, c, k, n);
                const double* last = basis.column.data() + kept_at(contacts, c, before + j, n);
                if (moment > 0)
                    std::transform(last, last + n, w.mass.data(), load[columns],
                                   std::multiplies<>());
                else
                    load_first(model, surface, contacts[c], j, load.range(columns, 1));
            }
        }
    }
    for (int j = 0; j < columns; ++j)
        std::copy_n(load[j], n, z[j]);
    factor.solve(load.range(0, columns), columns);
    for (int j = 0; j < columns; ++j) {
        std::copy_n(load[j], n, y[j]);
        scale_column(w.mass, y[j], z[j]);
    }
    basis.solved += columns;
}

// The raw columns and their loads, moment by moment. `blocks`: columns of each moment. Returns how
// many in all.
int raw_columns(const CorotatedModel& model, const ContactSurface& surface,
                std::span<const BasisContact> contacts, SparseFactor& factor, const Work& w,
                ContactBasis& basis, std::array<int, kMoments>& blocks) noexcept {
    std::array<int, kMaxContacts> last{}; // first column of each contact, one moment before
    int columns = 0;
    solve_at_once(model, surface, contacts, factor, w, basis);
    for (int moment = 0; moment < kMoments; ++moment) {
        const int first = columns;
        std::array<int, kMaxContacts> begin{};
        for (std::size_t c = 0; c < contacts.size(); ++c) {
            begin[c] = columns;
            if (contacts[c].kept != KeptColumns::none)
                recall(contacts, c, moment, basis, columns, w);
            else
                loads_of(model, surface, contacts[c], moment, last[c], columns, w);
            columns += columns_of(contacts[c], moment);
        }
        solve_new(contacts, moment, begin, factor, w, basis);
        last = begin;
        blocks[moment] = columns - first;
    }
    return columns;
}

} // namespace

ContactBasis make_contact_basis(int unknowns) {
    const auto n = static_cast<std::size_t>(unknowns);
    ContactBasis basis;
    basis.shape.resize(n * kMaxBasis);
    basis.work.resize(3 * n * kMaxBasis + 3 * n);
    basis.column.resize(n * kMaxBasis);
    basis.mass_column.resize(n * kMaxBasis);
    return basis;
}

void compute_contact_basis(const CorotatedModel& model, const ContactSurface& surface,
                           const CorotatedState& state, CorotatedSystem& system,
                           std::span<const BasisContact> contacts, ContactBasis& basis) noexcept {
    basis.modes = basis.solved = 0;
    if (contacts.empty() || contacts.size() > kMaxContacts || !system.factored)
        return;
    const auto n = static_cast<std::size_t>(model.unknowns);
    const Work w = split(basis, n);
    fill_masses(model, state, w);
    std::array<int, kMoments> blocks{};
    const int columns = raw_columns(model, surface, contacts, system.factor, w, basis, blocks);
    multiply_followed(model, system, contacts, w, basis);
    for (int j = 0; j < columns; ++j) {
        for (std::size_t i = 0; i < n; ++i) {
            w.y[j][i] *= w.root[i];
            w.z[j][i] /= w.root[i];
        }
    }

    // eigenvectors of the projected A are those of K
    double* q = basis.shape.data();
    SmallMatrix rest, turn;
    const int rank = orthonormalise(w, blocks, columns, q, rest, turn);
    std::array<double, kSmall> value{};
    if (positive_eigen(turn, rank, value) == 0)
        return;
    divide_left(rest, CblasTrans, rank, turn);
    const double rate = 1.0 / system.dt_s;
    const double of_m = rate * rate + model.material.damping_mass_1ps * rate;
    const double of_k = 1.0 + model.material.damping_stiffness_s * rate;
    turn_columns(q, turn, n, rank, w.z[0]);
    for (int j = 0; j < rank; ++j) {
        basis.lambda[j] = (value[j] - of_m) / of_k;
        double* shape = q + static_cast<std::size_t>(j) * n;
        for (std::size_t i = 0; i < n; ++i)
            shape[i] = w.z[j][i] / w.root[i];
    }
    basis.modes = rank;
    coefficients(basis, system.internal_n, basis.residual);
    coefficients(basis, w.momentum, basis.rate);
}

void refresh_contact_basis(const CorotatedModel& model, const CorotatedState& state,
                           const CorotatedSystem& system, ContactBasis& basis) noexcept {
    basis.solved = 0;
    const Work w = split(basis, static_cast<std::size_t>(model.unknowns));
    fill_masses(model, state, w);
    coefficients(basis, system.internal_n, basis.residual);
    coefficients(basis, w.momentum, basis.rate);
}

} // namespace tissue
