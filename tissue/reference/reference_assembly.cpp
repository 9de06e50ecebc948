// tissue/reference/reference_assembly.cpp
// Energy, forces and tangent of a reference body at a state. Called by its Newton; any thread.
#include "tissue/reference/reference_element.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

// K_ab = V G_a . A . G_b
void add_tangent(const Tangent& A, const ReferencePoint& point,
                 std::array<dmat3, 55>& blocks) noexcept {
    const std::array<dvec3, 10>& G = point.gradient_1pm;
    std::size_t k = 0;
    for (std::size_t a = 0; a < 10; ++a) {
        std::array<std::array<double, 9>, 3> half{}; // [component r of a][j of A]
        for (int r = 0; r < 3; ++r) {
            for (int j = 0; j < 9; ++j) {
                half[r][j] = point.volume_m3 *
                             (A[r][j] * G[a].x + A[3 + r][j] * G[a].y + A[6 + r][j] * G[a].z);
            }
        }
        for (std::size_t b = 0; b <= a; ++b, ++k) {
            for (int r = 0; r < 3; ++r) {
                for (int c = 0; c < 3; ++c) {
                    blocks[k][c][r] +=
                        half[r][c] * G[b].x + half[r][3 + c] * G[b].y + half[r][6 + c] * G[b].z;
                }
            }
        }
    }
}

double density_jpm3(const ReferenceModel& model, std::span<const Symmetric> shear_pa,
                    std::size_t tet, std::size_t q, const dmat3& F) noexcept {
    return shear_pa.empty() ? energy_density_jpm3(model.elasticity, F)
                            : energy_density_jpm3(model.elasticity, shear_pa[4 * tet + q], F);
}

} // namespace

std::vector<double> bed_force_n(const ReferenceModel& model, std::span<const dvec3> moved_m) {
    std::vector<double> moved, force(model.unknown.size(), 0.0);
    if (model.bed_npm.empty())
        return force;
    for (const dvec3& u : moved_m)
        moved.insert(moved.end(), {u.x, u.y, u.z});
    multiply(model.all, model.bed_npm, moved, force);
    return force;
}

double half_work_j(std::span<const double> force_n, std::span<const dvec3> moved_m) noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < force_n.size(); ++i)
        sum += 0.5 * force_n[i] * moved_m[i / 3][static_cast<int>(i % 3)];
    return sum;
}

void linearize_at(const ReferenceModel& model, std::span<const dvec3> moved_m,
                  ReferenceSystem& system, bool projected) {
    std::fill(system.internal_n.begin(), system.internal_n.end(), 0.0);
    std::fill(system.stiffness.begin(), system.stiffness.end(), 0.0);
    system.energy_j = 0.0;
    system.min_det_f = std::numeric_limits<double>::infinity();
    for (std::size_t e = 0; e < model.points.size(); ++e) {
        std::array<dmat3, 55> blocks;
        blocks.fill(dmat3(0.0));
        for (std::size_t q = 0; q < 4; ++q) {
            const ReferencePoint& point = model.points[e][q];
            const dmat3 F = deformation_gradient(model, e, point, moved_m);
            system.min_det_f = std::min(system.min_det_f, glm::determinant(F));
            system.energy_j += point.volume_m3 * density_jpm3(model, system.shear_pa, e, q, F);
            const dmat3 P = point.volume_m3 * piola_at_pa(model, system.shear_pa, e, q, F);
            for (std::size_t a = 0; a < 10; ++a) {
                const dvec3 force = P * point.gradient_1pm[a];
                for (int k = 0; k < 3; ++k)
                    system.internal_n[3 * model.mesh.tets[e][a] + k] += force[k];
            }
            Tangent A = system.shear_pa.empty()
                            ? piola_tangent_pa(model.elasticity, F)
                            : piola_tangent_pa(model.elasticity, system.shear_pa[4 * e + q], F);
            if (projected)
                project_positive(A);
            add_tangent(A, point, blocks);
        }
        std::size_t k = 0;
        for (std::size_t a = 0; a < 10; ++a) {
            for (std::size_t b = 0; b <= a; ++b, ++k)
                add_block(model, e, a, b, k, blocks[k], system.stiffness);
        }
    }
    const std::vector<double> bed_n = bed_force_n(model, moved_m);
    system.energy_j += half_work_j(bed_n, moved_m);
    for (std::size_t i = 0; i < bed_n.size(); ++i)
        system.internal_n[i] += bed_n[i];
    for (std::size_t k = 0; k < model.bed_npm.size(); ++k)
        system.stiffness[k] += model.bed_npm[k];
}

double energy_at_j(const ReferenceModel& model, std::span<const Symmetric> shear_pa,
                   std::span<const dvec3> moved_m) {
    double sum = 0.0;
    for (std::size_t e = 0; e < model.points.size(); ++e) {
        for (std::size_t q = 0; q < 4; ++q) {
            const ReferencePoint& point = model.points[e][q];
            const dmat3 F = deformation_gradient(model, e, point, moved_m);
            sum += point.volume_m3 * density_jpm3(model, shear_pa, e, q, F);
        }
    }
    if (!model.bed_npm.empty())
        sum += half_work_j(bed_force_n(model, moved_m), moved_m);
    return sum;
}

double elastic_energy_j(const ReferenceModel& model, std::span<const dvec3> position_m) {
    return energy_at_j(model, {}, displacements_m(model, position_m));
}

} // namespace tissue
