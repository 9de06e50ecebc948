// haptics/contact/grasp.h
// Jaws closed on skin: friction with a bilateral normal and its own limit. A grasp ties the tip to
// a material point y at the offset r0 that carries no force; both loops solve the same law, as a
// block of contact_rows.h:
//
//   compression, F.n > 0:  r0.n - n.(p - y) = law(F.n)       as without jaws: closing and opening
//                                                            on pressed skin change nothing
//   tension:               r0.n - n.(p - y) = C_n F.n        a disc stuck to the skin, see
//   across n:              r0_t - (p - y)_t = C_t F_t        grasp_compliance()
//   limit:  |F_t + min(F.n, 0) n| <= hold: half a ball closed by a cylinder. Beyond it the skin
//   slips
//           along the force (maximum dissipation): across n the material point follows, along n
//           the skin slips out of the jaws, and a bite's length of that ends the grasp.
//
// Jaws do not turn a fold: r0 keeps its direction in the world while the skin turns under it.
#pragma once

#include "haptics/contact/contact_rows.h"
#include "haptics/contact/jaws.h"

namespace haptics {

/// A tip this far above the skin below it still takes it when its jaws close. Design value.
inline constexpr double kGraspReach_m = 1.5e-3;
/// Skin that may slip out of the jaws before they hold nothing. Design value.
inline constexpr double kBite_m = 5e-3;

/// Opens the jaws: what is left is a contact that may press and rub but not pull.
void release_grasp(ContactMemory& memory) noexcept;

/// Closes the jaws on what `row` is over, `row.surface_free_m` being the skin before this step.
/// False, and nothing changed: rigid, or beyond kGraspReach_m. Real-time safe.
bool begin_grasp(const ContactRow& row, const JawGrip& grip, ContactMemory& memory) noexcept;

/// Minimiser of F.A F / 2 - b.F over |F| <= radius and F.z <= 0: the pull that comes nearest to
/// holding. (A + multiplier) F = b across whatever of F is free. A symmetric positive, radius > 0.
struct PullPoint {
    glm::dvec3 f{0.0};
    double multiplier = 0.0;
};
PullPoint pull_minimum(const glm::dmat3& A, const glm::dvec3& b, double radius) noexcept;

} // namespace haptics
