// tests/sim/newest_buffer_test.cpp
#include "sim/loop/newest_buffer.h"

#include <doctest/doctest.h>
#include <thread>

namespace {

struct Pair {
    int a = 0, b = 0; // the writer keeps a == b
};

constexpr int kLast = 200'000;

void write_all(sim::NewestBuffer<Pair>& buffer) {
    for (int i = 1; i <= kLast; ++i) {
        buffer.back() = {i, i};
        buffer.publish();
    }
}

} // namespace

TEST_CASE("newest buffer: the reader sees whole values in order and ends on the last") {
    sim::NewestBuffer<Pair> buffer;
    std::thread writer([&] { write_all(buffer); });
    int seen = 0;
    bool torn = false, backwards = false;
    while (seen < kLast) {
        const Pair p = buffer.latest();
        torn |= p.a != p.b;
        backwards |= p.a < seen;
        seen = p.a;
    }
    writer.join();
    CHECK_FALSE(torn);
    CHECK_FALSE(backwards);
}

TEST_CASE("newest buffer: a kept value stays whole while newer ones are fetched") {
    sim::NewestBuffer<Pair> buffer;
    std::atomic<bool> enough{false};
    std::thread writer([&] { // until the reader has seen enough, however slow it starts
        for (int i = 1; !enough.load(std::memory_order_relaxed); ++i) {
            buffer.back() = {i, i};
            buffer.publish();
        }
    });
    const Pair* kept = nullptr;
    Pair kept_copy;
    bool changed = false, torn = false;
    for (int fetches = 0; fetches < 20'000;) {
        const Pair* fresh = buffer.fetch();
        if (kept)
            changed |= kept->a != kept_copy.a || kept->b != kept_copy.b;
        if (!fresh)
            continue;
        torn |= fresh->a != fresh->b;
        if (++fetches % 3 == 0) { // some are looked at and dropped, some become the kept one
            kept = fresh;
            kept_copy = *fresh;
            buffer.keep();
        }
    }
    enough = true;
    writer.join();
    CHECK_FALSE(changed);
    CHECK_FALSE(torn);
}

TEST_CASE("newest buffer: nothing new gives nothing, and the same value is given once") {
    sim::NewestBuffer<int> buffer;
    CHECK(buffer.fetch() == nullptr);
    buffer.back() = 7;
    buffer.publish();
    const int* first = buffer.fetch();
    REQUIRE(first);
    CHECK(*first == 7);
    CHECK(buffer.fetch() == nullptr);
    CHECK(buffer.latest() == 7);
}
