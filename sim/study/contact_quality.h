// sim/study/contact_quality.h
// Whether a contact method did what a skin asks of it, tick by tick: a fold over what the device
// commanded and what the method answered, judged against the mesh of that tick. Knows no method.
// Called by the contact bench; pure, not for 1 kHz (two closest-point queries per tick).
// Metres, newtons, world frame.
//
// A run begins on one side of the skin, the entry side, and is to stay there: the path of the
// device comes back on the side it came from. Everything follows from two facts about a place, its
// distance to the skin and its side (given by the caller, who knows the mesh):
//   a ball's depth there is radius - distance on the entry side, radius + distance elsewhere;
//   the device presses if its depth is >= 0: a contact tick.
// Behind something thin the distance is to its far skin, so depths there are too small by the
// thickness: the judge errs in the method's favour.
#pragma once

#include "haptics/collision/queries.h"

#include <functional>

namespace sim {

struct QualityLimits {
    double radius_m = 0.0;
    double stiffness_npm = 500.0; // of the method; force steps are told as if it were 500
    double lost_m = 1e-4;         // deeper without a force: lost
    double sunk_m = 1e-4;         // a proxy deeper than this: sunk
    double stuck_m = 3e-3;        // a proxy further off than the nearest free place by more: stuck,
    int stuck_ticks = 50;         // ... if for longer than this
    int entry_side = 1;
};

inline constexpr double kOnSkin_m = 1e-5;

struct ContactQuality {
    int ticks = 0, contact_ticks = 0;
    /// Contact ticks deeper than `lost_m` whose force is below a hundredth of stiffness times
    /// depth: whatever stays outside is at least the depth away from the device.
    int lost = 0;
    /// Contact ticks in which the proxy is on the entry side, but its ball deeper than `sunk_m`.
    int sunk = 0;
    /// Ticks, free ones too, in which the proxy's centre is not on the entry side, by more than
    /// `kOnSkin_m`: the proxy of a point lies on the skin.
    int wrong_side = 0;
    /// Ticks in which the proxy is further from the device, by more than `stuck_m`, than the
    /// nearest free place is (the device itself if it is free; else the skin's place nearest to
    /// it, a radius off on the entry side), after the first `stuck_ticks` of them in a row.
    int stuck = 0;
    int bad = 0; // ticks with any of the four
    int longest_stuck_ticks = 0;
    double deepest_m = 0.0;        // of a proxy's ball, on any side
    double largest_lag_m = 0.0;    // of a proxy behind the nearest free place
    double max_force_step_n = 0.0; // from one tick to the next, any direction, at 500 N/m
    double max_force_n = 0.0;      // at 500 N/m
};

/// What one tick was like. A place's side: any number, the same on one side.
struct QualityTick {
    glm::dvec3 device_m{0.0}, proxy_m{0.0};
    int device_side = 1, proxy_side = 1;
    glm::dvec3 force_n{0.0}; // on the device
};

/// The nearest skin of the mesh in this tick; a place without any within the caller's reach is
/// free.
using NearestSkin = std::function<haptics::SurfaceHit(const glm::dvec3& place_m)>;

class ContactJudge {
  public:
    /// Throws std::invalid_argument for limits that are negative or a stiffness that is not above
    /// 0.
    explicit ContactJudge(const QualityLimits& limits);

    /// Ticks in order. Returns whether it was a contact tick.
    bool add(const QualityTick& tick, const NearestSkin& nearest);
    const ContactQuality& quality() const noexcept { return quality_; }

  private:
    QualityLimits limits_;
    ContactQuality quality_;
    glm::dvec3 last_force_n_{0.0};
    int lagging_ticks_ = 0; // in a row
};

} // namespace sim
