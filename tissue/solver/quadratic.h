// tissue/solver/quadratic.h
// Ten-node tetrahedra, neo-Hooke, implicit Euler in real time: the tier that does not lock.
// Discretisation and energy are those of tissue/reference, mass consistent; tissue loop.
//   M (v' - v)/dt + C v' + f_int(x') = f, x' = x + dt v', C = alpha M + beta K(x)
// With a Prony series f_int is what prony.h makes of the memory in dt: a tensor for mu, no more.
// Newton, each iteration by conjugate gradients (PCG) on the exact tangent, which is never
// assembled. Iterations of PCG per step, mean and most, for a falling beam of 240 tets, 525 nodes,
// 200 steps of 10 ms, each solve to 1e-3, Newton to 1e-3 (tissue_quadratic_bench):
//                                                              nu 0.45       nu 0.49
//   as below                                                   5.0,  10      7.6,  15
//   warped by rotations, as corotated stiffness is             6.2,  13     11.0,  23
//   not warped                                                83.3, 194    more than 237, 600
//   from x + dt v, not from where the last two steps lead      7.1,  17     14.1,  33
//   that, and geometric stiffness from the prediction          7.9,  17     16.4,  38
//   both, and warped by rotations                              9.7,  22     23.7,  62
// - The preconditioner is the factor at rest, warped: W A0^-1 W^T, W = F/J^(1/3) of each node, the
//   mean around it. Rotations keep the shear energy, but a stretched tet changes volume along other
//   ways than one at rest, and K is 10 to 50 mu. With u = W w, J F^-T : grad u is the divergence of
//   w (the contravariant Piola transform): the stiff part stays what was factored.
// - It is solved in single precision (single_factor.h), a tenth of the time of CHOLMOD's solve.
// - A prediction changes volumes by a little, which K makes a pressure. With its geometric
// stiffness
//   the tangent may be indefinite at nu 0.49; with that of the start it is not (keep_stress()).
// - Stresses in double, products in single precision, sixteen tets side by side; rows of the mass
//   in lanes too (before, as scalars, a quarter of the step).
// If the tangent is indefinite all the same, as in a beam that folds up (30 kPa, nu 0.3: in a
// handful of 200 steps, up to 9 ms each), half of its geometric stiffness is dropped for that
// iteration, then all: what is left is provably positive. A body that is inside out recovers, see
// quadratic_recovery.h.
// Bits depend on the instruction set, as they do on the BLAS: AVX-512, AVX2, SSE4 or SSSE3, chosen
// at run time. SSE costs half as much again; the tests were run with each of them.
//
//   QuadraticModel   what never changes: mesh, masses, sixteen tets side by side
//   QuadraticState   x, v, how v changed last, what is remembered: all that a snapshot needs
//   QuadraticSystem  residual, tangent and preconditioner for one dt, made at a state; scratch
// The pieces of a step are separate so that sim/ can put the contact solve between them:
// linearize, solve for any right-hand sides, advance.
#pragma once

#include "tissue/material/hyperelastic.h"
#include "tissue/material/prony.h"
#include "tissue/mesh/elastic_bed.h"
#include "tissue/mesh/quadratic_mesh.h"
#include "tissue/solver/block_scratch.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace tissue {

/// Sixteen tets side by side; where there are fewer, tets without volume between sinks.
struct alignas(64) QuadraticGroup {
    static constexpr int kLanes = 16;
    template <typename T> using Lanes = std::array<T, kLanes>;

    std::array<Lanes<std::int32_t>, 10> node; // times 4: place in a node vector
    // gradient of the barycentric coordinates 1 to 3 at the four points, 3 coordinate + component
    std::array<std::array<Lanes<double>, 9>, 4> gradient_1pm;
    std::array<std::array<Lanes<float>, 9>, 4> gradient_single_1pm;
    std::array<Lanes<double>, 4> volume_m3;
};

/// dP/dF at the points of a group, times their volume: F, C = dJ/dF, and the factors of
///   dP = shear dF + mixed ((F:dF) C + (C:dF) F) + square (C:dF) C + bend dC
struct alignas(64) QuadraticTangent {
    enum : int { kF = 0, kC = 9, kShear = 18, kMixed, kSquare, kBend, kCount };
    std::array<std::array<QuadraticGroup::Lanes<float>, kCount>, 4> point;
};

/// A symmetric tensor at the points of a group, as in Symmetric.
struct alignas(64) QuadraticSymmetric {
    std::array<std::array<QuadraticGroup::Lanes<double>, 6>, 4> point;
};

