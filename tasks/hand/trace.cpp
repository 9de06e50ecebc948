#include "tasks/hand/trace.h"

#include "tasks/exercise/path_curve.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tasks {
namespace {

constexpr double kBeyond_m = 6e-3;
constexpr double kWander_s = 0.5; // as long as one movement of a hand

std::span<const glm::dvec3> points_of(const Trace& trace) noexcept {
    return {trace.point_m.data(), static_cast<std::size_t>(trace.points)};
}

glm::dvec3 along(const Trace& trace) noexcept {
    constexpr double kShort_m = 1e-3;
    const auto points = points_of(trace);
    const glm::dvec3 way = curve_at(points, curve_step(points, trace.u, kShort_m)) -
                           curve_at(points, curve_step(points, trace.u, -kShort_m));
    const double length = glm::length(way);
    return length > 0.0 ? way / length : glm::dvec3{1.0, 0.0, 0.0};
}

} // namespace

Trace begin_trace(const Observation& seen, int from_point) {
    Trace trace;
    trace.points = seen.targets;
    trace.u = from_point;
    for (std::size_t k = 0; k < static_cast<std::size_t>(seen.targets); ++k) {
        trace.point_m[k] = seen.target[k].position_m;
        trace.normal[k] = seen.target[k].normal;
    }
    return trace;
}

glm::dvec3 place_m(const Trace& trace) noexcept {
    return curve_at(points_of(trace), trace.u) + trace.beyond_m * along(trace);
}

glm::dvec3 normal_at(const Trace& trace) noexcept {
    const auto last = static_cast<std::size_t>(std::max(trace.points - 1, 0));
    const auto k = std::min(static_cast<std::size_t>(trace.u), last);
    const double share = trace.u - static_cast<double>(k);
    return glm::normalize((1.0 - share) * trace.normal[k] +
                          share * trace.normal[std::min(k + 1, last)]);
}

glm::dvec3 aside_m(const Trace& trace, const Observation& seen,
                   const ToolObservation& tool) noexcept {
    std::array<glm::dvec3, kMaxTargets> now{};
    for (std::size_t k = 0; k < static_cast<std::size_t>(trace.points); ++k)
        now[k] = seen.target[k].position_m;
    const std::span<const glm::dvec3> points{now.data(), static_cast<std::size_t>(trace.points)};
    const NearCurve near =
        nearest_on_curve(points, tool.tip_m, tool.tip_m, trace.u - 1.0, trace.u + 1.0);
    const glm::dvec3 off = tool.tip_m - curve_at(points, near.u);
    const glm::dvec3 side = glm::cross(along(trace), normal_at(trace));
    return glm::dot(off, side) * side;
}

void advance(Trace& trace, double way_m, double aim_m, const glm::dvec3& seen_aside_m,
             double pursuit_s, Random& random) noexcept {
    const double end = trace.points - 1.0;
    if (trace.u < end)
        trace.u = curve_step(points_of(trace), trace.u, way_m);
    else if (trace.beyond_m < kBeyond_m)
        trace.beyond_m += way_m;
    else
        ++trace.end_ticks;
    // an Ornstein-Uhlenbeck process of that rms
    const glm::dvec3 side = glm::cross(along(trace), normal_at(trace));
    const double kick_m = aim_m * std::sqrt(2.0 * kTick_s / kWander_s) * random.normal();
    trace.wander_m += kick_m * side - kTick_s / kWander_s * trace.wander_m;
    trace.corrected_m -= kTick_s / pursuit_s * seen_aside_m;
}

} // namespace tasks
