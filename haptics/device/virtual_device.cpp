#include "haptics/device/virtual_device.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace haptics {
namespace {

// One axis of a mass with viscous and Coulomb friction.
struct Axis {
    double mass_kg, damping_nspm, coulomb_n;
};
struct Motion {
    double x_m, v_mps;
};

// phi1 = (1 - e^-z)/z and phi2 = (1 - phi1)/z, also where z is nothing.
double phi1(double z) noexcept {
    return z > 0.0 ? -std::expm1(-z) / z : 1.0;
}
double phi2(double z) noexcept {
    return z > 1e-4 ? (1.0 - phi1(z)) / z : 0.5 - z / 6.0;
}

// m v' + b v = f, f constant, solved exactly.
Motion glide(const Axis& axis, Motion from, double force_n, double dt_s) noexcept {
    const double z = axis.damping_nspm * dt_s / axis.mass_kg;
    const double push_mps = force_n * dt_s / axis.mass_kg;
    return {from.x_m + dt_s * (from.v_mps * phi1(z) + push_mps * phi2(z)),
            from.v_mps * (1.0 - z * phi1(z)) + push_mps * phi1(z)};
}

// When v comes to zero under f (which opposes v): v b/|f| = e^(b t/m) - 1.
double stop_time_s(const Axis& axis, double v_mps, double force_n) noexcept {
    const double ratio = std::abs(v_mps / force_n);
    const double z = axis.damping_nspm * ratio; // below: t = m ratio log(1 + z)/z
    return axis.mass_kg * ratio * (z > 1e-12 ? std::log1p(z) / z : 1.0);
}

Motion substep(const Axis& axis, Motion m, double drive_n, double dt_s) noexcept {
    if (m.v_mps != 0.0) {
        const double force_n = drive_n - std::copysign(axis.coulomb_n, m.v_mps);
        const double stop_s =
            force_n * m.v_mps < 0.0 ? stop_time_s(axis, m.v_mps, force_n) : 2.0 * dt_s;
        if (stop_s > dt_s)
            return glide(axis, m, force_n, dt_s);
        m = {glide(axis, m, force_n, stop_s).x_m, 0.0};
        dt_s -= stop_s;
    }
    // at rest: sticks, or is pulled off
    if (std::abs(drive_n) <= axis.coulomb_n)
        return {m.x_m, 0.0};
    return glide(axis, m, drive_n - std::copysign(axis.coulomb_n, drive_n), dt_s);
}

std::int32_t to_counts(double x_m, double metres_per_count) noexcept {
    constexpr double kMost = 2147483647.0;
    return static_cast<std::int32_t>(std::clamp(std::round(x_m / metres_per_count), -kMost, kMost));
}

} // namespace

VirtualDevice::VirtualDevice(const VirtualDeviceModel& model, const glm::dvec3& handle_m) noexcept
    : model_(model), position_m_(handle_m), goal_m_(handle_m) {
    model_.delay_ticks = std::clamp(model.delay_ticks, 0, kMaxDelay);
    model_.substeps = std::max(1, model.substeps);
    past_m_.fill(handle_m);
}

const DeviceInfo& VirtualDevice::info() const noexcept {
    return model_.info;
}

DeviceFault VirtualDevice::read(DeviceSample& out) noexcept {
    if (fault_ != DeviceFault::none)
        return fault_;
    for (int axis = 0; axis < 3; ++axis)
        out.counts[axis] =
            to_counts(past_m_[model_.delay_ticks][axis], model_.info.metres_per_count);
    out.roll_counts = 0;
    out.jaw_counts = static_cast<std::int32_t>(std::lround(1000.0 * jaw_));
    out.sequence = sequence_;
    out.buttons = 0;
    return DeviceFault::none;
}

DeviceFault VirtualDevice::write(const glm::dvec3& force_n) noexcept {
    if (fault_ != DeviceFault::none)
        return fault_;
    ticks_unwritten_ = 0;
    const double length = glm::length(force_n);
    if (!std::isfinite(length))
        force_n_ = glm::dvec3{0.0}; // the motors refuse it
    else
        force_n_ = force_n * std::min(1.0, model_.info.max_force_n / std::max(length, 1e-300));
    return DeviceFault::none;
}

void VirtualDevice::set_goal(const glm::dvec3& goal_m) noexcept {
    goal_m_ = goal_m;
}

void VirtualDevice::set_jaw(double closed) noexcept {
    jaw_ = std::isfinite(closed) ? std::clamp(closed, 0.0, 1.0) : 0.0;
}

void VirtualDevice::step(double tick_s) noexcept {
    if (ticks_unwritten_++ >= kLimpAfterTicks)
        force_n_ = glm::dvec3{0.0};

    const Grip& grip = model_.grip;
    const double stiffness_npm = grip.held ? grip.stiffness_npm : 0.0;
    const Axis axis{model_.info.mass_kg + (grip.held ? grip.mass_kg : 0.0),
                    model_.info.damping_nspm + (grip.held ? grip.damping_nspm : 0.0),
                    model_.info.coulomb_n};
    const double dt_s = tick_s / model_.substeps;
    for (int i = 0; i < model_.substeps; ++i)
        for (int k = 0; k < 3; ++k) {
            const Motion now{position_m_[k], velocity_mps_[k]};
            const double middle_m = now.x_m + 0.5 * dt_s * now.v_mps;
            const double drive_n = force_n_[k] + stiffness_npm * (goal_m_[k] - middle_m);
            const Motion next = substep(axis, now, drive_n, dt_s);
            position_m_[k] = next.x_m;
            velocity_mps_[k] = next.v_mps;
        }

    std::shift_right(past_m_.begin(), past_m_.end(), 1);
    past_m_[0] = position_m_;
    ++sequence_;
}

glm::dvec3 VirtualDevice::handle_m() const noexcept {
    return position_m_;
}

glm::dvec3 VirtualDevice::velocity_mps() const noexcept {
    return velocity_mps_;
}

void VirtualDevice::inject(DeviceFault fault) noexcept {
    fault_ = fault;
}

} // namespace haptics