/// What a memory adds to the tangent, see prony.h: F M, 3 column + row, and M.
struct alignas(64) QuadraticShear {
    enum : int { kFM = 0, kM = 9, kCount = 15 };
    std::array<std::array<QuadraticGroup::Lanes<float>, kCount>, 4> point;
};

struct QuadraticTangents {
    std::vector<QuadraticTangent> elastic{};
    std::vector<QuadraticShear> shear{}; // empty without a memory
};

/// Mean deformation gradient of the tets of a group, times their volume: 3 column + row.
struct alignas(64) QuadraticStretch {
    std::array<QuadraticGroup::Lanes<float>, 9> volume_f_m3;
};

/// A node vector has 4 numbers per node, the last unused, one node more, the sink, and zeros up to
/// a multiple of 16.
template <typename T> using NodeVector = std::vector<T>;

struct QuadraticModel {
    QuadraticMesh mesh;
    Material material;
    Elasticity elasticity;
    double volume_m3 = 0.0;
    std::vector<std::int32_t> dof;              // first of 3 unknowns of a node; -1: anchored
    std::vector<std::int32_t> place_of_unknown; // in a node vector
    std::vector<std::int32_t> fixed;            // places of anchored nodes and the sink
    int unknowns = 0;
    std::vector<QuadraticGroup> groups; // tet e is lane e % 16 of group e / 16
    // tets at a node, and nodes beside a node (itself too) with the consistent mass between them
    std::vector<std::int32_t> tet_start, tet_of_node;
    std::vector<std::int32_t> mass_start, mass_column; // columns times 4
    std::vector<double> mass_kg;
    // what the bed adds between them, the same for x, y and z; empty without a bed
    std::vector<double> bed_npm;
    std::vector<std::array<std::array<std::int32_t, 3>, 55>>
        block_place;             // see quadratic_refactor.h
    NodeVector<double> weight_n; // M g
    // at rest, on the pattern of the unknowns
    SparsePattern pattern;
    std::vector<double> rest_stiffness_npm, rest_mass_kg;
    std::vector<double> rest_bed_npm;   // of this, what the bed adds; empty without one
    std::vector<double> rest_shear_npm; // of this, what mu makes; empty without a memory
};

struct QuadraticState {
    std::vector<glm::dvec3> position_m;
    std::vector<glm::dvec3> velocity_mps;
    std::vector<glm::dvec3> gain_mps; // of velocity in the last step: the next one looks there
    // of each group A of each term, then B^-1 at the end of the last step; empty without a memory
    std::vector<QuadraticSymmetric> memory{};
    bool gains_on = true; // the last gain did not turn against the one before
};

struct QuadraticOptions {
    double linear_tolerance = 1e-3; // |A y - r| / |r| of each linear solve
    // Of Newton's solves it may be as much, where that leaves a third of newton_tolerance: more is
    // lost on the next residual (Dembo, Eisenstat & Steihaug 1982).
    double loosest_linear = 1e-3;
    int max_linear = 200;
    double newton_tolerance = 1e-3; // of the relative residual below, before another iteration
    int max_newton = 4;
};

/// A at a state, what approximates its inverse, and scratch.
struct QuadraticSystem {
    double dt_s = 0.0;
    bool recovering = false;  // A is that of the rest shape, turned as a whole
    glm::dmat3 turned{1.0};   // if it recovers: so far
    double energy_j = 0.0;    // elastic; with a memory that of M, see prony.h
    double shape_j = 0.0;     // of this, what is not of the change of volume
    double potential_j = 0.0; // incremental: its minimum is the step
    double min_det_f = 1.0;   // over the points
    double residual = 0.0;    // relative, see QuadraticReport
    QuadraticTangents tangent{}, tangent_at_start{};
    std::vector<QuadraticStretch> stretch{};
    std::vector<glm::mat3> warp{}; // of each node: mean F around it, of volume 1
    NodeVector<double> start_m{}, moved_m{}, trial_m{}; // displacements from rest
    bool tangent_true = false; // `tangent` is that of moved_m, nothing kept or scaled since
    NodeVector<double> last_way{}, last_inertia_n{}; // moved_m - start_m, B of it without stiffness
    NodeVector<double> momentum_n{};                 // M v/dt + weight + load
    std::vector<double> load_n{};                    // of these, on the unknowns
    NodeVector<double> internal_n{}, inertia_n{}, residual_n{}, way{}, damped_n{};
    NodeVector<float> b{}, x{}, r{}, z{}, p{}, q{};
    std::vector<float>
        scalar_npm{}; // of A between nodes: what mass and bed add, for x, y and z alike
    std::vector<std::int32_t> place_in_order{}; // in a node vector, in elimination order
    std::vector<float> ordered{};
    std::vector<double> unknown{}; // two vectors of unknowns
    std::vector<SingleFactor::Line> lines{};
    SparseFactor exact;                 // of A at rest
    std::vector<double> fixed_matrix{}; // of A, what mass and bed add
    std::vector<glm::mat3> unwarp{};    // inverse of the warp there: `warp` leads on from it
    SingleFactor single{};
    BlockScratch block{};
    std::vector<double> rest_stiffness_npm{}; // K at rest, in a step of dt
    PronyStep prony{};
    std::vector<QuadraticSymmetric> shear_pa{}; // M; empty without a memory
};

