// tissue/solver/corotated.cpp
// The corotated step: assembly of force and tangent, factorisation, free motion. Tissue loop,
// every step; the part of it that costs time.
#include "tissue/solver/corotated.h"

#include "tissue/solver/corotated_element.h"
#include "tissue/solver/stress.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

// K_ab, see corotated_element.h; block[column][row], as GLM and the pattern have it.
dmat3 tangent_block(const ElementTangent& t, const dvec3& ga, const dvec3& qa, const dvec3& gb,
                    const dvec3& qb) noexcept {
    const double diagonal = t.shear * glm::dot(ga, gb);
    const double along_q = t.spin * glm::dot(ga, qb);
    const dvec3 g = t.dilation * ga, q = t.spin * qb;
    dmat3 block{gb.x * g + qa.x * q - along_q * t.Q[0], gb.y * g + qa.y * q - along_q * t.Q[1],
                gb.z * g + qa.z * q - along_q * t.Q[2]};
    block[0][0] += diagonal;
    block[1][1] += diagonal;
    block[2][2] += diagonal;
    return block;
}

// Lower half of a block on the diagonal; `length` entries in the node's first column.
void add_diagonal(double* values, int place, int length, const dmat3& block) noexcept {
    double* column = values + place;
    column[0] += block[0][0];
    column[1] += block[0][1];
    column[2] += block[0][2];
    column += length;
    column[0] += block[1][1];
    column[1] += block[1][2];
    column[length - 1] += block[2][2];
}

// A block below the diagonal: each column of a node has one entry less above it than the one
// before, hence the strides.
void add_below(double* values, int place, int length, const dmat3& block) noexcept {
    const std::array<int, 3> offset{0, length - 1, 2 * length - 3};
    for (int c = 0; c < 3; ++c) {
        double* column = values + place + offset[c];
        column[0] += block[c][0];
        column[1] += block[c][1];
        column[2] += block[c][2];
    }
}

int first_column_length(const CorotatedModel& model, std::int32_t dof) noexcept {
    return model.pattern.column_start[dof + 1] - model.pattern.column_start[dof];
}

