// tests/haptics/collision_membrane_test.cpp
// A tip before a membrane thinner than its step, by every method of collision.
#include "haptics/collision/index.h"
#include "tests/haptics/collision_meshes.h"
#include "tests/haptics/effort.h"

#include <cmath>
#include <doctest/doctest.h>

namespace {

using glm::dvec3;
using haptics::CollisionIndex;

// A membrane 0.5 mm thick and 40 mm wide that moves up at `speed_mps`, waving.
void set_membrane(CollisionMesh& mesh, const CollisionMesh& flat, double time_s, double speed_mps) {
    mesh.before = mesh.vertex;
    for (std::size_t v = 0; v < mesh.vertex.size(); ++v) {
        const dvec3 p = flat.vertex[v];
        mesh.vertex[v] = {0.02 * p.x, 0.02 * p.y,
                          p.z + speed_mps * time_s +
                              1e-3 * std::sin(4.0 * p.x + 6.0 * p.y + 30.0 * speed_mps * time_s)};
    }
}

double height_of(const CollisionMesh& mesh, double x, double y) { // upper face, by a long cast
    return cast_segment(haptics::make_brute_force(mesh.view()), mesh.view(), {x, y, 1.0},
                        {x, y, -1.0})
        .place_m.z;
}

int missed_crossings(std::string_view name, double membrane_mps, double radius_m) {
    constexpr double kTick_s = 1e-3;
    constexpr int kTicks = 20, kTogether = effort::cases(1000), kWindows = 10; // 10^4 crossings
    CollisionRandom random{std::mt19937_64(29)};
    CollisionMesh flat;
    add_sheet(flat, 14, 0.0);
    add_sheet(flat, 14, 0.5e-3);
    CollisionMesh mesh = flat;
    set_membrane(mesh, flat, 0.0, membrane_mps);
    mesh.before = mesh.vertex;
    CollisionIndex index = haptics::make_index(name, mesh.view());
    int missed = 0;
    for (int window = 0; window < kWindows; ++window) {
        struct Tip {
            dvec3 at_m, velocity_mps;
            bool hit;
        };
        std::vector<Tip> tip;
        set_membrane(mesh, flat, 0.0, membrane_mps);
        for (int i = 0; i < kTogether; ++i) {
            const double x = random.between(-0.01, 0.01), y = random.between(-0.01, 0.01);
            const double top_m = height_of(mesh, x, y) + radius_m + 1e-6;
            const double down_mps = random.between(0.1, 2.0); // in, but for the slowest also out
            const double way_m = random.between(0.0, (down_mps + membrane_mps) * 8 * kTick_s);
            tip.push_back({{x, y, top_m + way_m},
                           {random.between(-0.1, 0.1), random.between(-0.1, 0.1), -down_mps},
                           false});
        }
        for (int tick = 1; tick <= kTicks; ++tick) {
            set_membrane(mesh, flat, tick * kTick_s, membrane_mps);
            refit(index, mesh.view());
            for (Tip& t : tip) {
                const dvec3 to_m = t.at_m + kTick_s * t.velocity_mps;
                t.hit = t.hit || sweep_sphere(index, mesh.view(), t.at_m, to_m, radius_m).hit();
                t.at_m = to_m;
            }
        }
        for (const Tip& t : tip) {
            REQUIRE(t.at_m.z < height_of(mesh, t.at_m.x, t.at_m.y)); // it did go in
            missed += !t.hit;
        }
    }
    return missed;
}

} // namespace

TEST_CASE("collision: no tip gets through a membrane of 0.5 mm, at rest or coming at 200 mm/s") {
    for (const std::string_view name : haptics::kCollisionNames) {
        if (name == "brute-force")
            continue; // the same answers, slowly
        CAPTURE(name);
        for (const double speed_mps : {0.0, 0.2})
            for (const double radius_m : {0.0, 0.5e-3})
                CHECK(missed_crossings(name, speed_mps, radius_m) == 0);
    }
}
