// haptics/contact/contact_rows.h
// Unilateral, frictional or grasping contact of up to three tools, solved in compliance form. One
// function for both loops: the FEM step hands in rows condensed through its factor, the 1 kHz tick
// rows condensed through the modes of the local model.
//
// Per tool, world axes. W is the compliance of the surface points under the tools: a force F on
// the TOOL (so -F on the tissue) moves surface point i by -sum_j W_ij F_j. With gap normal n
// (out of the tissue), y = y_free - W F, tip centre p and tip radius a:
//   depth  = a - n.(p - y) = law(P),  P = n.F >= 0            (never pulls)
//   stick:  C_t dF_t = -d(p - y)_t   while |F_t| <= mu P;   slip: |F_t| = mu P along the motion
// A contact that jaws hold pulls as well: haptics/contact/grasp.h.
#pragma once

#include "haptics/contact/contact_law.h"

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace haptics {

inline constexpr int kTools = 3;

struct ContactRow {
    bool active = false; // false: tool is not near anything, force is zero
    glm::dvec3 tip_m{0.0};
    glm::dvec3 surface_free_m{0.0};   // surface point if no tool pushed
    glm::dvec3 normal{0.0, 0.0, 1.0}; // unit, out of the tissue
    double tip_radius_m = 0.0;
    double friction = 0.0; // Coulomb coefficient
    double hold_n = 0.0;   // pull that a grasp bears; > 0 while memory.grasped
    LocalLaw law;
};

struct ContactProblem {
    std::array<ContactRow, kTools> row;
    std::array<std::array<glm::dmat3, kTools>, kTools> compliance{}; // m/N, symmetric as 9x9
};

/// What a contact remembers from one solve to the next. Zero it when contact tracking restarts.
struct ContactMemory {
    bool touching = false;
    glm::dvec3 friction_n{0.0}; // tangential part of the force on the tool
    glm::dvec3 lag_m{0.0};      // (p - y)_t belonging to friction_n
    double x = 0.0;             // root of the law, the warm start
    bool grasped = false;       // jaws hold the contact point; touching as well
    glm::dvec3 grip_m{0.0};     // r0: p - y at which the grasp carries no force
    double out_m = 0.0;         // skin that has slipped out of the jaws
};

/// At most this many Gauss-Seidel sweeps; two tools a millimetre apart need some dozens.
inline constexpr int kMaxSweeps = 200;

struct ContactSolution {
    std::array<glm::dvec3, kTools> force_n{}; // on the tool
    std::array<glm::dvec3, kTools> slip_m{};  // tangential slip of the tip over the surface
    int sweeps = 0;
    double residual_m = 0.0; // worst violated equation, metres
};

/// Block Gauss-Seidel over the tools, each block (normal law, then Coulomb disc) solved exactly,
/// warm-started from `memory`, at most kMaxSweeps sweeps. Updates `memory`.
/// Real-time safe. Non-finite input gives zero force and residual infinity.
ContactSolution solve_contact(const ContactProblem& problem,
                              std::array<ContactMemory, kTools>& memory) noexcept;

/// How far the contact point will slip for this tip position, judged before the solve from the
/// last normal force and friction: the whole tangential offset if not touching or frictionless,
/// else what the stick trial exceeds the Coulomb disc by. Carry the point by this, solve, then
/// apply the solution's remaining slip. Not for a grasp, which only the solve may let slip.
/// `own_compliance`: this tool's W_ii. Real-time safe.
glm::dvec3 predicted_slip(const ContactRow& row, const glm::dmat3& own_compliance,
                          const ContactMemory& memory) noexcept;

} // namespace haptics
