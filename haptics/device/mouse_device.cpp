#include "haptics/device/mouse_device.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace haptics {
namespace {

std::int32_t to_counts(double value) noexcept {
    return static_cast<std::int32_t>(std::clamp(std::round(value), -2147483647.0, 2147483647.0));
}

} // namespace

MouseDevice::MouseDevice(const glm::dvec3& handle_m) noexcept {
    std::snprintf(info_.name, sizeof info_.name, "mouse");
    info_.feels = false;
    info_.max_force_n = 0.0;
    set_goal(handle_m);
}

const DeviceInfo& MouseDevice::info() const noexcept {
    return info_;
}

DeviceFault MouseDevice::read(DeviceSample& out) noexcept {
    ++sample_.sequence;
    out = sample_;
    return DeviceFault::none;
}

DeviceFault MouseDevice::write(const glm::dvec3&) noexcept {
    return DeviceFault::none;
}

void MouseDevice::set_goal(const glm::dvec3& goal_m) noexcept {
    if (!std::isfinite(goal_m.x + goal_m.y + goal_m.z))
        return;
    for (int axis = 0; axis < 3; ++axis)
        sample_.counts[axis] = to_counts(goal_m[axis] / info_.metres_per_count);
}

void MouseDevice::set_turns(double camera_counts, double optic_counts) noexcept {
    if (!std::isfinite(camera_counts + optic_counts))
        return;
    sample_.roll_counts = to_counts(camera_counts);
    sample_.optic_counts = to_counts(optic_counts);
}

void MouseDevice::set_jaw(double closed) noexcept {
    sample_.jaw_counts =
        std::isfinite(closed) ? to_counts(1000.0 * std::clamp(closed, 0.0, 1.0)) : 0;
}

} // namespace haptics
