// tests/sim/view_optics_test.cpp
// Lens, lamp, exposure, shade and looks of the picture, without a display.
#include "sim/view/camera_matrix.h"
#include "sim/view/light.h"
#include "sim/view/open_sky.h"
#include "sim/view/tissue_style.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

using namespace view;

namespace {

/// A square sheet of n x n vertices around the z axis, facing along z (or against it).
struct Sheet {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<glm::vec3> place, normal;

    Sheet(std::uint32_t n, float side_m, float z_m, float facing) {
        for (std::uint32_t j = 0; j < n; ++j)
            for (std::uint32_t i = 0; i < n; ++i) {
                const auto at = [&](std::uint32_t k) {
                    return side_m * (static_cast<float>(k) / static_cast<float>(n - 1) - 0.5F);
                };
                place.emplace_back(at(i), at(j), z_m);
                normal.emplace_back(0.0F, 0.0F, facing);
                if (i + 1 < n && j + 1 < n) {
                    const std::uint32_t a = j * n + i;
                    triangles.push_back({a, a + 1, a + n});
                    triangles.push_back({a + n, a + 1, a + n + 1});
                }
            }
    }
    SurfaceView view(int id) const { return {id, Look::tissue, triangles, place, place, normal}; }
};

} // namespace

TEST_CASE("The lens keeps the middle's size and shows at the rim what a pinhole has at the edge") {
    for (const auto& [w, h] : {std::pair{1280, 720}, std::pair{800, 600}, std::pair{1024, 1024}}) {
        const Lens lens = lens_of(w, h);
        CHECK(radial_scale(lens, 0.0) == 1.0);
        const glm::dvec2 edge = pinhole_place(lens, {lens.rim, 0.0});
        CHECK(edge.x == doctest::Approx(static_cast<double>(w) / h).scale(0.0));
        CHECK(edge.x == doctest::Approx(lens.reach.x).scale(0.0));
    }
}

TEST_CASE("Everything inside the round picture lies inside what is drawn for it") {
    CHECK(rc::check([] {
        const int w = *rc::gen::inRange(300, 4000), h = *rc::gen::inRange(300, 3000);
        const Lens lens = lens_of(w, h);
        const double aspect = static_cast<double>(w) / h;
        const auto part = [] { return 1e-3 * *rc::gen::inRange(-1000, 1001); };
        glm::dvec2 at(aspect * part(), part());
        at *= std::min(1.0, lens.rim / std::max(1e-9, glm::length(at)));
        const glm::dvec2 from = pinhole_place(lens, at);
        RC_ASSERT(std::abs(from.x) <= lens.reach.x + 1e-12);
        RC_ASSERT(std::abs(from.y) <= lens.reach.y + 1e-12);
        // there and back
        RC_ASSERT(std::abs(seen_radius(lens, glm::length(from)) - glm::length(at)) < 1e-12);
    }));
}

TEST_CASE("A target anywhere in the round picture is at least 12 px wide after the lens") {
    CHECK(rc::check([] {
        const auto [w, h] = *rc::gen::element(std::pair{1280, 720}, std::pair{800, 600});
        const Lens lens = lens_of(w, h);
        Camera camera;
        camera.eye_m = {0.0, 0.0, 0.0};
        camera.look_at_m = {0.0, 0.0, -1.0};
        const double half = std::tan(0.5 * field_of_view_rad(camera));
        const double s = lens.rim * 1e-3 * *rc::gen::inRange(0, 1000);
        const double depth = 1e-3 * *rc::gen::inRange(50, 900);
        TargetView target;
        target.position_m = depth * glm::dvec3(half * pinhole_place(lens, {s, 0.0}), -1.0);
        const double radius_m = drawn_radius_m(camera, lens, target, h);
        RC_ASSERT(radius_m >= 3e-3);
        // its edges along the radius, where the lens shrinks most, each through the lens
        const double centre = s * (1.0 + lens.barrel * s * s), r = radius_m / (depth * half);
        const double wide =
            0.5 * h * (seen_radius(lens, centre + r) - seen_radius(lens, std::abs(centre - r)));
        const double wide_px = centre > r ? wide : h * seen_radius(lens, r);
        RC_ASSERT(mark_facing(camera, target) * wide_px >= kLeastMark_px - 0.3);
    }));
}

TEST_CASE("The lamp falls with the square of the distance, and exposure makes up for it") {
    Camera camera;
    camera.eye_m = {0.0, 0.0, 0.0};
    camera.look_at_m = {0.0, 0.0, -1.0};
    CHECK(lamp(camera, {0.0, 0.0, -0.16}) == doctest::Approx(1.0).scale(0.0));
    CHECK(lamp(camera, {0.0, 0.0, -0.8}) / lamp(camera, {0.0, 0.0, -0.4}) ==
          doctest::Approx(0.25).scale(0.0).epsilon(0.01)); // the lamp's own size is 0.04 m
    CHECK(lamp(camera, {0.0, 0.0, 0.1}) == 0.0);
    for (const double away_m : {0.12, 0.16, 0.22}) {
        const Sheet sheet(60, 0.3F, static_cast<float>(-away_m), 1.0F);
        ViewFrame frame;
        frame.camera = camera;
        frame.surfaces = {sheet.view(1)};
        CHECK(exposure(frame) * lamp(camera, {0.0, 0.0, -away_m}) ==
              doctest::Approx(1.0).scale(0.0).epsilon(
                  0.15)); // the middle is a little brighter than the rest
    }
    CHECK(exposure(ViewFrame{}) == 1.0);
}

TEST_CASE("Two sheets face to face hide as much of the sky as their form factor says") {
    constexpr float kSide_m = 0.10F, kGap_m = 0.05F;
    const Sheet low(41, kSide_m, 0.0F, 1.0F), high(41, kSide_m, kGap_m, -1.0F);
    const std::vector<SurfaceView> both{low.view(1), high.view(2)};
    // from the middle of one square to the other at half a side's distance: 4 times that of a
    // quarter with its corner above (Howell, factor B-4), A = B = 1
    const double a = 1.0 / std::sqrt(2.0);
    const double factor = 4.0 / (2.0 * std::numbers::pi) * 2.0 * a * std::atan(a);
    const std::vector<float> open = open_sky(both, 0);
    CHECK(1.0 - open[41 * 20 + 20] ==
          doctest::Approx(factor).scale(0.0).epsilon(0.05)); // discs for a square
    CHECK(open[0] > open[41 * 20 + 20]);
    const std::vector<SurfaceView> alone{low.view(1)};
    for (const float share : open_sky(alone, 0))
        CHECK(share == 1.0F);
}

TEST_CASE("Every look has its word and colours of its own") {
    for (std::size_t i = 0; i < kLookWords.size(); ++i) {
        CHECK(look_named(kLookWords[i]) == static_cast<Look>(i));
        const TissueStyle& style = style_of(static_cast<Look>(i));
        for (int c = 0; c < 3; ++c)
            CHECK(style.deep[c] < style.pale[c]);
        for (std::size_t j = 0; j < i; ++j)
            CHECK(glm::distance(style.pale, style_of(static_cast<Look>(j)).pale) > 0.02F);
    }
    CHECK(look_named("block") == Look::tissue);
}
