// haptics/device/replay_device.h
// A recorded device: every tick's sample, or fault, as it was. Forces go nowhere. Used by replay,
// one per tool, in the thread that owns the tick.
#pragma once

#include "haptics/device/device.h"

#include <span>

namespace haptics {

/// What one read() gave in the recorded attempt.
struct RecordedRead {
    DeviceSample sample;
    DeviceFault fault = DeviceFault::none;
};

class ReplayDevice final : public Device {
  public:
    /// `reads[t]` is tick t's; not owned, outlives the device. `info` as it was recorded.
    ReplayDevice(const DeviceInfo& info, std::span<const RecordedRead> reads) noexcept;

    const DeviceInfo& info() const noexcept override;

    /// The next tick's read. After the last one: unplugged.
    DeviceFault read(DeviceSample& out) noexcept override;
    DeviceFault write(const glm::dvec3& force_n) noexcept override;

  private:
    DeviceInfo info_;
    std::span<const RecordedRead> reads_;
    std::size_t next_ = 0;
};

} // namespace haptics
