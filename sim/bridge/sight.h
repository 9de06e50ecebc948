// sim/bridge/sight.h
// How much of a marker on a skin the endoscope sees: rays against the bodies as deformed now, never
// the picture. Made at setup, then called by the tissue loop once per FEM step.
#pragma once

#include "haptics/collision/box_tree.h"
#include "sim/bridge/body.h"
#include "tasks/exercise/observation.h"

namespace sim {

/// To the centre, and to six places on a circle of 0.8 of the marker's radius.
using tasks::kSightRays;

/// A flat disc on a skin, with the outward unit normal there.
struct Marker {
    glm::dvec3 place_m{0.0};
    glm::dvec3 normal{0.0, 0.0, 1.0};
    double radius_m = 0.0;
};

/// One tree for each body, over its deformed skin.
struct Sight {
    std::vector<haptics::BoxTree> tree;
    std::vector<std::uint8_t> moved; // in the step before
};

/// Setup; the bodies may be deformed already. Throws std::invalid_argument on a bad skin.
Sight make_sight(std::span<const Body> bodies);

/// After each FEM step, with the bodies of make_sight: what rests, and did so a step ago, costs
/// nothing. Real-time safe.
void refit(Sight& sight, std::span<const Body> bodies) noexcept;

/// 0 to kSightRays: how many rays from the eye to the marker's face meet no skin, its own
/// included. 0 if the marker faces away, if anything is not finite, or if the endoscope's shaft
/// from the port to the eye passes through a skin: nobody looks through an organ by pushing the
/// endoscope into it. The first 20 mm from the port are free: it may lie behind the wall's mesh.
/// The bodies are those of the last refit. Real-time safe, deterministic to the bit.
int clear_rays(const Sight& sight, std::span<const Body> bodies, const glm::dvec3& port_m,
               const glm::dvec3& eye_m, const Marker& marker) noexcept;

} // namespace sim
