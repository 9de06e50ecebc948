// tests/sim/allocation_test.cpp
// Counts heap allocations of ours: none in a haptic tick, none in a tissue step. CHOLMOD takes
// its memory through malloc and is not counted; nothing else in these two functions may.
#include "sim/session/session.h"

#include <atomic>
#include <cstdlib>
#include <doctest/doctest.h>
#include <new>

namespace {

std::atomic<bool> counting{false};
std::atomic<int> allocations{0};

void* counted(std::size_t size) {
    if (counting.load(std::memory_order_relaxed))
        allocations.fetch_add(1);
    if (void* p = std::malloc(size ? size : 1))
        return p;
    throw std::bad_alloc{};
}

} // namespace

void* operator new(std::size_t size) {
    return counted(size);
}
void* operator new[](std::size_t size) {
    return counted(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    if (counting.load(std::memory_order_relaxed))
        allocations.fetch_add(1);
    return std::malloc(size ? size : 1);
}
void operator delete(void* p) noexcept {
    std::free(p);
}
void operator delete[](void* p) noexcept {
    std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
    std::free(p);
}
void operator delete[](void* p, std::size_t) noexcept {
    std::free(p);
}

TEST_CASE("allocation: the counter counts") {
    allocations = 0;
    counting = true;
    delete new int(3);
    counting = false;
    CHECK(allocations == 1);
}

namespace {

struct Counted {
    int in_ticks = 0, in_steps = 0, touching = 0, grasping = 0;
};

// An expert's attempt, with jaws that close and open all the time or not at all.
Counted count_attempt(bool jaws, int ticks) {
    sim::RunOptions options;
    options.hands = "expert";
    const auto session = sim::make_session(options);
    sim::Exchange& exchange = *session->exchange;
    tasks::TickTrace trace;
    sim::ToolsNow sampled;
    Counted count;
    tasks::HandSight sight = sim::sight_of(*session, trace, 0, 0, false);
    for (int tick = 0; tick < ticks; ++tick) {
        if (tick > 0 && tick % 10 == 0) {
            allocations = 0;
            counting = true;
            sim::tissue_step(session->tissue, sampled, exchange.answers.back());
            counting = false;
            count.in_steps += allocations;
            exchange.answers.publish();
        }
        sim::crew_tick(session->crew, session->haptics, sight);
        for (const auto& device : session->crew.device)
            device->set_jaw(jaws && tick / 150 % 2 ? 1.0 : 0.0);
        allocations = 0;
        counting = true;
        sim::haptic_tick(session->haptics, exchange, trace);
        counting = false;
        count.in_ticks += allocations;
        for (const tasks::ToolTrace& tool : trace.tool) {
            count.touching += (tool.flags & 1) != 0;
            count.grasping += (tool.flags & 16) != 0;
        }
        if (tick % 10 == 0)
            sampled = exchange.tools.latest();
        sight = sim::sight_of(*session, trace, 0, 0, false);
    }
    return count;
}

} // namespace

TEST_CASE("allocation: a haptic tick and a tissue step allocate nothing, touching or not") {
    const Counted count = count_attempt(false, 6000);
    CHECK(count.touching > 100); // else the test looked at nothing
    CHECK(count.grasping == 0);
    CHECK(count.in_ticks == 0);
    CHECK(count.in_steps == 0);
}

TEST_CASE("allocation: nor do they while jaws grasp and let go") {
    const Counted count = count_attempt(true, 6000);
    CHECK(count.grasping > 100);
    CHECK(count.in_ticks == 0);
    CHECK(count.in_steps == 0);
}
