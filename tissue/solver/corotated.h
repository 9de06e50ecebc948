// tissue/solver/corotated.h
// Corotated linear tetrahedra under implicit Euler, one Newton step per step (Mueller & Gross
// 2004), with the exact tangent (Chao et al. 2010; Barbic 2012).
//   A du = M v/dt - f_int(u) + f_ext - H^T F,  A = M/dt^2 + (alpha M + beta K)/dt + K,  v' = du/dt
// K is the tangent at the beginning of the step, in the elastic and in the damping term alike.
// If A is not positive definite the warped stiffness R Ke R^T is used for that step, and said.
// Inverted tets take their warped stiffness in every step.
//
//   CorotatedModel   what never changes: mesh, masses, pattern
//   CorotatedState   x and v of all nodes, and if it recovers: all that a snapshot needs
//   CorotatedSystem  A, its factor and f_int, made at a state; the next step and the local model
//                    both use it
// The pieces of a step are separate so that sim/ can put the contact solve between them.
#pragma once

#include "tissue/material/elastic.h"
#include "tissue/mesh/elastic_bed.h"
#include "tissue/mesh/tet_mesh.h"
#include "tissue/solver/sparse_factor.h"

#include <glm/mat3x3.hpp>
#include <limits>

namespace tissue {

/// What the bed does to one tet: K_ab = npm[ab] I, in the order of CorotatedModel::block.
struct HeldTet {
    std::uint32_t tet = 0;
    std::array<double, 10> npm{};
};

struct CorotatedModel {
    TetMesh mesh;
    Material material;
    double lambda_pa = 0.0, mu_pa = 0.0;
    std::vector<std::array<glm::dvec3, 4>> gradient_1pm; // of the shape functions, rest frame
    std::vector<double> volume_m3;
    std::vector<double> mass_kg;   // per node, lumped
    std::vector<std::int32_t> dof; // first of 3 unknowns of a node; -1: anchored
    int unknowns = 0;
    std::vector<HeldTet> held;    // springs to the rest place, beside the anchored nodes
    glm::dvec3 gravity_mps2{0.0}; // organs rest under gravity: 0; beams: not
    SparsePattern pattern;
    std::vector<std::array<std::int32_t, 10>> block; // where each tet's blocks go, see .cpp
};

struct CorotatedState {
    std::vector<glm::dvec3> position_m;
    std::vector<glm::dvec3> velocity_mps;
    bool recovering = false; // has been inverted and not rested since, see descent.h
};

struct CorotatedSystem {
    double dt_s = 0.0;              // infinity: statics, A = K
    bool exact_tangent = true;      // false: fell back to the warped stiffness
    bool factored = false;          // false: state not finite, or statics of a loose body
    int inverted = 0;               // tets with det F <= 0
    double peak_von_mises_pa = 0.0; // over the tets, see stress.h; follow_tangent() leaves it
    std::vector<double> internal_n; // f_int - f_ext on the unknowns
    std::vector<double> stiffness;  // K on the pattern
    std::vector<double> matrix;     // A on the pattern
    std::vector<double> work;       // two vectors of unknowns
    SparseFactor factor;
};

struct StepReport {
    double relative_residual = 0.0; // |A du - b| / |b|
    bool exact_tangent = true;
    int inverted = 0;
};

/// Throws std::invalid_argument naming the tet or the value; also for a Prony series.
CorotatedModel make_corotated(const TetMesh& mesh, const Material& material,
                              std::span<const std::uint8_t> anchored,
                              const glm::dvec3& gravity_mps2 = glm::dvec3{0.0},
                              std::span<const BedSample> bed = {});
CorotatedState rest_state(const CorotatedModel& model);
CorotatedSystem make_system(const CorotatedModel& model);

/// f_int, K, A and its factor at `state`. No allocation outside CHOLMOD. `exact` false asks for
/// the warped stiffness, for comparison.
void linearize(const CorotatedModel& model, const CorotatedState& state, double dt_s,
               CorotatedSystem& system, bool exact = true) noexcept;

/// Elastic force of the tets and the bed on every node, anchored ones too, with the sign of f_int.
void elastic_forces(const CorotatedModel& model, const CorotatedState& state,
                    std::span<glm::dvec3> force_n) noexcept;

/// After advance() by a small du: f_int follows the tangent, f_int += K du, and A with its factor
/// stays. What is lost is of second order in du; the caller says how far is small.
void follow_tangent(const CorotatedModel& model, std::span<const double> du,
                    CorotatedSystem& system) noexcept;

/// A du = M v/dt - f_int + f_ext + load. `du` has one entry per unknown; it is zero (relative
/// residual 1) if the system could not be factored. `load_n`: of contact; may be empty.
StepReport free_motion(const CorotatedModel& model, const CorotatedState& state,
                       CorotatedSystem& system, std::span<double> du,
                       std::span<const double> load_n = {}) noexcept;

/// u += du, v = du/dt.
void advance(const CorotatedModel& model, std::span<const double> du, double dt_s,
             CorotatedState& state) noexcept;

/// Static equilibrium from `state` by Newton with the exact tangent and a line search on the
/// energy; velocities end at zero. `load_n`: on the unknowns, beside gravity; may be empty.
/// Residual relative to |load and weight| + |elastic forces on all nodes, anchored ones too|.
struct StaticReport {
    int iterations = 0;
    double relative_residual = 0.0;
    bool converged = false;
};
StaticReport solve_static(const CorotatedModel& model, std::span<const double> load_n,
                          double tolerance, int max_iterations, CorotatedState& state);

/// Elastic energy of tets and bed, J, for tests and the energy ledger.
double elastic_energy_j(const CorotatedModel& model, const CorotatedState& state) noexcept;

} // namespace tissue
