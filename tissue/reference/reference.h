// tissue/reference/reference.h
// The solver that the others are measured by: ten-node tetrahedra, finite strain, every step
// converged. Slow and accurate; called by studies, tests and setup, never by a loop.
//   statics:         f_int(x) = f
//   implicit Euler:  M (v' - v)/dt + C v' + f_int(x') = f, x' = x + dt v'
//   midpoint:        M (v' - v)/dt + C (v + v')/2 + f_int((x + x')/2) = f, x' = x + dt (v + v')/2
//   C = alpha M + beta K, K the tangent at the beginning of the step, as in corotated.h
// With a Prony series f_int is that of prony.h: in a step, what it makes of the memory in dt; in
// statics what is left of it after a long time, and all memory is relaxed then.
// Total Lagrangian, displacements only, four quadrature points (Zienkiewicz & Taylor 2005), mass
// consistent, so that on straight tetrahedra everything but neo-Hooke's energy is integrated
// exactly. The root is found as a minimum of the (incremental) potential by Newton with a line
// search; where the tangent is not positive definite, its negative eigenvalues are dropped point by
// point (Teran et al. 2005). Where that fails, the load is applied in parts: x(s) with
// r(x(s)) = (1 - s) r(x_start), s from 0 to 1, halved and doubled as needed.
//
//   ReferenceModel   what never changes: mesh, law, masses, patterns
//   ReferenceState   x and v of all nodes, and what the points remember
//   ReferenceSystem  K, f_int and the factor at a state; scratch, may be used again
// World frame = rest frame. No function keeps or shares anything: one thread per state and system.
#pragma once

#include "tissue/material/prony.h"
#include "tissue/mesh/elastic_bed.h"
#include "tissue/mesh/quadratic_mesh.h"
#include "tissue/solver/sparse_factor.h"

#include <glm/vec3.hpp>

