#include "tasks/score/scope_metrics.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tasks {
namespace {

constexpr double kTilted_rad = 15.0 * std::numbers::pi / 180.0;

} // namespace

ScopeSums scope_sums(const ScoreState& score, const Window& window) {
    ScopeSums sums;
    // from where it was first, so that an eye that rests has no way at all
    std::vector<glm::dvec3> eye_m(window.count);
    for (std::size_t i = 0; i < window.count; ++i)
        eye_m[i] = score.eye_m[window.first + i] - score.eye_m[window.first];
    const std::vector<glm::dvec3> smooth_m = low_pass(eye_m, kFs_hz, kCutoff_hz);
    for (std::size_t i = 1; i < smooth_m.size(); ++i)
        sums.path_m += glm::distance(smooth_m[i - 1], smooth_m[i]);
    double square = 0.0;
    std::size_t over = 0;
    for (std::size_t i = window.first; i < window.first + window.count; ++i) {
        const auto turn = static_cast<double>(score.horizon_rad[i]);
        square += turn * turn;
        over += std::abs(turn) > kTilted_rad;
    }
    const auto samples = static_cast<double>(window.count);
    sums.horizon_rms_rad = std::sqrt(square / samples);
    sums.horizon_over = static_cast<double>(over) / samples;
    return sums;
}

} // namespace tasks
