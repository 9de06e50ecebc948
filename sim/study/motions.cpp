#include "sim/study/motions.h"

#include "haptics/contact/surface_walk.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>

namespace sim {
namespace {

constexpr glm::dvec3 kAway{0.0, 0.0, 1.0};

// Depth below the rest skin and place along it (two axes), metres, at time t.
struct Plan {
    double depth_m = -1.0, along_m = 0.0, across_m = 0.0;
};

struct Shape {
    double end_s;
    Plan (*at)(double t, double v, double scale);
};

constexpr double kTwoPi = 2.0 * std::numbers::pi;

double ramp(double t, double v, double from_m, double to_m) {
    return std::min(to_m, from_m + v * t);
}

// From 2 mm above to 8 mm deep at speed v, then stay.
Plan touch(double t, double v, double s) {
    return {ramp(t, v, -2e-3, 8e-3 * s)};
}

// 5 +- 3 mm, peak speed v.
Plan press(double t, double v, double s) {
    const double w = v / (3e-3 * s);
    const double blend = std::min(1.0, t / 0.2);
    return {blend * s * (5e-3 + 3e-3 * std::sin(w * t)) - (1.0 - blend) * 1e-3};
}

constexpr double kSettle_s = 0.2;

// 5 mm deep, then 22 mm along the skin at v.
Plan slide(double t, double v, double s) {
    const double along = std::clamp(v * (t - kSettle_s), 0.0, 22e-3);
    return {ramp(t, 0.04, -1e-3, 5e-3 * s), along - 11e-3};
}

// 5 mm deep, then a Lissajous scrub of 8 and 6 mm, peak speed v on the first axis.
Plan scrub(double t, double v, double s) {
    const double w = v / 8e-3;
    const double since = std::max(0.0, t - kSettle_s);
    return {ramp(t, 0.04, -1e-3, 5e-3 * s), 8e-3 * std::sin(w * since),
            6e-3 * std::sin(1.5 * w * since)};
}

// In, out at v to 4 mm above, and in again at v.
Plan release(double t, double v, double s) {
    const double in = ramp(t, 0.04, -1e-3, 8e-3 * s);
    const double out_at = 0.3;
    const double turn = out_at + (8e-3 * s + 4e-3) / v;
    if (t < out_at)
        return {in};
    if (t < turn)
        return {8e-3 * s - v * (t - out_at)};
    return {ramp(t - turn, v, -4e-3, 6e-3 * s)};
}

Plan two_still(double t, double, double s) {
    return {ramp(t, 0.03, -1e-3, 6e-3 * s), -7.5e-3};
}

// In and out of contact, peak speed v.
Plan two_moving(double t, double v, double s) {
    const double w = v / (3.5e-3 * s);
    const double blend = std::min(1.0, t / 0.2);
    return {blend * s * (3e-3 + 3.5e-3 * std::sin(w * t)) - (1.0 - blend) * 1e-3, 7.5e-3};
}

constexpr double kGrasp_s = 0.25, kPull_s = 0.3, kHeld_s = 0.15, kAfter_s = 0.15;

// 3 mm deep, jaws closed at kGrasp_s, from kPull_s 8 mm up and 6 mm along at v, held, jaws opened.
Plan grasp_pull(double t, double v, double s) {
    const double pulled = std::clamp(v * (t - kPull_s), 0.0, 10e-3 * s);
    return {ramp(t, 0.04, -1e-3, 3e-3 * s) - 0.8 * pulled, 0.6 * pulled};
}

double duration_s(const std::string& name, double v) {
    if (name == "touch")
        return 10e-3 / v + 0.2;
    if (name == "press" || name == "two-tools")
        return 0.2 + std::max(0.5, 2.0 * kTwoPi * 3e-3 / v);
    if (name == "slide")
        return kSettle_s + 22e-3 / v + 0.1;
    if (name == "scrub")
        return kSettle_s + std::max(0.5, kTwoPi * 8e-3 / v);
    if (name == "grasp-pull")
        return kPull_s + 10e-3 / v + kHeld_s + kAfter_s;
    return 0.3 + 12e-3 / v + 10e-3 / v + 0.15;
}

struct Frame {
    haptics::SurfacePoint at;
    glm::dvec3 along, across;
};

// Tip centre for a plan: walk over the rest skin, then along its normal there.
glm::dvec3 tip_for(const Body& organ, const Frame& frame, const Plan& plan, double radius_m) {
    const glm::dvec3 offset = plan.along_m * frame.along + plan.across_m * frame.across;
    const haptics::SurfacePoint at = haptics::walk(BodySurface{organ}, frame.at, offset).point;
    return place_on(organ, at) + (radius_m - plan.depth_m) * normal_on(organ, at);
}

} // namespace

Motion make_motion(const std::string& name, double speed_mps, const Body& organ,
                   const glm::dvec3& place_m, const glm::dvec3& heading, double tip_radius_m,
                   double depth_scale) {
    using PlanAt = Plan (*)(double, double, double);
    struct Named {
        const char* name;
        std::array<PlanAt, 2> plan;
    };
    static constexpr std::array<Named, 7> known{{{"touch", {touch, nullptr}},
                                                 {"press", {press, nullptr}},
                                                 {"slide", {slide, nullptr}},
                                                 {"scrub", {scrub, nullptr}},
                                                 {"release", {release, nullptr}},
                                                 {"two-tools", {two_still, two_moving}},
                                                 {"grasp-pull", {grasp_pull, nullptr}}}};
    const auto found =
        std::find_if(known.begin(), known.end(), [&](const Named& n) { return name == n.name; });
    if (found == known.end()) {
        throw std::invalid_argument(
            "motion \"" + name +
            "\" is unknown: touch, press, slide, scrub, release, two-tools, grasp-pull");
    }
    Frame frame;
    frame.at = nearest_on(organ, place_m).at;
    const glm::dvec3 n = normal_on(organ, frame.at);
    frame.across = glm::normalize(glm::cross(n, heading));
    frame.along = glm::cross(frame.across, n);

    Motion motion{name, speed_mps, found->plan[1] ? 2 : 1, {}, -1, -1};
    if (name == "grasp-pull") {
        motion.jaw_closes = static_cast<std::int64_t>(kGrasp_s / kTick_s);
        motion.jaw_opens =
            static_cast<std::int64_t>((kPull_s + 10e-3 / speed_mps + kHeld_s) / kTick_s);
    }
    const auto ticks = static_cast<std::size_t>(duration_s(name, speed_mps) / kTick_s);
    motion.tip_m.resize(ticks);
    for (std::size_t i = 0; i < ticks; ++i) {
        motion.tip_m[i] = {kAway, kAway + glm::dvec3{0.1, 0, 0}, kAway + glm::dvec3{0.2, 0, 0}};
        for (int tool = 0; tool < motion.tools; ++tool) {
            const Plan plan =
                found->plan[tool](static_cast<double>(i) * kTick_s, speed_mps, depth_scale);
            motion.tip_m[i][tool] = tip_for(organ, frame, plan, tip_radius_m);
        }
    }
    return motion;
}

} // namespace sim
