// haptics/contact/pose_history.h
// The tool tips of the last half second by tick, so that an answer about the past can be brought
// to the present. Owned by the haptic loop.
#pragma once

#include "haptics/contact/contact_rows.h"
#include "haptics/contact/jaws.h"

#include <cstdint>

namespace haptics {

struct ToolTip {
    glm::dvec3 centre_m{0.0}; // of the tip sphere
    double radius_m = 3e-3;
    JawGrip grip{};
};

struct PoseHistory {
    static constexpr int kLength = 512;
    std::array<std::array<ToolTip, kTools>, kLength> tip{};
    std::int64_t newest_tick = -1;

    void push(std::int64_t tick, const std::array<ToolTip, kTools>& tips) noexcept {
        tip[static_cast<std::size_t>(tick % kLength)] = tips;
        newest_tick = tick;
    }
    /// `tick` must be one of the last kLength pushed.
    const std::array<ToolTip, kTools>& at(std::int64_t tick) const noexcept {
        return tip[static_cast<std::size_t>(tick % kLength)];
    }
    bool holds(std::int64_t tick) const noexcept {
        return tick >= 0 && tick <= newest_tick && tick > newest_tick - kLength;
    }
};

} // namespace haptics
