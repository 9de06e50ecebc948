// sim/study/failure_voronoi.cpp
// F2, Voronoi boundary: 3 mm inside a box of 40 mm the device crosses the bisector of an edge by
// 0.01 mm. The nearest face is another then: the force of a penalty turns by 90 degrees and jumps
// by sqrt(2) K d.
#include "sim/study/failure_bench.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace sim::failure {

void voronoi(const ContactMethod& method, std::uint64_t, Rows& rows) {
    constexpr double kHalf_m = 0.02, kDeep_m = 3e-3, kStep_m = 1e-5, kStiff_npm = 800.0;
    Scene scene;
    scene.box({-kHalf_m, -kHalf_m, -kHalf_m}, {kHalf_m, kHalf_m, kHalf_m});
    scene.ready();
    scene.input.radius_m = ball_m(method, 1e-3);
    scene.input.stiffness_npm = kStiff_npm;

    // down through the upper face beside the bisector, then across it
    const double at_m = kHalf_m + scene.input.radius_m - kDeep_m;
    const double beside_m = kHalf_m - kDeep_m - 0.5 * kStep_m;
    for (int i = 0; i <= 40; ++i)
        scene.tick(method, {beside_m, 1e-3, at_m + 1e-4 * (40 - i)});
    const dvec3 before_n = scene.state.force_n;
    const dvec3 after_n = scene.tick(method, {beside_m + kStep_m, 1e-3, at_m}).force_n;

    const double jump_n = glm::length(after_n - before_n);
    const double turn =
        std::clamp(glm::dot(glm::normalize(after_n), glm::normalize(before_n)), -1.0, 1.0);
    const bool wrong = method.name == "penalty";
    if (wrong) {
        rows.near("F2", method.name, "jump of force, N", jump_n,
                  std::sqrt(2.0) * kStiff_npm * kDeep_m, 0.01, true);
        rows.near("F2", method.name, "turn of force, deg", std::acos(turn) * 180.0 / kPi, 90.0,
                  0.01, true);
    }
    rows.at_most("F2", method.name, "jump of force over 0.01 mm, N", jump_n,
                 2.0 * kStiff_npm * kStep_m, wrong);
    rows.at_most("F2", method.name, "turn of force over 0.01 mm, deg",
                 std::acos(turn) * 180.0 / kPi, kStep_m / kDeep_m * 180.0 / kPi, wrong);
}

} // namespace sim::failure
