#include "haptics/contact/coupling.h"

#include "tests/haptics/mass_spring.h"

#include <atomic>
#include <cstdlib>
#include <doctest/doctest.h>
#include <new>

namespace {

std::atomic<int> allocations{0};

void* counted(std::size_t size) {
    ++allocations;
    if (void* p = std::malloc(size > 0 ? size : 1))
        return p;
    throw std::bad_alloc{};
}

} // namespace

// every allocation of this test program is counted
void* operator new(std::size_t size) {
    return counted(size);
}
void* operator new[](std::size_t size) {
    return counted(size);
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

TEST_CASE("no allocation: the counter sees allocations") {
    const int before = allocations;
    delete new int{3};
    CHECK(allocations == before + 1);
}

TEST_CASE("no allocation: adopting, replaying and stepping a local model") {
    MassSpring slab;
    const auto a = empty_models();
    const auto b = empty_models();
    slab.publish(*a, 0, -1, 0.0);
    slab.publish(*b, 1, 20, 0.0);
    b->tool[0].friction = 0.3;
    const auto history = std::make_unique<haptics::PoseHistory>();
    haptics::CouplingState state;
    const int before = allocations;
    adopt(state, *a);
    int replayed = 0;
    for (int tick = 0; tick < 60; ++tick) {
        history->push(tick, {haptics::ToolTip{{1e-4 * tick, 0, 2e-3}, 3e-3}});
        if (tick == 40)
            adopt(state, *b);
        replayed += anchored_tick(state, {}, *history, tick).replayed;
    }
    CHECK(allocations == before);
    CHECK(replayed == 19);
}
