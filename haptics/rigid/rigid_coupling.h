// haptics/rigid/rigid_coupling.h
// Virtual coupling in six degrees of freedom: each device drags a virtual tool by a spring and a
// torsion spring; the tools lie where springs and contacts balance. step_rigid calls it; 1 kHz.
//
// Colgate, Stanley, Brown 1995; without mass, so quasi-static, as Wan and McNeely 2003. The
// contacts are linear in the motion of the tools within a tick, and all tools are solved together
// and implicitly: stiff contacts cannot ring among themselves, and the device only ever feels the
// coupling in series with the contacts, never more than the coupling.
//
// What a device may feel (the passivity bound of Colgate and Schenkel 1997 in matrix form,
// sufficient for a symmetric stiffness): B - (T/2) K positive definite, B the device's own damping.
#pragma once

#include "haptics/rigid/contact_clusters.h"
#include "haptics/rigid/rigid_pose.h"
#include "haptics/rigid/spd_system.h"

#include <cstdint>

namespace haptics {

inline constexpr std::uint32_t kMostRigidTools = 3;
inline constexpr std::uint32_t kNoTool = 0xffffffff; // scenery, which stays where it is

/// A contact and its bodies: `second` is pushed along the normal, `first` against it.
struct ToolContact {
    RepresentativeContact contact;
    std::uint32_t first = kNoTool, second = kNoTool;
};
using ToolContactList = Bounded<ToolContact, 144>; // 9 pairs of bodies, 16 each

struct CouplingSpring {
    double stiffness_npm = 0.0;
    double torsion_nmprad = 0.0;
};

/// Physical damping of a device, and its tick.
struct DeviceDamping {
    double force_nspm = 0.5;
    double torque_nmsprad = 1e-3;
    double tick_s = 1e-3;
};

/// The spring that uses `share` of what the device's damping allows: share * 2 b / T.
CouplingSpring safe_spring(const DeviceDamping& device, double share) noexcept;

/// Largest eigenvalue of B^-1/2 (T/2) K B^-1/2: below 1 the device stays passive. K: symmetric,
/// forces then torques about the point whose pose the device sets.
double passivity_share(const Matrix6& stiffness, const DeviceDamping& device) noexcept;

/// Adds a contact's J^T n n^T J, with its spread over the area, to a stiffness about `about_m`.
void add_stiffness(Matrix6& stiffness, const RepresentativeContact& contact, double stiffness_npm,
                   const glm::dvec3& about_m) noexcept;

/// One tool: where the device wants its frame, where the virtual tool is (in and out), what the
/// device feels (out; world, torque about the device's origin).
struct CoupledTool {
    RigidPose device{}, tool{};
    CouplingSpring spring{};
    double most_step_m = 1e300; // it moves at most so far (linearisation, tunnelling)
    double most_turn_rad = 1e300;
    Wrench wrench{};
    Matrix6 felt{}; // stiffness at the device: coupling in series with the contacts
};

/// Moves the tools to the balance of springs and contacts (N/m per contact: stiffness * share), by
/// one linear solve, repeated without the contacts that would pull. False: the system could not be
/// solved (a number is not finite); tools stay and feel nothing. Real-time safe.
bool balance(std::span<CoupledTool> tool, std::span<const ToolContact> contact,
             double stiffness_npm) noexcept;

/// Rotation vector (rad) that turns `from` into `to`, the short way.
glm::dvec3 turn_between(const glm::dmat3& from, const glm::dmat3& to) noexcept;

} // namespace haptics