void scatter_tangent(const CorotatedModel& model, std::size_t tet,
                     const std::array<dmat3, 10>& block, double* values) noexcept {
    constexpr std::array<std::array<int, 2>, 6> kPair{
        {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
    const Tet& t = model.mesh.tets[tet];
    const std::array<std::int32_t, 10>& place = model.block[tet];
    std::array<int, 4> length;
    for (int a = 0; a < 4; ++a) {
        if (place[a] < 0)
            continue;
        length[a] = first_column_length(model, model.dof[t[a]]);
        add_diagonal(values, place[a], length[a], block[a]);
    }
    for (int k = 0; k < 6; ++k) {
        const int p = place[4 + k];
        if (p >= 0) {
            add_below(values, p, length[kPair[k][1]], block[4 + k]);
        } else if (p < -1) {
            add_below(values, -2 - p, length[kPair[k][0]], glm::transpose(block[4 + k]));
        }
    }
}

// Rigid translation makes no force: what corner 0 does follows from the other three.
void add_tangent(const CorotatedModel& model, std::size_t tet, const ElementTangent& t,
                 const std::array<dvec3, 4>& g, double* values) noexcept {
    const dvec3 q1 = t.Q * g[1], q2 = t.Q * g[2], q3 = t.Q * g[3];
    const dmat3 k11 = tangent_block(t, g[1], q1, g[1], q1);
    const dmat3 k22 = tangent_block(t, g[2], q2, g[2], q2);
    const dmat3 k33 = tangent_block(t, g[3], q3, g[3], q3);
    const dmat3 k12 = tangent_block(t, g[1], q1, g[2], q2);
    const dmat3 k13 = tangent_block(t, g[1], q1, g[3], q3);
    const dmat3 k23 = tangent_block(t, g[2], q2, g[3], q3);
    const dmat3 k01 = -(k11 + glm::transpose(k12) + glm::transpose(k13));
    const dmat3 k02 = -(k12 + k22 + glm::transpose(k23));
    const dmat3 k03 = -(k13 + k23 + k33);
    const dmat3 k00 = -(k01 + k02 + k03);
    scatter_tangent(model, tet, {k00, k11, k22, k33, k01, k02, k03, k12, k13, k23}, values);
}

double held_npm(const HeldTet& held, int a, int b) noexcept {
    constexpr std::array<std::array<int, 4>, 4> kPlace{
        {{0, 4, 5, 6}, {4, 1, 7, 8}, {5, 7, 2, 9}, {6, 8, 9, 3}}};
    return held.npm[kPlace[a][b]];
}

// Force of the bed on corner a of a held tet.
dvec3 bed_force_n(const CorotatedModel& model, const HeldTet& held, const CorotatedState& state,
                  int a) noexcept {
    dvec3 force{0.0};
    for (int b = 0; b < 4; ++b) {
        const std::uint32_t node = model.mesh.tets[held.tet][b];
        force += held_npm(held, a, b) * (state.position_m[node] - model.mesh.rest_m[node]);
    }
    return force;
}

void assemble_bed(const CorotatedModel& model, const CorotatedState& state,
                  CorotatedSystem& system) noexcept {
    for (const HeldTet& held : model.held) {
        for (int a = 0; a < 4; ++a) {
            const std::int32_t dof = model.dof[model.mesh.tets[held.tet][a]];
            if (dof < 0)
                continue;
            const dvec3 force = bed_force_n(model, held, state, a);
            for (int k = 0; k < 3; ++k)
                system.internal_n[dof + k] += force[k];
        }
        std::array<dmat3, 10> block;
        for (int k = 0; k < 10; ++k)
            block[k] = dmat3(held.npm[k]);
        scatter_tangent(model, held.tet, block, system.stiffness.data());
    }
}

// f_int - f_ext, K, and the peak of the stress on the way.
void assemble(const CorotatedModel& model, const CorotatedState& state, bool exact,
              CorotatedSystem& system) noexcept {
    std::fill(system.stiffness.begin(), system.stiffness.end(), 0.0);
    double* f = system.internal_n.data();
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        for (int k = 0; k < 3; ++k)
            f[model.dof[i] + k] = -model.mass_kg[i] * model.gravity_mps2[k];
    }
    system.inverted = 0;
    double peak2 = 0.0;
    for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
        const ElementShape shape = element_shape(model, e, state.position_m);
        system.inverted += shape.det <= 0.0;
        const std::array<dvec3, 4>& G = model.gradient_1pm[e];
        const dvec3 g1 = shape.rotation * G[1], g2 = shape.rotation * G[2],
                    g3 = shape.rotation * G[3];
        const std::array<dvec3, 4> g{-(g1 + g2 + g3), g1, g2, g3};

        const dmat3 stress_nm = element_stress_nm(model, e, shape);
        const double volume2 = model.volume_m3[e] * model.volume_m3[e];
        peak2 = std::max(peak2, von_mises_squared(stress_nm) / volume2); // not a number: not kept
        for (int a = 0; a < 4; ++a) {
            const std::int32_t dof = model.dof[model.mesh.tets[e][a]];
            if (dof < 0)
                continue;
            const dvec3 force = stress_nm * g[a];
            for (int k = 0; k < 3; ++k)
                f[dof + k] += force[k];
        }
        add_tangent(model, e, element_tangent(model, e, shape, exact), g, system.stiffness.data());
    }
    system.peak_von_mises_pa = std::sqrt(peak2);
    assemble_bed(model, state, system);
}

// A = M/dt^2 + (alpha M + beta K)/dt + K
void combine(const CorotatedModel& model, double dt_s, CorotatedSystem& system) noexcept {
    const double rate = 1.0 / dt_s; // statics: 0
    const double of_k = 1.0 + model.material.damping_stiffness_s * rate;
    const double of_m = rate * rate + model.material.damping_mass_1ps * rate;
    for (std::size_t k = 0; k < system.matrix.size(); ++k) {
        system.matrix[k] = of_k * system.stiffness[k];
    }
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        for (int k = 0; k < 3; ++k) {
            system.matrix[model.pattern.column_start[model.dof[i] + k]] += of_m * model.mass_kg[i];
        }
    }
}

