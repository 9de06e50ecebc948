// Energy, forces and tangent of a rod, edge by edge and node by node. See rod.h.
#include "tissue/rod/rod.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace tissue {
namespace {

using glm::dvec3;

// Edges shorter than this part of their rest length count as this long where one divides by it.
constexpr double kShortest = 0.05;

dvec3 edge_m(const RodState& state, std::size_t e) noexcept {
    return state.position_m[e + 1] - state.position_m[e];
}

double divisor_m(const RodModel& model, const RodState& state, std::size_t e) noexcept {
    return std::max(glm::length(edge_m(state, e)), kShortest * model.length_m[e]);
}

// Stiffness of the three strains of node i, N m: EI/l, EI/l, GJ/l. An edge's section holds for its
// half of l; halves in a row add their compliances.
BendStrain stiffness_nm(const RodModel& model, std::size_t i) noexcept {
    double bend = 0.0, twist = 0.0;
    for (const std::size_t e : {i - 1, i}) {
        if (model.spin[e] < 0)
            continue;
        bend += 0.5 * model.length_m[e] / model.section[e].bend_nm2;
        twist += 0.5 * model.length_m[e] / model.section[e].twist_nm2;
    }
    return {1.0 / bend, 1.0 / bend, 1.0 / twist};
}

struct NodeBend {
    BendStrain strain, stiffness_nm; // strain: beyond that of rest
    double before_m = 0.0, after_m = 0.0;
};

NodeBend bend_at(const RodModel& model, const RodState& state, std::size_t i) noexcept {
    NodeBend b{bend_strain(state.frame[i - 1], state.frame[i]), stiffness_nm(model, i),
               divisor_m(model, state, i - 1), divisor_m(model, state, i)};
    for (std::size_t k = 0; k < 3; ++k)
        b.strain[k] -= model.rest_strain[i][k];
    return b;
}

// Unknowns of a bend: nodes i - 1, i, i + 1 and the angles of the edges between.
using Places = std::array<std::int32_t, 11>;
Places places_of(const RodModel& model, std::size_t i) noexcept {
    Places p{};
    for (std::size_t n = 0; n < 3; ++n) {
        const std::int32_t first = model.dof[i - 1 + n];
        for (std::size_t k = 0; k < 3; ++k)
            p[4 * n + k] = first < 0 ? -1 : first + static_cast<std::int32_t>(k);
    }
    p[3] = model.spin[i - 1];
    p[7] = model.spin[i];
    return p;
}

// (e, theta_e, f, theta_f) by (x-, theta_e, x, theta_f, x+): e = x - x-, f = x+ - x
using Spread = std::array<double, 11>;
Spread spread(const BendGradient& g) noexcept {
    Spread s{};
    for (std::size_t k = 0; k < 3; ++k) {
        s[k] = -g[k];
        s[4 + k] = g[k] - g[4 + k];
        s[8 + k] = g[4 + k];
    }
    s[3] = g[3];
    s[7] = g[7];
    return s;
}

void add(const Places& places, std::size_t r, std::size_t c, double value,
         BandMatrix& matrix) noexcept {
    const std::int32_t row = places[r], column = places[c];
    if (row >= 0 && column >= 0 && row >= column)
        matrix.value[matrix.at(row, column)] += value;
}

void add_stretch(const RodModel& model, const RodState& state, std::size_t e, bool exact,
                 BandMatrix& tangent) noexcept {
    const double modulus_n = model.section[e].stretch_n, rest_m = model.length_m[e];
    const double now_m = glm::length(edge_m(state, e));
    const double pull_n = modulus_n * (now_m / rest_m - 1.0);
    const dvec3 t = state.frame[e].tangent;
    const double across = (exact ? pull_n : std::max(pull_n, 0.0)) / divisor_m(model, state, e);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            const double k = (modulus_n / rest_m - across) * t[r] * t[c] + (r == c ? across : 0.0);
            const std::int32_t a = model.dof[e], b = model.dof[e + 1];
            if (a >= 0 && r >= c)
                tangent.value[tangent.at(a + r, a + c)] += k;
            if (b >= 0 && r >= c)
                tangent.value[tangent.at(b + r, b + c)] += k;
            if (a >= 0 && b >= 0)
                tangent.value[tangent.at(b + r, a + c)] -= k;
        }
    }
}

void add_bend(const RodModel& model, const RodState& state, std::size_t i, bool exact,
              BandMatrix& tangent) noexcept {
    const NodeBend b = bend_at(model, state, i);
    const auto gradient = bend_gradient(state.frame[i - 1], b.before_m, state.frame[i], b.after_m);
    const Places places = places_of(model, i);
    std::array<Spread, 11> sum{};
    for (std::size_t s = 0; s < 3; ++s) {
        const Spread g = spread(gradient[s]);
        for (std::size_t r = 0; r < 11; ++r) {
            for (std::size_t c = 0; c < 11; ++c)
                sum[r][c] += b.stiffness_nm[s] * g[r] * g[c];
        }
    }
    if (exact) {
        const auto hessian =
            bend_hessian(state.frame[i - 1], b.before_m, state.frame[i], b.after_m);
        BendHessian h{};
        for (std::size_t s = 0; s < 3; ++s) {
            for (std::size_t r = 0; r < 8; ++r) {
                for (std::size_t c = 0; c < 8; ++c)
                    h[r][c] += b.stiffness_nm[s] * b.strain[s] * hessian[s][r][c];
            }
        }
        std::array<Spread, 8> half{};
        for (std::size_t r = 0; r < 8; ++r)
            half[r] = spread(h[r]);
        for (std::size_t c = 0; c < 11; ++c) {
            BendGradient column{};
            for (std::size_t r = 0; r < 8; ++r)
                column[r] = half[r][c];
            const Spread whole = spread(column);
            for (std::size_t r = 0; r < 11; ++r)
                sum[r][c] += whole[r];
        }
    }
    for (std::size_t r = 0; r < 11; ++r) {
        for (std::size_t c = 0; c < 11; ++c)
            add(places, r, c, sum[r][c], tangent);
    }
}