namespace tissue {

/// Flags of a node's components that do not follow from equilibrium but stay, or go where told.
inline constexpr std::uint8_t kHeldX = 1, kHeldY = 2, kHeldZ = 4, kHeld = 7;

struct ReferencePoint {
    std::array<glm::dvec3, 10> gradient_1pm; // of the shape functions, rest frame
    double volume_m3;                        // rest volume that the point stands for
};

struct ReferenceModel {
    QuadraticMesh mesh;
    Material material;
    Elasticity elasticity;
    glm::dvec3 gravity_mps2{0.0};
    std::vector<std::array<ReferencePoint, 4>> points; // per tet
    std::vector<std::int32_t> unknown;                 // of component 3 node + k; -1: held
    int unknowns = 0;
    // matrices on all components; those of the unknowns alone are what is factored
    SparsePattern all, free;
    std::vector<std::int32_t> free_source;           // entry of `all` for each entry of `free`
    std::vector<std::array<std::int32_t, 55>> block; // where each tet's blocks go, see the .cpp
    std::vector<double> mass_kg;                     // on `all`
    std::vector<double> weight_n;                    // M g, per component
    std::vector<double> bed_npm; // of the springs that hold it, on `all`; empty: none
};

struct ReferenceState {
    std::vector<glm::dvec3> position_m;
    std::vector<glm::dvec3> velocity_mps;
    std::vector<Symmetric> memory{}; // A of each term of point q of tet e, from (4 e + q) terms on
};

struct ReferenceSystem {
    std::vector<double> internal_n; // f_int per component, held ones too: there, the reactions
    std::vector<double> stiffness;  // K on ReferenceModel::all
    double energy_j = 0.0;          // elastic; with a memory that of M, see prony.h
    double min_det_f = 1.0;         // over the quadrature points
    std::vector<double> matrix;     // what was factored, on ReferenceModel::free
    SparseFactor factor;
    std::vector<Symmetric> shear_pa{}; // M of point q of tet e at 4 e + q; empty: elastic
};

/// `held`: a flag byte per node, may be empty. `bed`: its samples belong to the tets of `mesh`;
/// what is elastic below includes it. Throws std::invalid_argument naming the tet, node or value:
/// bad material, a tet that is not positive at a quadrature point, a size that does not fit, a node
/// of no tet, a sample of a tet that the mesh lacks.
ReferenceModel make_reference(const QuadraticMesh& mesh, const Material& material, Law law,
                              std::span<const std::uint8_t> held,
                              const glm::dvec3& gravity_mps2 = glm::dvec3{0.0},
                              std::span<const BedSample> bed = {});
ReferenceState rest_state(const ReferenceModel& model);
ReferenceSystem make_system(const ReferenceModel& model);

/// Dead loads and where to go. Both per node, or empty: none, and stay.
struct ReferenceLoad {
    std::span<const glm::dvec3> force_n;
    std::span<const glm::dvec3> held_m; // read in held components only
};

struct NewtonOptions {
    double tolerance = 1e-10; // of the relative residual
    int max_iterations = 40;  // in each part of the load
    int max_halvings = 10;    // of the load, before giving up
    // with the last factor, wherever it came from, before a new one is made; 0: one in each
    // iteration, which also tells whether the tangent is positive definite everywhere
    int products = 0;
};

struct NewtonReport {
    int iterations = 0;   // linear solves, all parts of the load together, failed ones too
    int factors = 0;      // of these, with a factor of their own
    int projected = 0;    // of these, with a projected tangent
    int parts = 0;        // in which the load was applied
    double reached = 0.0; // share of the load: 1 if all of it was
    // |residual on the unknowns| / (|f| + |f_int| + |inertia, damping|) on all components
    double relative_residual = 0.0;
    double energy_j = 0.0;  // elastic
    double min_det_f = 0.0; // over the quadrature points
    bool converged = false;
};

/// Static equilibrium from `state`, where Newton starts and det F must be positive; velocities end
/// at 0. Parts of the way lead straight to the places of held components: turn a body in steps. If
/// no equilibrium is found (loose body, too much load) `state` is the last equilibrium under a part
/// of the load. A tolerance below rounding is reported as not converged too; `state` is then as
/// good as it gets. Throws std::invalid_argument for a size that does not fit.
NewtonReport solve_static(const ReferenceModel& model, const ReferenceLoad& load,
                          const NewtonOptions& options, ReferenceSystem& system,
                          ReferenceState& state);

enum class TimeRule { implicit_euler, midpoint };

/// One step of dt_s > 0; held components move to ReferenceLoad::held_m, and have the velocity that
/// the rule gives any other (by the midpoint rule that of a way with a jump in speed rings). If no
/// root is found `state` is as it was (NewtonReport::reached < 1). The report is at x', or at
/// (x + x')/2. Throws as solve_static().
NewtonReport step(const ReferenceModel& model, const ReferenceLoad& load, double dt_s,
                  TimeRule rule, const NewtonOptions& options, ReferenceSystem& system,
                  ReferenceState& state);

/// f_int, K, energy and min det F at `state`, at once. `projected`: K from projected tangents.
void linearize(const ReferenceModel& model, const ReferenceState& state, ReferenceSystem& system,
               bool projected = false);

/// Infinite if turned inside out under neo-Hooke. Of a body that has rested, moved at once.
double elastic_energy_j(const ReferenceModel& model, std::span<const glm::dvec3> position_m);

/// With the sign of f_int, on every node: at equilibrium, load + reaction = elastic - weight. Of a
/// body that has rested, moved at once.
void elastic_forces(const ReferenceModel& model, std::span<const glm::dvec3> position_m,
                    std::span<glm::dvec3> force_n);

/// The same with what the points remember: the stress now, and the energy that could be had back.
void internal_forces(const ReferenceModel& model, const ReferenceState& state,
                     std::span<glm::dvec3> force_n);
double stored_energy_j(const ReferenceModel& model, const ReferenceState& state);

} // namespace tissue
