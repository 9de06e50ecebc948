// tissue/reference/reference_element.h
// One ten-node tetrahedron of a reference body: its deformation, and the way of its 3x3 blocks
// into the sparse matrices. Internal to the reference solver.
#pragma once

#include "tissue/reference/reference.h"

#include <glm/matrix.hpp>

namespace tissue {

/// F = I + sum u_a G_a^T. From displacements, not places: in a place, rounding is a part of the
/// distance from the origin, and K magnifies it.
inline glm::dmat3 deformation_gradient(const ReferenceModel& model, std::size_t tet,
                                       const ReferencePoint& point,
                                       std::span<const glm::dvec3> moved_m) noexcept {
    glm::dmat3 F(1.0);
    for (std::size_t a = 0; a < 10; ++a) {
        F += glm::outerProduct(moved_m[model.mesh.tets[tet][a]], point.gradient_1pm[a]);
    }
    return F;
}

/// Adds block (a, b) of a tet, rows a, columns b <= a, to a lower triangle on ReferenceModel::all.
/// `k` counts the blocks: (0,0), (1,0), (1,1), (2,0), ... Each column of a node is one entry
/// shorter than the one before.
inline void add_block(const ReferenceModel& model, std::size_t tet, std::size_t a, std::size_t b,
                      std::size_t k, const glm::dmat3& block, std::span<double> values) noexcept {
    const std::uint32_t row = model.mesh.tets[tet][a], column = model.mesh.tets[tet][b];
    const bool turned = row < column;
    const int* start = &model.all.column_start[3 * (turned ? row : column)];
    for (int c = 0; c < 3; ++c) {
        double* to = values.data() + model.block[tet][k] + start[c] - start[0] - c;
        for (int r = row == column ? c : 0; r < 3; ++r)
            to[r] += turned ? block[r][c] : block[c][r];
    }
}

/// linearize() and elastic_energy_j() at displacements, under M of each point (none: elastic).
void linearize_at(const ReferenceModel& model, std::span<const glm::dvec3> moved_m,
                  ReferenceSystem& system, bool projected);
double energy_at_j(const ReferenceModel& model, std::span<const Symmetric> shear_pa,
                   std::span<const glm::dvec3> moved_m);

/// Force of the bed per component, 0 without one; and its energy.
std::vector<double> bed_force_n(const ReferenceModel& model, std::span<const glm::dvec3> moved_m);
double half_work_j(std::span<const double> force_n, std::span<const glm::dvec3> moved_m) noexcept;

/// P of point q of a tet under its M.
inline glm::dmat3 piola_at_pa(const ReferenceModel& model, std::span<const Symmetric> shear_pa,
                              std::size_t tet, std::size_t q, const glm::dmat3& F) noexcept {
    return shear_pa.empty() ? piola_stress_pa(model.elasticity, F)
                            : piola_stress_pa(model.elasticity, shear_pa[4 * tet + q], F);
}

/// ReferenceSystem::shear_pa for a step of dt_s from displacements `moved_m`. In
/// reference_memory.cpp.
void begin_memory(const ReferenceModel& model, const PronyStep& prony,
                  std::span<const Symmetric> memory, std::span<const glm::dvec3> moved_m,
                  ReferenceSystem& system);
/// What is remembered after that step.
void end_memory(const ReferenceModel& model, const PronyStep& prony,
                std::span<const glm::dvec3> from_m, std::span<const glm::dvec3> to_m,
                std::span<Symmetric> memory) noexcept;
/// Throws std::invalid_argument if `memory` is not one of the model.
void check_memory(const ReferenceModel& model, std::span<const Symmetric> memory);

/// x - rest
inline std::vector<glm::dvec3> displacements_m(const ReferenceModel& model,
                                               std::span<const glm::dvec3> position_m) {
    std::vector<glm::dvec3> moved(position_m.begin(), position_m.end());
    for (std::size_t i = 0; i < moved.size(); ++i)
        moved[i] -= model.mesh.rest_m[i];
    return moved;
}

} // namespace tissue
