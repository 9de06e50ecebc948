// haptics/device/device.h
// What every haptic device can do. The only virtual interface in Trocar.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

namespace haptics {

/// Raw counts, as they go into the logbook: everything else follows from them.
struct DeviceSample {
    std::array<std::int32_t, 3> counts{}; // x y z of the handle, device frame
    std::int32_t roll_counts = 0;
    std::int32_t jaw_counts = 0;   // 0 open .. 1000 closed
    std::int32_t optic_counts = 0; // endoscope: optic against the camera head
    std::uint32_t sequence = 0;    // of the device's own frames
    std::uint8_t buttons = 0;
};

enum class DeviceFault : std::uint8_t { none, timeout, bad_report, unplugged, stalled };

/// What a device is and what it is safe to do. Fixed after open().
struct DeviceInfo {
    char name[64] = "";
    bool feels = true; // false: position only (mouse), forces are not felt
    double metres_per_count = 20e-6;
    double damping_nspm = 0.5; // b, the physical damping that bounds stiffness
    double mass_kg = 0.1;
    double coulomb_n = 0.0;
    double max_force_n = 8.0;
};

class Device {
  public:
    virtual ~Device() = default;
    virtual const DeviceInfo& info() const noexcept = 0;

    /// Takes the newest sample already received; never waits, throws or logs. On any fault
    /// `out` is unchanged.
    virtual DeviceFault read(DeviceSample& out) noexcept = 0;

    /// Force on the handle in newtons, device frame. Never waits, throws or logs. A device that
    /// is not written for 20 ms goes limp by itself.
    virtual DeviceFault write(const glm::dvec3& force_n) noexcept = 0;
};

} // namespace haptics
