// tasks/score/motion_sums.cpp
// Sums over the low-passed motion of one tool. Called by finish().
#include "tasks/score/smoothness.h"
#include "tasks/score/sums.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tasks {
namespace {

std::vector<glm::dvec3> smoothed(const std::vector<glm::dvec3>& path) {
    return low_pass(path, kFs_hz, kCutoff_hz);
}

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); // exact for small angles
}

std::vector<double> add_tip(Sums& sums, const std::vector<glm::dvec3>& path_m,
                            const Window& window) {
    const std::size_t end = window.first + window.count;
    std::vector<double> speed_mps;
    for (std::size_t i = window.first + 1; i < end; ++i) {
        const double step_m = glm::distance(path_m[i], path_m[i - 1]);
        sums.path_m += step_m;
        sums.idle += step_m * kFs_hz < kMoving_mps;
        speed_mps.push_back(step_m * kFs_hz);
    }
    sums.intervals = speed_mps.size();
    for (std::size_t i = window.first + 2; i < end; ++i, ++sums.bends)
        sums.accel_sum_mps2 +=
            glm::length(path_m[i] - 2.0 * path_m[i - 1] + path_m[i - 2]) * kFs_hz * kFs_hz;
    sums.squared_jerk_m2ps5 =
        squared_jerk_m2ps5(std::span(path_m).subspan(window.first, window.count), kFs_hz);
    return speed_mps;
}

void add_smoothness(Sums& sums, std::span<const double> speed_mps) {
    for (const std::span<const double> movement : sub_movements(speed_mps, kFs_hz)) {
        if (const std::optional<double> jerk = ldlj(movement, kFs_hz))
            sums.ldlj.push_back(*jerk);
        if (const std::optional<double> arc = sparc(movement, kFs_hz))
            sums.sparc.push_back(*arc);
    }
}

// The force at an interval is the mean of its ends; off the tissue there is none.
void add_work(Sums& sums, const ScoreState& score, std::size_t tool,
              const std::vector<glm::dvec3>& path_m, const Window& window) {
    const auto on_tissue_n = [&](std::size_t i) {
        const bool touching =
            (score.flags[tool][i] & kTouching) && (score.flags[tool][i] & kPresent);
        return touching ? -glm::dvec3(score.force_on_n[tool][i]) : glm::dvec3(0.0);
    };
    for (std::size_t i = window.first + 1; i < window.first + window.count; ++i) {
        const glm::dvec3 force_n = 0.5 * (on_tissue_n(i - 1) + on_tissue_n(i));
        sums.work_j += std::max(0.0, glm::dot(force_n, path_m[i] - path_m[i - 1]));
    }
}

void add_shaft(Sums& sums, const ScoreState& score, std::size_t tool, const Window& window) {
    const std::vector<glm::vec3>& recorded = score.shaft[tool];
    const std::vector<glm::dvec3> shaft = smoothed({recorded.begin(), recorded.end()});
    for (std::size_t i = window.first + 1; i < window.first + window.count; ++i)
        sums.angle_rad += angle_between(shaft[i - 1], shaft[i]);
}

// Insertion and roll pass the filter together. A roll that jumps by a turn has not turned.
void add_depth_and_roll(Sums& sums, const ScoreState& score, std::size_t tool,
                        const Window& window) {
    std::vector<glm::dvec3> both;
    both.reserve(score.roll_rad[tool].size());
    double roll = 0.0, last = 0.0;
    for (std::size_t i = 0; i < score.roll_rad[tool].size(); ++i) {
        const auto now = static_cast<double>(score.roll_rad[tool][i]);
        roll += i > 0 ? std::remainder(now - last, 2.0 * std::numbers::pi) : 0.0;
        last = now;
        both.emplace_back(score.insertion_m[tool][i], roll, 0.0);
    }
    both = smoothed(both);
    for (std::size_t i = window.first + 1; i < window.first + window.count; ++i) {
        sums.depth_m += std::abs(both[i].x - both[i - 1].x);
        sums.roll_rad += std::abs(both[i].y - both[i - 1].y);
    }
}

} // namespace

std::vector<double> add_motion(Sums& sums, const ScoreState& score, std::size_t tool,
                               const Window& window) {
    const std::vector<glm::dvec3> path_m = smoothed(score.tip_m[tool]);
    std::vector<double> speed_mps = add_tip(sums, path_m, window);
    add_smoothness(sums, speed_mps);
    add_work(sums, score, tool, path_m, window);
    add_shaft(sums, score, tool, window);
    add_depth_and_roll(sums, score, tool, window);
    return speed_mps;
}

} // namespace tasks
