#include "tasks/hand/motion.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tasks {
namespace {

// Median duration of one movement of the tip in 204 tracks of robotic surgery: 0.43-0.50 s.
constexpr double kShortestMove_s = 0.45;
constexpr double kPeakOfMean = 1.875;

constexpr double kSofter_npm = 20.0, kStiffer_npm = 600.0; // fat .. the grip itself
constexpr double kLeastTravel_m = 0.5e-3; // below: too short to tell a stiffness from
constexpr double kLag_s = 0.1;            // of grip, device and tissue, beside the delay
constexpr double kStart_mps2 = 0.15;      // how briskly a press starts and stops

// Band pass with unit peak (bilinear, Bristow-Johnson's form) about the geometric middle of
// 3-12 Hz, bandwidth 9 Hz. White noise of variance 1 comes out with (pi/2) bandwidth 2/fs.
constexpr double kMiddle_hz = 6.0, kWidth_hz = 9.0;

} // namespace

double way_share(const MinimumJerk& move) noexcept {
    const double s =
        move.duration_s > 0.0 ? std::clamp(move.time_s / move.duration_s, 0.0, 1.0) : 1.0;
    return s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
}

glm::dvec3 place_m(const MinimumJerk& move) noexcept {
    const double x = way_share(move);
    return move.from_m + x * (move.to_m - move.from_m) + 4.0 * x * (1.0 - x) * move.bow_m;
}

MinimumJerk plan_move(const glm::dvec3& from_m, const glm::dvec3& to_m, double peak_mps) noexcept {
    const double length_m = glm::distance(from_m, to_m);
    return {from_m, to_m, glm::dvec3{0.0},
            std::max(kShortestMove_s, kPeakOfMean * length_m / peak_mps), 0.0};
}

MinimumJerk aimed_move(const HandSkill& skill, Random& random, const glm::dvec3& from_m,
                       const glm::dvec3& to_m, const glm::dvec3& sight_line) noexcept {
    constexpr double kUsualMove_m =
        9.5e-3; // median movement; end points of shorter ones spread less
    const double spread = std::min(1.0, glm::distance(from_m, to_m) / kUsualMove_m);
    const glm::dvec3 any{random.normal(), random.normal(), random.normal()};
    const glm::dvec3 across = any - glm::dot(any, sight_line) * sight_line;
    const glm::dvec3 error = skill.aim_m * across + skill.depth_m * random.normal() * sight_line;
    return plan_move(from_m, to_m + spread * error, skill.speed_mps);
}

glm::dvec3 next_tremor_m(Tremor& tremor, double rms_m) noexcept {
    static const double w = 2.0 * std::numbers::pi * kMiddle_hz * kTick_s;
    static const double alpha = 0.5 * std::sin(w) * kWidth_hz / kMiddle_hz;
    static const double b = alpha / (1.0 + alpha), a1 = -2.0 * std::cos(w) / (1.0 + alpha),
                        a2 = (1.0 - alpha) / (1.0 + alpha);
    // Uniform noise of unit variance per axis does: what passes the filter is close to normal.
    static const double scale =
        std::sqrt(12.0 / 3.0) / std::sqrt(std::numbers::pi * kWidth_hz * kTick_s);
    glm::dvec3 x{0.0};
    for (int axis = 0; axis < 3; ++axis)
        x[axis] = scale * rms_m * (tremor.random.uniform() - 0.5);
    const glm::dvec3 y = b * x + tremor.state[0];
    tremor.state[0] = tremor.state[1] - a1 * y;
    tremor.state[1] = -b * x - a2 * y;
    return y;
}

Press begin_press(double wanted_n, double speed_mps, double delay_s) {
    Press press;
    press.wanted_n = wanted_n;
    press.speed_mps = speed_mps;
    press.delay_s = delay_s;
    press.past.resize(static_cast<std::size_t>(std::lround(delay_s / kTick_s)) + 1);
    return press;
}

void advance(Press& press, double force_n) noexcept {
    // The ring's oldest entry is `delay_s` old once this tick's has been written.
    press.past[press.at] = {force_n, press.advanced_m};
    press.at = (press.at + 1) % press.past.size();
    const Press::Past felt = press.past[press.at];
    press.felt_n = felt.force_n;

    if (press.contact_ticks == 0 && felt.force_n > kContactFelt_n)
        press.touched_m = felt.advanced_m;
    if (press.contact_ticks > 0 || felt.force_n > kContactFelt_n)
        ++press.contact_ticks;

    double rate = press.speed_mps;
    if (press.contact_ticks > 0) {
        const double travel_m = std::max(felt.advanced_m - press.touched_m, kLeastTravel_m);
        const double stiffness_npm = std::clamp(felt.force_n / travel_m, kSofter_npm, kStiffer_npm);
        const double gain = 1.0 / (std::numbers::e * stiffness_npm * (press.delay_s + kLag_s));
        rate =
            std::clamp(gain * (press.wanted_n - felt.force_n), -press.speed_mps, press.speed_mps);
    }
    const double change = kStart_mps2 * kTick_s;
    press.rate_mps += std::clamp(rate - press.rate_mps, -change, change);
    press.advanced_m += press.rate_mps * kTick_s;
}

} // namespace tasks
