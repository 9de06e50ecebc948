// Modes of a rod. V is made M-orthonormal by Gram and Schmidt, twice (Giraud et al. 2005), because
// M is diagonal and columns are short; its K is projected with the band.
#include "tissue/response/rod_basis.h"

#include "tissue/response/basis_parts.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

using glm::dvec3;

constexpr std::array<dvec3, 3> kAxis{dvec3{1, 0, 0}, dvec3{0, 1, 0}, dvec3{0, 0, 1}};

// `mode` is kept between steps, the rest is scratch.
struct Work {
    Columns mode, raw, product;
};

Work split(ContactBasis& basis, std::size_t n) noexcept {
    double* p = basis.work.data();
    const std::size_t wide = n * kMaxBasis;
    return {{p, n}, {p + wide, n}, {p + 2 * wide, n}};
}

double inner(const RodModel& rod, std::span<const double> a, std::span<const double> b) noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += rod.mass[i] * a[i] * b[i];
    return sum;
}

// The load of a contact point on the rod.
void load_point(const RodBody& model, const ContactSurface& surface, const RodState& state,
                const ContactPoint& at, const dvec3& direction, std::span<double> load) noexcept {
    std::fill(load.begin(), load.end(), 0.0);
    const Triangle& corner = surface.triangles[at.triangle];
    for (int k = 0; k < 3; ++k)
        add_row(model.rod, state, model.vertex[corner[k]], direction, at.weight[k], load);
}

// Makes column `from` of `raw` a unit vector across the modes that are there, and one of them,
// unless it is among them already.
void keep(const RodModel& rod, std::span<const double> raw, const Work& w, int& modes) noexcept {
    const std::span<double> v = w.mode.range(modes, 1);
    std::copy(raw.begin(), raw.end(), v.begin());
    const double whole = std::sqrt(inner(rod, v, v));
    for (int pass = 0; pass < 2; ++pass) {
        for (int j = 0; j < modes; ++j) {
            const std::span<const double> other = w.mode.range(j, 1);
            const double share = inner(rod, other, v);
            for (std::size_t i = 0; i < v.size(); ++i)
                v[i] -= share * other[i];
        }
    }
    const double left = std::sqrt(inner(rod, v, v));
    if (!(left > kBasisCut * whole))
        return;
    for (double& x : v)
        x /= left;
    ++modes;
}

void raw_columns(const RodBody& model, const ContactSurface& surface, const RodState& state,
                 const RodSystem& system, std::span<const BasisContact> contacts, const Work& w,
                 int& modes) noexcept {
    std::array<int, kMaxContacts> first{}; // raw columns of each contact, in the moment before
    int columns = 0;
    for (int moment = 0; moment < kMoments; ++moment) {
        for (std::size_t c = 0; c < contacts.size(); ++c) {
            const BasisContact& contact = contacts[c];
            const int count = (contact.held ? kHeldMoments : kFree)[moment], before = first[c];
            first[c] = columns;
            const std::array<dvec3, 3> free{contact.normal, contact.tangent1, contact.tangent2},
                held{contact.tangent1, contact.tangent2, contact.normal};
            for (int k = 0; k < count; ++k, ++columns) {
                const std::span<double> x = w.raw.range(columns, 1);
                if (moment == 0 && k < kCentreLoads) {
                    load_point(model, surface, state, contact.centre,
                               (contact.held ? held : free)[static_cast<std::size_t>(k)], x);
                } else if (moment == 0) {
                    load_point(model, surface, state,
                               contact.star[static_cast<std::size_t>(k - kCentreLoads)],
                               contact.normal, x);
                } else {
                    const std::span<const double> last = w.raw.range(before + k, 1);
                    for (std::size_t i = 0; i < x.size(); ++i)
                        x[i] = model.rod.mass[i] * last[i];
                }
                solve(system, x, 1);
                const double size = std::sqrt(inner(model.rod, x, x));
                for (double& value : x) // moments grow and shrink by orders
                    value = size > 0.0 ? value / size : 0.0;
                keep(model.rod, x, w, modes);
            }
        }
    }
}

void read_coefficients(const RodBody& model, const RodSystem& system, const Work& w,
                       ContactBasis& basis) noexcept {
    for (int m = 0; m < basis.modes; ++m) {
        const std::span<const double> mode = w.mode.range(m, 1);
        double residual = 0.0, rate = 0.0;
        for (std::size_t i = 0; i < mode.size(); ++i) {
            residual += mode[i] * (system.internal_n[i] - model.rod.weight_n[i]);
            rate += mode[i] * model.rod.mass[i] * system.velocity[i];
        }
        basis.residual[static_cast<std::size_t>(m)] = residual;
        basis.rate[static_cast<std::size_t>(m)] = rate;
    }
}

} // namespace

void compute_contact_basis(const RodBody& model, const ContactSurface& surface,
                           const RodState& state, RodSystem& system,
                           std::span<const BasisContact> contacts, ContactBasis& basis) noexcept {
    basis.modes = 0;
    if (contacts.empty() || contacts.size() > kMaxContacts)
        return;
    const auto n = static_cast<std::size_t>(model.rod.unknowns);
    const Work w = split(basis, n);
    int modes = 0;
    raw_columns(model, surface, state, system, contacts, w, modes);
    modes = std::min(modes, model.rod.unknowns);

    // K between them, positive: where the exact one is not, its part that is
    const BandMatrix& K = system.projected ? system.damping : system.tangent;
    SmallMatrix turn;
    std::array<double, kSmall> value{};
    for (const BandMatrix* stiffness : {&K, static_cast<const BandMatrix*>(&system.damping)}) {
        for (int j = 0; j < modes; ++j)
            multiply(*stiffness, w.mode.range(j, 1), w.product.range(j, 1));
        inner_products(w.mode[0], w.product[0], n, modes, turn);
        if (positive_eigen(turn, modes, value) != 0)
            break;
        if (stiffness == &system.damping)
            return;
    }
    turn_columns(w.mode[0], turn, n, modes, w.raw[0]);
    std::copy_n(w.raw[0], n * static_cast<std::size_t>(modes), w.mode[0]);
    std::copy_n(value.begin(), modes, basis.lambda.begin());
    basis.modes = modes;
    read_coefficients(model, system, w, basis);
    for (int m = 0; m < modes; ++m) {
        double* shape = basis.shape.data() + static_cast<std::size_t>(m * model.unknowns);
        for (std::size_t p = 0; p < model.vertex.size(); ++p) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                shape[3 * p + axis] =
                    row_times(model.rod, state, model.vertex[p], kAxis[axis], w.mode.range(m, 1));
        }
    }
}

void refresh_contact_basis(const RodBody& model, const RodState&, const RodSystem& system,
                           ContactBasis& basis) noexcept {
    read_coefficients(model, system, split(basis, static_cast<std::size_t>(model.rod.unknowns)),
                      basis);
}

} // namespace tissue
