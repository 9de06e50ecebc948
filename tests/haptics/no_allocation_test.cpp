// tests/haptics/no_allocation_test.cpp
// What runs at 1 kHz in haptics/ allocates nothing.
#include "haptics/contact/coupling.h"

#include "haptics/collision/index.h"
#include "haptics/collision/witness.h"
#include "haptics/contact/god_object.h"
#include "haptics/contact/penalty.h"
#include "haptics/contact/safe_proxy.h"
#include "haptics/contact/vertex_normals.h"
#include "haptics/contact/virtual_proxy.h"
#include "haptics/device/trocar.h"
#include "haptics/device/virtual_device.h"
#include "haptics/rigid/voxel_contacts.h"
#include "haptics/safety/limits.h"
#include "tests/haptics/collision_meshes.h"
#include "tests/haptics/mass_spring.h"
#include "tests/haptics/proxy_bench.h"
#include "tests/haptics/rigid_scenes.h"
#include "tests/haptics/tool_bench.h"

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
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { // std::stable_sort
    ++allocations;
    return std::malloc(size > 0 ? size : 1);
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

TEST_CASE("no allocation: from device sample to limited force") {
    haptics::VirtualDevice device({}, {0, 0, 0.1});
    haptics::LimitState limits;
    haptics::EnergyObserver observer;
    const int before = allocations;
    haptics::DeviceSample sample;
    for (int tick = 0; tick < 50; ++tick) {
        const haptics::DeviceFault fault = device.read(sample);
        const haptics::ShaftPose pose = haptics::shaft_pose({}, device.handle_m());
        const glm::dvec3 wanted_n = haptics::force_at_handle(pose, {0.1, 0, 0.2});
        const glm::dvec3 force_n = haptics::limit_force(limits, {}, wanted_n, fault);
        haptics::observe_energy(observer, device.handle_m(), force_n);
        device.write(force_n);
        device.step(1e-3);
    }
    CHECK(allocations == before);
    CHECK(device.handle_m().x != 0.0);
}

TEST_CASE("no allocation: every contact method for a ball, on one of many faces") {
    for (auto* step : {haptics::step_penalty, haptics::step_god_object, haptics::step_virtual_proxy,
                       haptics::step_safe_proxy}) {
        proxy_bench::Bench b = proxy_bench::crumpled_ball(1);
        b.index = haptics::make_index("ours", b.mesh());
        b.input.radius_m = 1e-3;
        b.input.static_friction = b.input.dynamic_friction = 0.3;
        std::vector<glm::dvec3> normal(b.vertex.size());
        proxy_bench::Hand hand{std::mt19937_64(1)};
        const int before = allocations;
        haptics::angle_weighted_normals(b.mesh(), normal); // for those that shade
        b.input.vertex_normal = normal;
        int touched = 0;
        for (int i = 0; i < 500; ++i)
            touched += b.lead(step, hand.next()).touching;
        CHECK(allocations == before);
        CHECK(touched > 100);
    }
}

TEST_CASE("no allocation: rigid tools pressed into rigid scenery and each other") {
    RigidRig rig({body(u_surface()), body(torus_surface(0.02, 0.006, 16, 10))},
                 {body(l_surface()), body("box", {box(glm::dvec3{5e-3})})});
    const int before = allocations;
    std::uint32_t contacts = 0;
    for (int tick = 0; tick < 300; ++tick) {
        const std::array<haptics::RigidPose, 2> device{
            haptics::RigidPose{turn({1, 2, 3}, 0.01 * tick), {0, 0, 0.02 - 1e-4 * tick}},
            haptics::RigidPose{turn({3, 2, 1}, 0.02 * tick), {0, 1e-4 * tick, 0.01}}};
        haptics::step_rigid(rig.model, device, rig.state, rig.scratch, rig.tick);
        contacts += rig.tick.contacts.count;
    }
    CHECK(allocations == before);
    CHECK(contacts > 300);
}

TEST_CASE("no allocation: a shell of points in a voxel map") {
    const haptics::VoxelMap map = haptics::make_voxel_map(l_surface(), 2e-3);
    const haptics::PointShell shell = haptics::make_point_shell(cube_surface(5e-3), 2e-3);
    auto scratch = haptics::reserve_for(shell);
    haptics::ContactList contacts;
    const int before = allocations;
    haptics::voxel_contacts(map, {}, shell, {glm::dmat3(1.0), {0.02, 0, 0.014}}, {}, scratch,
                            contacts);
    CHECK(allocations == before);
    CHECK(contacts.count > 0);
}

TEST_CASE("no allocation: asking and refitting any collision method, also after a blow-up") {
    CollisionRandom random{std::mt19937_64(1)};
    CollisionMesh mesh = height_field(random, 20);
    const haptics::Neighbours neighbours = haptics::make_neighbours(mesh.view());
    mesh.before = mesh.vertex;
    std::array<haptics::SurfaceHit, 8> found;
    for (const std::string_view name : haptics::kCollisionNames) {
        CAPTURE(name);
        const haptics::CollisionIndex made = haptics::make_index(name, mesh.view());
        haptics::CollisionIndex index = made; // of two, as their owner has: a copy has room too
        haptics::Witness witness{neighbours};
        int hits = 0;
        const int before = allocations;
        for (int i = 0; i < 40; ++i) {
            const glm::dvec3 from = random.place(1.0), to = random.place(1.0);
            const haptics::MeshView view = mesh.view();
            hits += closest_within(index, view, from, 1.0).hit();
            hits += cast_segment(index, view, from, to).hit();
            hits += sweep_sphere(index, view, from, to, 0.01).hit();
            hits += sweep_shaft(index, view, {from, to, to, from}, 0.01).hit();
            hits +=
                contacts_within(index, view, from, 0.2, std::span<haptics::SurfaceHit>(found)) > 0;
            std::visit(
                [&](const auto& m) {
                    hits += closest_within_cached(m, view, from, 1.0, witness).hit();
                },
                index);
            for (glm::dvec3& v : mesh.vertex)
                v += random.place(i == 20 ? 2.0 : 0.01);
            refit(index, mesh.view());
        }
        CHECK(allocations == before);
        CHECK(hits > 40);
    }
}

TEST_CASE("no allocation: two instruments on a mesh that moves, and on each other") {
    tool_bench::Scene s = tool_bench::bumpy(1, 12, 0.04, 8e-3);
    s.add({-0.06, 0, 0.035}, {0.03, 0, 0.03}, 3e-3, 1e-3);
    s.add({0, -0.06, 0.05}, {0, 0.03, 0.05}, 3e-3, 1e-3);
    s.before = s.vertex;
    const int before = allocations;
    int touched = 0;
    for (int i = 0; i < 300; ++i) {
        s.in[0].device_m.z -= 1e-4;
        s.in[1].device_m.z -= 2e-4;
        s.step();
        touched += s.tool(0).touching + s.tool(1).touching;
    }
    CHECK(allocations == before);
    CHECK(touched > 100);
}