double squared(std::span<const double> v) noexcept {
    double sum = 0.0;
    for (const double x : v)
        sum += x * x;
    return sum;
}

} // namespace

void linearize(const CorotatedModel& model, const CorotatedState& state, double dt_s,
               CorotatedSystem& system, bool exact) noexcept {
    system.dt_s = dt_s;
    system.exact_tangent = exact;
    assemble(model, state, exact, system);
    combine(model, dt_s, system);
    system.factored = system.factor.factor(system.matrix);
    if (system.factored || !exact)
        return;

    // not positive definite: the warped stiffness is
    system.exact_tangent = false;
    assemble(model, state, false, system);
    combine(model, dt_s, system);
    system.factored = system.factor.factor(system.matrix);
}

void follow_tangent(const CorotatedModel& model, std::span<const double> du,
                    CorotatedSystem& system) noexcept {
    const std::span<double> product = std::span(system.work).first(du.size());
    multiply(model.pattern, system.stiffness, du, product);
    for (std::size_t i = 0; i < du.size(); ++i)
        system.internal_n[i] += product[i];
}

StepReport free_motion(const CorotatedModel& model, const CorotatedState& state,
                       CorotatedSystem& system, std::span<double> du) noexcept {
    const auto n = static_cast<std::size_t>(model.unknowns);
    const std::span<double> right = std::span(system.work).first(n);
    const std::span<double> product = std::span(system.work).subspan(n, n);
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        const dvec3 momentum_n = model.mass_kg[i] / system.dt_s * state.velocity_mps[i];
        for (int k = 0; k < 3; ++k) {
            right[model.dof[i] + k] = momentum_n[k] - system.internal_n[model.dof[i] + k];
        }
    }
    StepReport report{0.0, system.exact_tangent, system.inverted};
    if (system.factored) {
        std::copy(right.begin(), right.end(), du.begin());
        system.factor.solve(du, 1);
    } else {
        std::fill(du.begin(), du.end(), 0.0);
    }

    multiply(model.pattern, system.matrix, du, product);
    for (std::size_t i = 0; i < n; ++i)
        product[i] -= right[i];
    const double load2 = squared(right);
    report.relative_residual = load2 > 0.0 ? std::sqrt(squared(product) / load2) : 0.0;
    if (!system.factored)
        report.relative_residual = 1.0; // also where the load is not a number
    return report;
}

void advance(const CorotatedModel& model, std::span<const double> du, double dt_s,
             CorotatedState& state) noexcept {
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        const std::int32_t d = model.dof[i];
        const dvec3 step{du[d], du[d + 1], du[d + 2]};
        state.position_m[i] += step;
        state.velocity_mps[i] = step / dt_s;
    }
}

void elastic_forces(const CorotatedModel& model, const CorotatedState& state,
                    std::span<dvec3> force_n) noexcept {
    std::fill(force_n.begin(), force_n.end(), dvec3{0.0});
    for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
        const ElementShape shape = element_shape(model, e, state.position_m);
        const dmat3 stress_nm = element_stress_nm(model, e, shape);
        for (int a = 0; a < 4; ++a) {
            force_n[model.mesh.tets[e][a]] +=
                stress_nm * (shape.rotation * model.gradient_1pm[e][a]);
        }
    }
    for (const HeldTet& held : model.held) {
        for (int a = 0; a < 4; ++a)
            force_n[model.mesh.tets[held.tet][a]] += bed_force_n(model, held, state, a);
    }
}

double elastic_energy_j(const CorotatedModel& model, const CorotatedState& state) noexcept {
    double sum = 0.0;
    for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
        sum += element_energy_j(model, e, element_shape(model, e, state.position_m));
    }
    for (const HeldTet& held : model.held) {
        for (int a = 0; a < 4; ++a) {
            const std::uint32_t node = model.mesh.tets[held.tet][a];
            sum += 0.5 * glm::dot(bed_force_n(model, held, state, a),
                                  state.position_m[node] - model.mesh.rest_m[node]);
        }
    }
    return sum;
}

} // namespace tissue
