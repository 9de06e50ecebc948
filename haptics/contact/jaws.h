// haptics/contact/jaws.h
// How firmly a tool's jaws hold what is between them, from how far they are closed. Evaluated once
// a tick by the haptic loop and carried with the tip, so that both loops hold and let go alike.
#pragma once

#include <glm/vec3.hpp>

namespace haptics {

/// Design values: a common atraumatic grasper, squeezed as in gentle work. The pull that it bears
/// is grip times friction, here 2.4 N.
struct JawConfig {
    double grip_n = 4.0;       // of both faces together, fully closed; 0: a probe, without jaws
    double friction = 0.6;     // of the jaws' teeth on tissue
    double closes_above = 0.7; // jaw, 0 open .. 1 closed: begins to hold ...
    double opens_below = 0.4;  // ... and lets go, where the grip has fallen to nothing
};

struct JawGrip {
    double hold_n = 0.0; // pull that slips; 0: open
    int closing = 0;     // number of the last closing; a grasp begins only as a new one begins
    glm::dvec3 closed_at_m{0.0}; // tip centre in that tick
};

/// The grip after `before` with this jaw and tip; not a number counts as open. Real-time safe.
inline JawGrip next_grip(const JawConfig& config, const JawGrip& before, double jaw,
                         const glm::dvec3& tip_m) noexcept {
    JawGrip grip = before;
    const bool was_closed = before.hold_n > 0.0;
    const bool closed = jaw > (was_closed ? config.opens_below : config.closes_above);
    const double share = (jaw < 1.0 ? jaw : 1.0) - config.opens_below;
    grip.hold_n =
        closed ? config.friction * config.grip_n * share / (1.0 - config.opens_below) : 0.0;
    if (grip.hold_n > 0.0 && !was_closed) {
        ++grip.closing;
        grip.closed_at_m = tip_m;
    }
    return grip;
}

} // namespace haptics
