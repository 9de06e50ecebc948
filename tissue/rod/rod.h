// tissue/rod/rod.h
// A flexible rod: vessels, ducts and threads as what they are to a touch, a line that stretches,
// bends and twists. Called by the tissue loop, one thread per state and system; made at setup.
//   E = sum over edges of EA/(2 L) (|e| - L)^2
//     + sum over inner nodes of (EI |kappa - kappa0|^2 + GJ (twist - twist0)^2)/(2 l)
//     + sum of springs to the rest place, of nodes and of edges' turn about themselves
// after Bergou et al. 2008 and 2010, without shear (Kirchhoff); l is half of the two edges' rest
// lengths, as far as they are free. What is not straight at rest stays so, and a tube curved at
// rest twists when it bends: hence twist, though the cross-section is round.
// A step is implicit Euler, M (v' - v)/dt + C v' + f_int(x') = f, C = alpha M + beta K at its
// beginning, found as the minimum of its potential by Newton with a line search (Martin et al.
// 2011). The tangent is exact; where it is not positive definite, bending keeps its Gauss-Newton
// part and stretch what a pull adds. It is a band, factored in time linear in the nodes.
//
//   RodModel   what never changes      RodState   places, frames of edges, velocities
//   RodSystem  forces, tangent and its factor at a state; scratch, sized once
// World frame. Unknowns: of node i x, y, z, then the angle of edge i about itself; held left out.
#pragma once

#include "tissue/material/elastic.h"
#include "tissue/rod/band_factor.h"
#include "tissue/rod/rod_bend.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tissue {

/// What a cross-section gives. Round and full: round_section().
struct RodSection {
    double stretch_n = 0.0;   // E A
    double bend_nm2 = 0.0;    // E I, the same about both axes
    double twist_nm2 = 0.0;   // G J
    double mass_kgpm = 0.0;   // rho A
    double inertia_kgm = 0.0; // rho J, about the line
};

/// A = pi r^2, I = pi r^4/4, J = pi r^4/2 of a full round rod; of a tube, less the same of
/// `inner_m`. Throws std::invalid_argument naming the radius or what lame() refuses.
RodSection round_section(const Material& material, double radius_m, double inner_m = 0.0);

struct RodModel {
    Material material;
    std::vector<glm::dvec3> rest_m;
    std::vector<RodFrame> rest_frame;    // per edge
    std::vector<BendStrain> rest_strain; // per node; of the ends 0
    std::vector<RodSection> section;     // per edge
    std::vector<double> length_m;        // per edge, at rest
    std::vector<double> bend_length_m;   // per node, l; 0: does not bend there
    std::vector<double> mass_kg;         // per node
    std::vector<double> inertia_kgm2;    // per edge
    std::vector<double> hold_npm;        // per node, to its rest place, all directions alike
    std::vector<double> hold_turn_nm;    // per edge, against its turn about itself
    std::vector<std::int32_t> dof, spin; // first unknown of a node, that of an edge; -1: held
    std::vector<double> mass;            // per unknown: kg, kg m^2
    std::vector<double> weight_n;        // per unknown
    int unknowns = 0;
};

/// `section`: per edge, or one for all. `held`: a byte per node, 1 = fixed in place; an edge
/// between two held nodes does not turn, bend or twist, so a clamp is two of them, and what is free
/// begins at the second. Throws std::invalid_argument naming the node or value: fewer than two
/// nodes, two in a row at one place, a fold by more than 150 degrees, a size that does not fit, a
/// section that is not above 0. No springs hold it: see hold_by().
RodModel make_rod(std::span<const glm::dvec3> node_m, std::span<const RodSection> section,
                  const Material& material, std::span<const std::uint8_t> held,
                  const glm::dvec3& gravity_mps2);

/// Springs to the rest place: per node, and per edge against turning about itself. Throws
/// std::invalid_argument for a size that does not fit or a value that is negative or not finite.
void hold_by(std::span<const double> npm, std::span<const double> turn_nm, RodModel& model);

struct RodState {
    std::vector<glm::dvec3> position_m, velocity_mps;
    std::vector<RodFrame> frame;    // per edge
    std::vector<double> spin_radps; // per edge
    std::vector<double> turn_rad;   // per edge, about itself since rest
};
RodState rest_state(const RodModel& model);

struct RodSystem {
    double dt_s = 0.0;
    std::vector<double> internal_n; // f_int, per unknown
    BandMatrix tangent;             // K
    BandMatrix damping;             // K at the beginning of the step, positive semidefinite
    BandMatrix factor;              // of A = M (1/dt + alpha)/dt + beta K0/dt + K
    double energy_j = 0.0;
    bool projected = false;                                   // A is not the exact one
    std::vector<double> moved, velocity, right, way, scratch; // per unknown
    RodState trial;
};
RodSystem make_system(const RodModel& model);

struct RodOptions {
    double tolerance = 1e-6; // of the relative residual
    int max_iterations = 30;
};

struct RodReport {
    int iterations = 0;             // linear solves beyond the motion that was given
    double relative_residual = 0.0; // |sum of forces| / sum of their sizes
    bool projected = false;
    bool converged = false;
};

/// Elastic energy and forces (the gradient of it, per unknown). Real-time safe.
double elastic_energy_j(const RodModel& model, const RodState& state) noexcept;
void elastic_forces(const RodModel& model, const RodState& state,
                    std::span<double> internal_n) noexcept;
/// `exact`: the Hessian; else its positive semidefinite part as above.
void elastic_tangent(const RodModel& model, const RodState& state, bool exact,
                     BandMatrix& tangent) noexcept;

/// f_int, K and the factor of A at the beginning of a step. dt_s: infinite for statics.
void linearize(const RodModel& model, const RodState& state, double dt_s,
               RodSystem& system) noexcept;

/// A du = load + weight - f_int + M v/dt, one Newton iteration. `load_n`: per unknown, may be
/// empty.
void free_motion(const RodModel& model, const RodSystem& system, std::span<const double> load_n,
                 std::span<double> du) noexcept;

/// A x = b in place, column after column.
void solve(const RodSystem& system, std::span<double> block, int columns) noexcept;

/// From the motion `du` (that of free_motion() and of contact) on to the end of the step under
/// `load_n`; then linearises there. `du` becomes what was moved. Values that are not finite leave
/// the state as it was, at rest. No allocation.
RodReport end_step(const RodModel& model, std::span<const double> load_n, const RodOptions& options,
                   std::span<double> du, RodSystem& system, RodState& state) noexcept;

/// Adds a motion: places move, frames are carried along and turned.
void move(const RodModel& model, std::span<const double> du, RodState& state) noexcept;

} // namespace tissue
