// sim/study/failure_cracks.cpp
// F3, cracks: two plates in one plane, 1000 mm from the origin, between which single precision left
// 1 um. A point falls through when a tick ends over the crack: 1 um of the 50 um that it moves in
// one. And the vertex that 8 triangles share, crossed within 1 um: there is no crack.
#include "sim/study/failure_bench.h"

#include <cmath>

namespace sim::failure {
namespace {

constexpr int kCrossings = 1000;
constexpr double kSpeed_mps = 0.05, kDeep_m = 1e-3, kRadius_m = 1e-3, kSize_m = 0.01;

/// How many slides over the origin of `scene` end below it.
int falls(Scene& scene, const ContactMethod& method, const dvec3& middle_m, double beside_m,
          bool any_way, Random& random) {
    int fallen = 0;
    for (int i = 0; i < kCrossings; ++i) {
        scene.state = {};
        const double turn = any_way ? random.between(0.0, 2.0 * kPi) : 0.0;
        const dvec3 way{std::cos(turn), std::sin(turn), 0.0}, aside{-way.y, way.x, 0.0};
        const double phase_m = random.between(0.0, kSpeed_mps * kTick_s);
        const dvec3 start_m =
            middle_m + random.between(-beside_m, beside_m) * aside - (2.5e-4 + phase_m) * way;
        scene.tick(method, start_m + dvec3{0, 0, scene.input.radius_m + 1e-4});
        for (int k = 0; k < 10; ++k)
            scene.tick(method, start_m + k * kSpeed_mps * kTick_s * way +
                                   dvec3{0, 0, scene.input.radius_m - kDeep_m});
        fallen += !(scene.state.force_n.z > 0.0);
    }
    return fallen;
}

} // namespace

void cracks(const ContactMethod& method, std::uint64_t seed, Rows& rows) {
    Random random{std::mt19937_64(seed)};
    Scene crack;
    const double left_m = float(1.0), right_m = float(1.000001); // what a file would give
    crack.quad({left_m - kSize_m, -kSize_m, 0}, {left_m, -kSize_m, 0}, {left_m, kSize_m, 0},
               {left_m - kSize_m, kSize_m, 0});
    crack.quad({right_m, -kSize_m, 0}, {right_m + kSize_m, -kSize_m, 0},
               {right_m + kSize_m, kSize_m, 0}, {right_m, kSize_m, 0});
    crack.ready();
    crack.input.radius_m = ball_m(method, kRadius_m);
    const bool wrong = method.name == "god-object";
    const int fallen = falls(crack, method, {1.0, 0, 0}, 5e-3, false, random);
    rows.at_most("F3", method.name, "falls through a crack of 1 um, of 1000", fallen, 0, wrong);
    if (wrong) { // 3.5 standard deviations of the count
        const double expected = kCrossings * (right_m - left_m) / (kSpeed_mps * kTick_s);
        rows.near("F3", method.name, "falls, expected of 1 um in 50 um", fallen, expected,
                  3.5 / std::sqrt(expected), true);
    }

    Scene fan; // 8 triangles about (1, 0.3, 0), in single precision
    const dvec3 middle_m{1.0, float(0.3), 0.0};
    fan.vertex.push_back(middle_m);
    for (int i = 0; i < 8; ++i)
        fan.vertex.push_back({float(1.0 + kSize_m * std::cos(0.25 * kPi * i + 0.1)),
                              float(0.3 + kSize_m * std::sin(0.25 * kPi * i + 0.1)), 0.0});
    for (std::uint32_t i = 0; i < 8; ++i)
        fan.triangle.push_back({0, 1 + i, 1 + (i + 1) % 8});
    fan.ready();
    fan.input.radius_m = crack.input.radius_m;
    rows.at_most("F3", method.name, "falls through a vertex of 8 triangles, of 1000",
                 falls(fan, method, middle_m, 1e-6, true, random), 0, false);
}

} // namespace sim::failure
