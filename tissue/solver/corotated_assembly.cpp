// tissue/solver/corotated_assembly.cpp
// Force and tangent of all tets and the bed, summed on the pattern. Tissue loop, every step; beside
// the factorisation the part of it that costs time.
#include "tissue/solver/corotated_assembly.h"

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

void add_bed_tangent(const CorotatedModel& model, double* values) noexcept {
    for (const HeldTet& held : model.held) {
        std::array<dmat3, 10> block;
        for (int k = 0; k < 10; ++k)
            block[k] = dmat3(held.npm[k]);
        scatter_tangent(model, held.tet, block, values);
    }
}

void add_bed_forces(const CorotatedModel& model, const CorotatedState& state, double* f) noexcept {
    for (const HeldTet& held : model.held) {
        for (int a = 0; a < 4; ++a) {
            const std::int32_t dof = model.dof[model.mesh.tets[held.tet][a]];
            if (dof < 0)
                continue;
            const dvec3 force = bed_force_n(model, held, state, a);
            for (int k = 0; k < 3; ++k)
                f[dof + k] += force[k];
        }
    }
}

void set_weight(const CorotatedModel& model, double* f) noexcept {
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        for (int k = 0; k < 3; ++k)
            f[model.dof[i] + k] = -model.mass_kg[i] * model.gravity_mps2[k];
    }
}

// Not a number: not kept.
void keep_peak(const CorotatedModel& model, std::size_t tet, const dmat3& stress_nm,
               double& peak2) noexcept {
    const double volume2 = model.volume_m3[tet] * model.volume_m3[tet];
    peak2 = std::max(peak2, von_mises_squared(stress_nm) / volume2);
}

std::array<dvec3, 4> turned_gradients(const CorotatedModel& model, std::size_t tet,
                                      const dmat3& R) noexcept {
    const std::array<dvec3, 4>& G = model.gradient_1pm[tet];
    const dvec3 g1 = R * G[1], g2 = R * G[2], g3 = R * G[3];
    return {-(g1 + g2 + g3), g1, g2, g3};
}

void add_force(const CorotatedModel& model, std::size_t tet, const dmat3& stress_nm,
               const std::array<dvec3, 4>& g, double* f) noexcept {
    for (int a = 0; a < 4; ++a) {
        const std::int32_t dof = model.dof[model.mesh.tets[tet][a]];
        if (dof < 0)
            continue;
        const dvec3 force = stress_nm * g[a];
        for (int k = 0; k < 3; ++k)
            f[dof + k] += force[k];
    }
}

// A tet of a tangle, pulled to its rotation.
void add_tangled(const CorotatedModel& model, const CorotatedState& state, std::size_t tet,
                 const dmat3& R, CorotatedSystem& system) noexcept {
    const ElementShape shape =
        element_shape_about(deformation_gradient(model, tet, state.position_m), R);
    const std::array<dvec3, 4> g = turned_gradients(model, tet, R);
    add_force(model, tet, element_stress_nm(model, tet, shape), g, system.internal_n.data());
    add_tangent(model, tet, element_tangent_about(model, tet), g, system.stiffness.data());
}

} // namespace

dvec3 bed_force_n(const CorotatedModel& model, const HeldTet& held, const CorotatedState& state,
                  int a) noexcept {
    dvec3 force{0.0};
    for (int b = 0; b < 4; ++b) {
        const std::uint32_t node = model.mesh.tets[held.tet][b];
        force += held_npm(held, a, b) * (state.position_m[node] - model.mesh.rest_m[node]);
    }
    return force;
}

void add_mass(const CorotatedModel& model, double of_m, std::span<double> values) noexcept {
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        for (int k = 0; k < 3; ++k)
            values[model.pattern.column_start[model.dof[i] + k]] += of_m * model.mass_kg[i];
    }
}

void assemble(const CorotatedModel& model, const CorotatedState& state, bool exact,
              CorotatedSystem& system, const Tangles* tangles) noexcept {
    std::fill(system.stiffness.begin(), system.stiffness.end(), 0.0);
    double* f = system.internal_n.data();
    set_weight(model, f);
    system.inverted = 0;
    double peak2 = 0.0;
    for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
        if (tangles != nullptr) {
            if (const dmat3* R = rotation_of(*tangles, model.mesh.tets[e])) {
                add_tangled(model, state, e, *R, system);
                continue;
            }
        }
        const ElementShape shape = element_shape(model, e, state.position_m);
        system.inverted += shape.det <= 0.0;
        const std::array<dvec3, 4> g = turned_gradients(model, e, shape.rotation);
        const dmat3 stress_nm = element_stress_nm(model, e, shape);
        keep_peak(model, e, stress_nm, peak2);
        add_force(model, e, stress_nm, g, f);
        add_tangent(model, e, element_tangent(model, e, shape, exact), g, system.stiffness.data());
    }
    system.peak_von_mises_pa = std::sqrt(peak2);
    add_bed_forces(model, state, f);
    add_bed_tangent(model, system.stiffness.data());
}

ForceSums assemble_forces(const CorotatedModel& model, const CorotatedState& state,
                          std::span<double> force_n) noexcept {
    set_weight(model, force_n.data());
    ForceSums sums;
    double peak2 = 0.0;
    for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
        const ElementShape shape = element_shape(model, e, state.position_m);
        sums.inverted += shape.det <= 0.0;
        const dmat3 stress_nm = element_stress_nm(model, e, shape);
        keep_peak(model, e, stress_nm, peak2);
        add_force(model, e, stress_nm, turned_gradients(model, e, shape.rotation), force_n.data());
    }
    add_bed_forces(model, state, force_n.data());
    sums.peak_von_mises_pa = std::sqrt(peak2);
    return sums;
}

void assemble_damping(const CorotatedModel& model, const CorotatedState& state,
                      const Tangles& tangles, std::span<double> values_nspm) noexcept {
    std::fill(values_nspm.begin(), values_nspm.end(), 0.0);
    for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
        if (rotation_of(tangles, model.mesh.tets[e]) != nullptr)
            continue;
        const ElementShape shape = element_shape(model, e, state.position_m);
        add_tangent(model, e, element_tangent(model, e, shape, false),
                    turned_gradients(model, e, shape.rotation), values_nspm.data());
    }
    add_bed_tangent(model, values_nspm.data());
    for (double& value : values_nspm)
        value *= model.material.damping_stiffness_s;
}

} // namespace tissue
