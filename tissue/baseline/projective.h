// tissue/baseline/projective.h
// Projective dynamics (Bouaziz, Martin, Liu, Kavan & Pauly 2014): implicit Euler, whose elastic
// forces pull every tet to its nearest rotation and to its nearest shape of rest volume;
// projections tet by tet, then one global system with a matrix that never changes. Studies and
// tests, see baseline.h.
//   psi = mu |F - R|^2 + 3/2 lambda |F - D|^2, R the nearest rotation, D the nearest with det D = 1
//   [(1 + alpha h) M/h^2 + L] dx = -[M/h^2 ((1 + alpha h)(x' - x) - h v) - f + f_el(x')]
//   L = sum V (2 mu + 3 lambda) G G^T, for each of x, y, z
// 3/2 lambda, because to first order |F - D|^2 = (tr e)^2/3: psi has the tangent of linear
// elasticity at rest. With nu = 0 it is the corotated energy.
// What a global solve takes for the stiffness of a mode, k_L, is that of |F|^2: rotations count. A
// mode of true stiffness k comes nearer to the step's solution by r = (k_L - k)/(m/h^2 + k_L) in
// each iteration, which is near 1 where bodies bend, or where lambda is large. Few iterations end
// near where they began:
//   inertial  x + h v + h^2 a, as in the paper: forces are missing; a mode sags under a steady load
//             by (1 + k h^2/m r^n)/(1 - r^n) of what it should. Modes that the rotations couple
//             may as well rest too stiff: with nu = 0.45 and ten iterations beams do
//   resting   x: right when it rests, but one iteration is implicit Euler with a damper h (k_L - k)
#pragma once

#include "tissue/baseline/baseline.h"

namespace tissue {

enum class ProjectiveStart { inertial, resting };

struct ProjectiveModel {
    CorotatedModel body;
    SparsePattern pattern{}; // of the global matrix: a row for each free node
    int iterations = 10;     // local and global, of every step
    ProjectiveStart start = ProjectiveStart::inertial;
};

struct ProjectiveScratch {
    double dt_s = 0.0; // of the factor; 0: none yet
    bool factored = false;
    std::vector<double> matrix; // on ProjectiveModel::pattern
    std::vector<double> change; // residual, then dx: x of all free nodes, then y, then z
    std::vector<glm::dvec3> before_m, force_n;
    SparseFactor factor;
};

/// Throws as make_corotated().
ProjectiveModel make_projective(const TetMesh& mesh, const Material& material,
                                std::span<const std::uint8_t> anchored,
                                const glm::dvec3& gravity_mps2 = glm::dvec3{0.0});
ProjectiveScratch make_scratch(const ProjectiveModel& model);

/// `load_n` per node, constant during the step; may be empty. Factors if `dt_s` is not that of the
/// last step. The residual is what the last global solve found, so that of one iteration less;
/// relative to |M (v/h + a)| + |elastic forces| of free nodes. If there is no factor (not a number)
/// it is 1, and the bodies end where they began their iterations.
BaselineReport step(const ProjectiveModel& model, std::span<const glm::dvec3> load_n, double dt_s,
                    ProjectiveScratch& scratch, BaselineState& state) noexcept;

/// Elastic force of the tets on every node, with the sign of f_int.
void elastic_forces(const ProjectiveModel& model, const BaselineState& state,
                    std::span<glm::dvec3> force_n) noexcept;
/// V psi over the tets, J.
double elastic_energy_j(const ProjectiveModel& model, const BaselineState& state) noexcept;

} // namespace tissue
