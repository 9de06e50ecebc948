#include "haptics/device/replay_device.h"

namespace haptics {

ReplayDevice::ReplayDevice(const DeviceInfo& info, std::span<const RecordedRead> reads) noexcept
    : info_(info), reads_(reads) {}

const DeviceInfo& ReplayDevice::info() const noexcept {
    return info_;
}

DeviceFault ReplayDevice::read(DeviceSample& out) noexcept {
    if (next_ >= reads_.size())
        return DeviceFault::unplugged;
    const RecordedRead& was = reads_[next_++];
    if (was.fault == DeviceFault::none)
        out = was.sample;
    return was.fault;
}

DeviceFault ReplayDevice::write(const glm::dvec3&) noexcept {
    return DeviceFault::none;
}

} // namespace haptics
