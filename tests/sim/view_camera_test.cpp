// tests/sim/view_camera_test.cpp
// Geometry and arithmetic of the picture, without a display.
#include "sim/view/camera_matrix.h"
#include "sim/view/frame_times.h"
#include "sim/view/hud.h"
#include "sim/view/resolution.h"
#include "sim/view/tool_mesh.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

using namespace view;

namespace {

glm::dvec2 pixel(const Camera& camera, const glm::dvec3& place_m, int w, int h) {
    const glm::dvec4 clip = projection_matrix(camera, Lens{.reach = {1.0 * w / h, 1.0}}) *
                            view_matrix(camera) * glm::dvec4(place_m, 1.0);
    return {0.5 * w * (1.0 + clip.x / clip.w), 0.5 * h * (1.0 + clip.y / clip.w)};
}

} // namespace

TEST_CASE(
    "A target of 3 mm is at least 12 px wide at 800 x 600, 150 to 200 mm away, up to 70 deg") {
    for (const double away_m : {0.15, 0.175, 0.20}) {
        Camera camera;
        camera.eye_m = {0.0, 0.0, away_m};
        camera.look_at_m = {0.0, 0.0, 0.0};
        camera.field_of_view_deg = 70.0;
        CHECK(disc_px(camera, {0.0, 0.0, 0.0}, 3e-3, 600) >= 12.0);
    }
}

TEST_CASE("The size of a disc is the distance between its edge's pixels, anywhere in the picture") {
    CHECK(rc::check([] {
        const auto mm = [](int low, int high) { return 1e-3 * *rc::gen::inRange(low, high); };
        Camera camera; // looks along -z, so that a disc facing it lies in a plane of equal depth
        camera.eye_m = {mm(-50, 50), mm(-50, 50), mm(150, 300)};
        camera.look_at_m = camera.eye_m - glm::dvec3(0.0, 0.0, 0.1);
        camera.field_of_view_deg = *rc::gen::inRange(30, 90);
        const glm::dvec3 centre(mm(-60, 60), mm(-60, 60), mm(-40, 40));
        const double r = mm(1, 10);
        const glm::dvec2 a = pixel(camera, centre - glm::dvec3(r, 0, 0), 1280, 720);
        const glm::dvec2 b = pixel(camera, centre + glm::dvec3(r, 0, 0), 1280, 720);
        RC_ASSERT(std::abs(glm::length(b - a) - disc_px(camera, centre, r, 720)) < 1e-6);
    }));
}

TEST_CASE("What is behind the camera has no size") {
    Camera camera;
    camera.eye_m = {0.0, 0.0, 0.1};
    camera.look_at_m = {0.0, 0.0, 0.0};
    CHECK(disc_px(camera, {0.0, 0.0, 0.2}, 3e-3, 600) == 0.0);
}

TEST_CASE("Closed jaws end where the tip sphere ends, at any roll") {
    ToolView tool;
    tool.tip_m = {0.01, -0.02, 0.03};
    tool.fulcrum_m = {0.1, -0.07, 0.16};
    tool.direction = glm::normalize(tool.tip_m - tool.fulcrum_m);
    tool.jaw = 1.0;
    for (const double roll : {0.0, 0.7, 2.5}) {
        tool.roll_rad = roll;
        double reach_m = -1.0;
        for (const ToolPart& part : tool_parts(tool)) {
            if (part.form != ToolPart::Form::ball)
                continue;
            // support of an ellipsoid M S: c.u + |M^T u|
            const glm::dmat4 m(part.model);
            const glm::dvec3 u = tool.direction, c(m[3]);
            const glm::dvec3 mu(glm::dot(glm::dvec3(m[0]), u), glm::dot(glm::dvec3(m[1]), u),
                                glm::dot(glm::dvec3(m[2]), u));
            reach_m = std::max(reach_m, glm::dot(c - tool.tip_m, u) + glm::length(mu));
        }
        CHECK(reach_m ==
              doctest::Approx(tool.tip_radius_m).scale(0.0).epsilon(1e-4)); // matrices are float
    }
}

TEST_CASE("The picture shrinks when drawing is slow, never under 800 x 600, and grows again") {
    for (const auto& [w, h] : {std::pair{1280, 720}, std::pair{1920, 1080}, std::pair{640, 480}}) {
        Resolution resolution;
        for (int i = 0; i < 500; ++i)
            resolution.observe(60.0, w, h);
        CHECK(resolution.share() * w >= std::min(w, 800) - 1e-9);
        CHECK(resolution.share() * h >= std::min(h, 600) - 1e-9);
        CHECK(resolution.share() == Resolution::least_share(w, h)); // used all that is allowed
        for (int i = 0; i < 4000; ++i)
            resolution.observe(5.0, w, h);
        CHECK(resolution.share() == 1.0);
    }
}

TEST_CASE("On any machine the picture comes to rest, quick enough or as small as is allowed") {
    CHECK(rc::check([] {
        const int w = *rc::gen::inRange(800, 4000), h = *rc::gen::inRange(600, 2200);
        const double full_ms = *rc::gen::inRange(2, 400), always_ms = *rc::gen::inRange(0, 8);
        Resolution resolution;
        int changes = 0;
        for (int i = 0; i < 8000; ++i) {
            const double before = resolution.share();
            resolution.observe(always_ms + full_ms * before * before, w, h);
            RC_ASSERT(resolution.share() * w >= 800.0 - 1e-9);
            RC_ASSERT(resolution.share() * h >= 600.0 - 1e-9);
            changes += i >= 4000 && resolution.share() != before ? 1 : 0;
        }
        const double share = resolution.share();
        RC_ASSERT(changes == 0);
        RC_ASSERT(always_ms + full_ms * share * share <= Resolution::kSlow_ms ||
                  share == Resolution::least_share(w, h));
    }));
}

TEST_CASE("A machine on the brink changes size ever more rarely") {
    Resolution resolution;
    int early = 0, late = 0;
    for (int i = 0; i < 20000; ++i) { // too slow for one size, far too quick for the next smaller
        const double before = resolution.share();
        resolution.observe(before > 0.95 ? 40.0 : 8.0, 1920, 1080);
        const int changed = resolution.share() != before ? 1 : 0;
        (i < 4000 ? early : late) += changed;
    }
    CHECK(early > 0);
    CHECK(late < 4 * early); // in four times the time
}

TEST_CASE("The clock shows a second only when it is over") {
    CHECK(clock_text(0.0) == "0:00.0");
    CHECK(clock_text(59.99) == "0:59.9");
    CHECK(clock_text(60.0) == "1:00.0");
    CHECK(clock_text(179.999) == "2:59.9");
    CHECK(clock_text(0.3) == "0:00.3"); // 0.3 is less than three tenths in binary
    CHECK(clock_text(-1.0) == "0:00.0");
}

TEST_CASE("A percentile of frame times is at most one bin above the exact one") {
    FrameTimes times;
    CHECK(times.percentile_ms(0.5) == 0.0);
    for (int i = 1; i <= 1000; ++i)
        times.record(0.1 * i); // 0.1 .. 100 ms
    times.record(1e6);
    times.record(-1.0);
    CHECK(times.pictures() == 1002);
    for (const double share : {0.01, 0.50, 0.99}) {
        CHECK(times.percentile_ms(share) >= 100.0 * share - 0.2); // two strays among a thousand
        CHECK(times.percentile_ms(share) <= 100.0 * share + 0.2 + FrameTimes::kBin_ms);
    }
    CHECK(times.percentile_ms(1.0) > FrameTimes::kMost_ms);
}