struct LinearReport {
    int iterations = 0;             // 0 if solved by the factor alone
    double relative_residual = 0.0; // |A x - b| / |b|
    bool projected = false;         // A was indefinite: from now on without its geometric stiffness
};

struct QuadraticReport {
    int newton_iterations = 0;
    int linear_iterations = 0;
    double linear_residual = 0.0;       // the worst of the step, of its right-hand side
    double linear_force_residual = 0.0; // the same, of all forces as below
    // |residual on the unknowns| / (|f + M v/dt| + |f_int| + |inertia, damping|) on all nodes
    double relative_residual = 0.0;
    double min_det_f = 0.0;
    int projected = 0;       // Newton iterations that had to drop geometric stiffness
    bool recovering = false; // a linear step: the residual above was not looked for and is 1
};

/// Throws as make_reference() does. `anchored`: a byte per node, may be empty. `bed`: springs to
/// the rest place at points of the straight corner tets, seen through the quadratic shapes.
QuadraticModel make_quadratic(const QuadraticMesh& mesh, const Material& material,
                              std::span<const std::uint8_t> anchored,
                              const glm::dvec3& gravity_mps2 = glm::dvec3{0.0},
                              std::span<const BedSample> bed = {});
QuadraticState rest_state(const QuadraticModel& model);

/// For steps of dt_s, finite and > 0, of states of this model. Throws std::invalid_argument naming
/// the value.
QuadraticSystem make_system(const QuadraticModel& model, double dt_s);

/// Residual and tangent where v + gain leads in dt, or v, or at `state` itself: the first that is
/// better than to stand still. If a tet is inside out at `state`, the body recovers: A and residual
/// are those of the linear law about the rest shape. `load_n`: on the unknowns, beside the weight;
/// may be empty. No allocation, here and below.
void linearize(const QuadraticModel& model, const QuadraticState& state, QuadraticSystem& system,
               std::span<const double> load_n = {}) noexcept;

/// Tolerance of a Newton step's linear solve from the residual of the system.
double newton_linear_tolerance(const QuadraticOptions& options,
                               const QuadraticSystem& system) noexcept;

/// A x = b for one right-hand side on the unknowns, at the last linearisation. Starts from the
/// modes of remember_modes(), if any (quadratic_columns.h).
LinearReport solve(const QuadraticModel& model, const QuadraticOptions& options,
                   std::span<const double> b, QuadraticSystem& system,
                   std::span<double> x) noexcept;

/// y = K x and y = M x on the unknowns, K at the last linearisation; a recovering body: as at rest.
void stiffness_product(const QuadraticModel& model, std::span<const double> x,
                       QuadraticSystem& system, std::span<double> y) noexcept;
void mass_product(const QuadraticModel& model, std::span<const double> x, QuadraticSystem& system,
                  std::span<double> y) noexcept;

/// f_int - f_ext on the unknowns where the last step ended or the system was linearised.
void internal_force(const QuadraticModel& model, const QuadraticSystem& system,
                    std::span<double> out_n) noexcept;

/// For those who put contact between: the way to where the system was linearised, and the residual
/// there, on the unknowns. One Newton iteration is du = way + A^-1 residual.
void way_and_residual(const QuadraticModel& model, const QuadraticSystem& system,
                      std::span<double> way_m, std::span<double> residual_n) noexcept;

/// The step without contact, from the linearisation on: du on the unknowns.
QuadraticReport free_motion(const QuadraticModel& model, const QuadraticOptions& options,
                            QuadraticSystem& system, std::span<double> du) noexcept;

/// The end of a step with contact: `du` is way + A^-1 residual under `load_n` instead of that of
/// linearize(), more or less, and Newton goes on from there under it until it is. Leaves A and the
/// residual where the step ends, for right-hand sides there. A recovering body: nothing to be done.
QuadraticReport finish(const QuadraticModel& model, const QuadraticOptions& options,
                       std::span<const double> load_n, QuadraticSystem& system,
                       std::span<double> du) noexcept;

/// x += du, v = du/dt.
void advance(const QuadraticModel& model, const QuadraticSystem& system, std::span<const double> du,
             QuadraticState& state) noexcept;

} // namespace tissue
