#include "sim/study/contact_quality.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

namespace sim {
namespace {

constexpr double kTold_npm = 500.0;
constexpr double kNoForce = 0.01; // of what the depth asks for

double distance_m(const haptics::SurfaceHit& hit) {
    return hit.hit() ? hit.distance_m : std::numeric_limits<double>::infinity();
}

} // namespace

ContactJudge::ContactJudge(const QualityLimits& limits) : limits_(limits) {
    const QualityLimits& l = limits;
    if (!(l.stiffness_npm > 0.0) || !(l.radius_m >= 0.0) || !(l.lost_m >= 0.0) ||
        !(l.sunk_m >= 0.0) || !(l.stuck_m >= 0.0) || l.stuck_ticks < 0)
        throw std::invalid_argument("contact quality: limits must be 0 or more, stiffness above 0");
}

bool ContactJudge::add(const QualityTick& tick, const NearestSkin& nearest) {
    ContactQuality& q = quality_;
    const double stiffness = kTold_npm / limits_.stiffness_npm;

    // the device: how deep, and how far it is to the nearest free place
    const double device_skin_m = distance_m(nearest(tick.device_m));
    const bool entered = tick.device_side == limits_.entry_side;
    const double depth_m = limits_.radius_m + (entered ? -device_skin_m : device_skin_m);
    const bool pressed = depth_m >= 0.0 && std::isfinite(device_skin_m);
    const double free_m = pressed ? depth_m : 0.0;

    // the proxy: where it is, how deep, how far behind
    const double proxy_skin_m = distance_m(nearest(tick.proxy_m));
    const bool inside = tick.proxy_side != limits_.entry_side;
    const double proxy_depth_m = limits_.radius_m + (inside ? proxy_skin_m : -proxy_skin_m);
    const bool wrong = inside && proxy_skin_m > kOnSkin_m;
    const double lag_m = glm::length(tick.proxy_m - tick.device_m) - free_m;
    lagging_ticks_ = lag_m > limits_.stuck_m ? lagging_ticks_ + 1 : 0;

    const double force_n = glm::length(tick.force_n);
    const bool lost =
        pressed && depth_m > limits_.lost_m && force_n < kNoForce * limits_.stiffness_npm * depth_m;
    const bool sunk = pressed && !wrong && proxy_depth_m > limits_.sunk_m;
    const bool stuck = lagging_ticks_ > limits_.stuck_ticks;

    q.contact_ticks += pressed;
    q.lost += lost;
    q.sunk += sunk;
    q.wrong_side += wrong;
    q.stuck += stuck;
    q.bad += lost || sunk || wrong || stuck;
    q.longest_stuck_ticks = std::max(q.longest_stuck_ticks, lagging_ticks_);
    if (std::isfinite(proxy_depth_m))
        q.deepest_m = std::max(q.deepest_m, proxy_depth_m);
    q.largest_lag_m = std::max(q.largest_lag_m, lag_m);
    q.max_force_n = std::max(q.max_force_n, stiffness * force_n);
    if (q.ticks > 0)
        q.max_force_step_n =
            std::max(q.max_force_step_n, stiffness * glm::length(tick.force_n - last_force_n_));
    last_force_n_ = tick.force_n;
    ++q.ticks;
    return pressed;
}

} // namespace sim
