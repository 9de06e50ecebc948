// tests/haptics/force_free_devices_test.cpp
// The two devices that push nobody: the mouse and the recording.
#include "haptics/device/mouse_device.h"
#include "haptics/device/replay_device.h"

#include <cmath>
#include <doctest/doctest.h>

namespace {

using haptics::DeviceFault;
using haptics::DeviceSample;

} // namespace

TEST_CASE("mouse device: it is where the window put it, in counts, and feels nothing") {
    haptics::MouseDevice mouse({0.01, 0, 0});
    DeviceSample sample;
    CHECK(mouse.read(sample) == DeviceFault::none);
    CHECK(sample.counts == std::array<std::int32_t, 3>{500, 0, 0}); // 20 um a count
    CHECK(sample.sequence == 1);
    mouse.set_goal({0, -0.02, 31e-6});
    mouse.set_jaw(1.5);
    mouse.set_goal({std::nan(""), 0, 0}); // ignored
    CHECK(mouse.write({1, 2, 3}) == DeviceFault::none);
    mouse.read(sample);
    CHECK(sample.counts == std::array<std::int32_t, 3>{0, -1000, 2});
    CHECK(sample.jaw_counts == 1000);
    CHECK(sample.sequence == 2);
    CHECK_FALSE(mouse.info().feels);
}

TEST_CASE("replay device: every read comes back as it was, faults too, then it is unplugged") {
    std::array<haptics::RecordedRead, 3> reads;
    reads[0].sample.counts = {1, 2, 3};
    reads[0].sample.sequence = 40;
    reads[1].fault = DeviceFault::timeout;
    reads[1].sample.counts = {9, 9, 9}; // what a failed read left behind is not a sample
    reads[2].sample.counts = {4, 5, 6};
    reads[2].sample.jaw_counts = 700;
    haptics::DeviceInfo info;
    info.coulomb_n = 0.07;
    haptics::ReplayDevice device(info, reads);
    CHECK(device.info().coulomb_n == 0.07);
    DeviceSample sample;
    CHECK(device.read(sample) == DeviceFault::none);
    CHECK(sample.counts == std::array<std::int32_t, 3>{1, 2, 3});
    CHECK(sample.sequence == 40);
    CHECK(device.read(sample) == DeviceFault::timeout);
    CHECK(sample.counts == std::array<std::int32_t, 3>{1, 2, 3});
    CHECK(device.write({1, 0, 0}) == DeviceFault::none);
    CHECK(device.read(sample) == DeviceFault::none);
    CHECK(sample.jaw_counts == 700);
    CHECK(device.read(sample) == DeviceFault::unplugged);
    CHECK(sample.jaw_counts == 700);
}
