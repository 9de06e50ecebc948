// haptics/rigid/step_rigid.h
// One tick of rigid tools among rigid scenery and each other, in six degrees of freedom. Knows
// nothing of tissue: sim/ calls it at 1 kHz with the poses that the devices ask for, and adds the
// wrenches.
//
//   pairs of pieces -> smallest penetration -> patches -> contacts -> balance -> wrench
//
// Without friction. The force is not the slope of a potential: stiffness shared by area and a
// direction that turns late do a little work by themselves. On flat faces that is nothing but what
// holding a force for a tick costs anywhere; a box slid askew off an edge gives back up to 12 %
// more than was put in, onto an edge it takes more. The device's damping has to hold that too.
//
// Model: constant, built at load. State: what the next tick needs. Scratch: reused memory.
#pragma once

#include "haptics/rigid/convex_contact.h"
#include "haptics/rigid/rigid_coupling.h"
#include "haptics/rigid/rigid_shape.h"

namespace haptics {

struct RigidParams {
    double contact_npm = 5000.0;  // per direction of push between two bodies
    double margin_m = 2e-3;       // pieces nearer than this are followed
    double most_step_m = 1e-3;    // of a tool per tick while something is near: 1 m/s; in the free
    double most_turn_rad = 0.05;  // a tool that lags catches up by so much per tick
    double passivity_share = 0.8; // of what the devices' damping allows
    ClusterParams cluster{};
};

struct RigidBody {
    RigidShape shape;
    RigidPose pose{}; // scenery: in the world. Tools: not used
};

struct RigidModel {
    std::vector<RigidBody> scenery;
    std::vector<RigidBody> tool; // at most kMostRigidTools
    std::array<DeviceDamping, kMostRigidTools> device{};
    std::array<CouplingSpring, kMostRigidTools> spring{};
    RigidParams params{};
};

/// Load time. Springs are safe_spring of the devices. Throws std::invalid_argument: no tool or
/// more than kMostRigidTools, damping, tick, stiffness or margin not above 0 (naming the tool).
RigidModel make_rigid_model(std::vector<RigidBody> scenery, std::vector<RigidBody> tool,
                            std::span<const DeviceDamping> device, const RigidParams& params);

/// Bodies: scenery by number, then tools.
struct KnownPair {
    std::uint32_t body_a = 0, body_b = 0;
    PiecePair piece{};
    PairMemory memory{};
};
using KnownPairs = Bounded<KnownPair, 512>;

struct RigidState {
    std::array<RigidPose, kMostRigidTools> tool{};   // where the virtual tools are
    std::array<RigidPose, kMostRigidTools> device{}; // of last tick
    bool placed = false; // false: the next tick starts them where the devices are
    KnownPairs known{};
};

struct RigidScratch {
    KnownPairs next{};
    PairList pairs{};
    PatchList patches{};
    ContactList contacts{};
};

struct RigidTick {
    std::array<Wrench, kMostRigidTools> wrench{}; // on the devices, world, about their origin
    ToolContactList contacts{};                   // at the poses the tools came from
    double deepest_m = 0.0;                       // way out of the deepest pair
    double passivity_share = 0.0;                 // largest, before the wrench is limited
    std::uint32_t dropped = 0;                    // pairs, patches and contacts without room
    bool solved = true; // false: a pose was not finite; all wrenches are 0
};

/// `device`: wanted poses, one per tool of the model (missing ones: all wrenches are 0). The same
/// inputs give the same bits. noexcept, no allocation, no lock.
void step_rigid(const RigidModel& model, std::span<const RigidPose> device, RigidState& state,
                RigidScratch& scratch, RigidTick& out) noexcept;

} // namespace haptics
