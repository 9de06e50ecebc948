// haptics/device/mouse_device.h
// A mouse as a device that positions but does not feel: the window turns pointer and wheel into
// a place and sets it; forces go nowhere. Used by whoever owns the tick, in one thread.
#pragma once

#include "haptics/device/device.h"

namespace haptics {

class MouseDevice final : public Device {
  public:
    /// `handle_m`: where the handle starts, device frame.
    explicit MouseDevice(const glm::dvec3& handle_m) noexcept;

    const DeviceInfo& info() const noexcept override;
    DeviceFault read(DeviceSample& out) noexcept override;
    DeviceFault write(const glm::dvec3& force_n) noexcept override;

    /// Where the handle is now, device frame. What is not finite is ignored.
    void set_goal(const glm::dvec3& goal_m) noexcept;
    void set_jaw(double closed) noexcept; // 0 open .. 1 closed
    /// Of an endoscope: camera head about the shaft, optic against the camera head, in counts.
    void set_turns(double camera_counts, double optic_counts) noexcept;

  private:
    DeviceInfo info_;
    DeviceSample sample_;
};

} // namespace haptics
