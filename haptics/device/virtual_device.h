// haptics/device/virtual_device.h
// A haptic device that exists as physics only: mass, viscous and Coulomb friction with stick,
// encoder quantisation, transport delay, force saturation - and the grip of the hand that holds
// it (spring, damper, mass) pulled towards a goal. Stepped by whoever owns the tick; no clock.
// Per axis, as in a device with one motor an axis:
//   (m + m_grip) x'' = F + k_grip (goal - x) - (b + b_grip) x' - c sgn(x')
// Exact between substeps for a force held over the substep; the spring's force is taken at the
// middle of it. Coulomb friction: the instant at which x' comes to zero is found, and there the
// device sticks until more than c pulls at it (Karnopp 1985).
#pragma once

#include "haptics/device/device.h"

#include <array>

namespace haptics {

struct Grip {
    bool held = true;
    double mass_kg = 0.10;        // of hand moving with the handle
    double stiffness_npm = 400.0; // pen or pinch grip
    double damping_nspm = 5.0;    // against the room, not against the goal
};

struct VirtualDeviceModel {
    DeviceInfo info;
    Grip grip;
    int delay_ticks = 0; // transport: read() sees the past by this many ticks (0..8)
    int substeps = 10;   // per millisecond
};

class VirtualDevice final : public Device {
  public:
    /// `handle_m`: where the handle starts, device frame, at rest.
    VirtualDevice(const VirtualDeviceModel& model, const glm::dvec3& handle_m) noexcept;

    const DeviceInfo& info() const noexcept override;
    DeviceFault read(DeviceSample& out) noexcept override;
    DeviceFault write(const glm::dvec3& force_n) noexcept override;

    /// Where the hand wants the handle, device frame; used by the next step().
    void set_goal(const glm::dvec3& goal_m) noexcept;
    void set_jaw(double closed) noexcept; // 0 open .. 1 closed

    /// Advances the physics by one millisecond under the last force written (zero-order hold).
    void step(double tick_s) noexcept;

    glm::dvec3 handle_m() const noexcept;
    glm::dvec3 velocity_mps() const noexcept;
    /// Tests: every later read() and write() reports this fault (none: cured).
    void inject(DeviceFault fault) noexcept;

  private:
    static constexpr int kMaxDelay = 8;
    static constexpr int kLimpAfterTicks = 20;
    VirtualDeviceModel model_;
    glm::dvec3 position_m_, velocity_mps_{0.0}, goal_m_, force_n_{0.0};
    std::array<glm::dvec3, kMaxDelay + 1> past_m_{};
    int ticks_unwritten_ = 0;
    double jaw_ = 0.0;
    std::uint32_t sequence_ = 0;
    DeviceFault fault_ = DeviceFault::none;
};

} // namespace haptics
