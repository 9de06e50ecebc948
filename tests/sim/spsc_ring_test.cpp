// tests/sim/spsc_ring_test.cpp
#include "sim/loop/spsc_ring.h"

#include <doctest/doctest.h>
#include <thread>

TEST_CASE("ring: every value arrives once and in order across threads") {
    constexpr int kCount = 100'000;
    sim::SpscRing<int, 256> ring;
    std::thread writer([&] {
        for (int i = 0; i < kCount; ++i) {
            while (!ring.push(i))
                std::this_thread::yield();
        }
    });
    int expected = 0;
    bool in_order = true;
    while (expected < kCount) {
        int value = 0;
        if (!ring.pop(value))
            continue;
        in_order &= value == expected;
        ++expected;
    }
    writer.join();
    int left = 0;
    CHECK(in_order);
    CHECK_FALSE(ring.pop(left));
}

TEST_CASE("ring: a full ring refuses and keeps what it has") {
    sim::SpscRing<int, 4> ring;
    for (int i = 0; i < 4; ++i)
        CHECK(ring.push(i));
    CHECK_FALSE(ring.push(4));
    int value = -1;
    CHECK(ring.pop(value));
    CHECK(value == 0);
    CHECK(ring.push(5));
}