// Springs to the rest place and against turning: the sum of their energies.
double held_energy_j(const RodModel& model, const RodState& state) noexcept {
    double sum_j = 0.0;
    for (std::size_t i = 0; i < model.rest_m.size(); ++i) {
        const dvec3 away_m = state.position_m[i] - model.rest_m[i];
        sum_j += 0.5 * model.hold_npm[i] * glm::dot(away_m, away_m);
    }
    for (std::size_t e = 0; e < model.length_m.size(); ++e)
        sum_j += 0.5 * model.hold_turn_nm[e] * state.turn_rad[e] * state.turn_rad[e];
    return sum_j;
}

void add_held_forces(const RodModel& model, const RodState& state,
                     std::span<double> internal_n) noexcept {
    for (std::size_t i = 0; i < model.rest_m.size(); ++i) {
        for (int k = 0; k < 3 && model.dof[i] >= 0; ++k)
            internal_n[static_cast<std::size_t>(model.dof[i] + k)] +=
                model.hold_npm[i] * (state.position_m[i][k] - model.rest_m[i][k]);
    }
    for (std::size_t e = 0; e < model.length_m.size(); ++e) {
        if (model.spin[e] >= 0)
            internal_n[static_cast<std::size_t>(model.spin[e])] +=
                model.hold_turn_nm[e] * state.turn_rad[e];
    }
}

void add_held_tangent(const RodModel& model, BandMatrix& tangent) noexcept {
    for (std::size_t i = 0; i < model.rest_m.size(); ++i) {
        for (int k = 0; k < 3 && model.dof[i] >= 0; ++k)
            tangent.value[tangent.at(model.dof[i] + k, model.dof[i] + k)] += model.hold_npm[i];
    }
    for (std::size_t e = 0; e < model.length_m.size(); ++e) {
        if (model.spin[e] >= 0)
            tangent.value[tangent.at(model.spin[e], model.spin[e])] += model.hold_turn_nm[e];
    }
}

} // namespace

double elastic_energy_j(const RodModel& model, const RodState& state) noexcept {
    double sum_j = held_energy_j(model, state);
    for (std::size_t e = 0; e < model.length_m.size(); ++e) {
        const double longer_m = glm::length(edge_m(state, e)) - model.length_m[e];
        sum_j += 0.5 * model.section[e].stretch_n / model.length_m[e] * longer_m * longer_m;
    }
    for (std::size_t i = 1; i + 1 < model.rest_m.size(); ++i) {
        if (!(model.bend_length_m[i] > 0.0))
            continue;
        const NodeBend b = bend_at(model, state, i);
        for (std::size_t s = 0; s < 3; ++s)
            sum_j += 0.5 * b.stiffness_nm[s] * b.strain[s] * b.strain[s];
    }
    return sum_j;
}

void elastic_forces(const RodModel& model, const RodState& state,
                    std::span<double> internal_n) noexcept {
    std::fill(internal_n.begin(), internal_n.end(), 0.0);
    add_held_forces(model, state, internal_n);
    for (std::size_t e = 0; e < model.length_m.size(); ++e) {
        const double pull_n =
            model.section[e].stretch_n * (glm::length(edge_m(state, e)) / model.length_m[e] - 1.0);
        for (int k = 0; k < 3; ++k) {
            const double part_n = pull_n * state.frame[e].tangent[k];
            if (model.dof[e] >= 0)
                internal_n[static_cast<std::size_t>(model.dof[e] + k)] -= part_n;
            if (model.dof[e + 1] >= 0)
                internal_n[static_cast<std::size_t>(model.dof[e + 1] + k)] += part_n;
        }
    }
    for (std::size_t i = 1; i + 1 < model.rest_m.size(); ++i) {
        if (!(model.bend_length_m[i] > 0.0))
            continue;
        const NodeBend b = bend_at(model, state, i);
        const auto gradient =
            bend_gradient(state.frame[i - 1], b.before_m, state.frame[i], b.after_m);
        const Places places = places_of(model, i);
        for (std::size_t s = 0; s < 3; ++s) {
            const Spread g = spread(gradient[s]);
            for (std::size_t k = 0; k < 11; ++k) {
                if (places[k] >= 0)
                    internal_n[static_cast<std::size_t>(places[k])] +=
                        b.stiffness_nm[s] * b.strain[s] * g[k];
            }
        }
    }
}

void elastic_tangent(const RodModel& model, const RodState& state, bool exact,
                     BandMatrix& tangent) noexcept {
    std::fill(tangent.value.begin(), tangent.value.end(), 0.0);
    add_held_tangent(model, tangent);
    for (std::size_t e = 0; e < model.length_m.size(); ++e)
        add_stretch(model, state, e, exact, tangent);
    for (std::size_t i = 1; i + 1 < model.rest_m.size(); ++i) {
        if (model.bend_length_m[i] > 0.0)
            add_bend(model, state, i, exact, tangent);
    }
}

} // namespace tissue
