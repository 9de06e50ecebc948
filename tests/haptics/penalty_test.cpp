#include "haptics/contact/penalty.h"

#include "tests/haptics/proxy_bench.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>

namespace {

using glm::dvec3;
using haptics::step_penalty;
using proxy_bench::Bench;

// A closed box of the given half sizes, facing out.
Bench box(const dvec3& h) {
    Bench b;
    b.quad({-h.x, -h.y, h.z}, {h.x, -h.y, h.z}, {h.x, h.y, h.z}, {-h.x, h.y, h.z});
    b.quad({-h.x, h.y, -h.z}, {h.x, h.y, -h.z}, {h.x, -h.y, -h.z}, {-h.x, -h.y, -h.z});
    b.quad({h.x, -h.y, -h.z}, {h.x, h.y, -h.z}, {h.x, h.y, h.z}, {h.x, -h.y, h.z});
    b.quad({-h.x, -h.y, h.z}, {-h.x, h.y, h.z}, {-h.x, h.y, -h.z}, {-h.x, -h.y, -h.z});
    b.quad({-h.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, -h.z}, {-h.x, h.y, -h.z});
    b.quad({-h.x, -h.y, -h.z}, {h.x, -h.y, -h.z}, {h.x, -h.y, h.z}, {-h.x, -h.y, h.z});
    return b;
}

} // namespace

TEST_CASE("penalty: a face pushes with k times the depth, a ball from its radius on") {
    Bench b = box({0.05, 0.05, 0.02});
    b.input.stiffness_npm = 800.0;
    CHECK(glm::length(b.lead(step_penalty, {0.01, 0.02, 0.017}).force_n - dvec3{0, 0, 2.4}) <
          1e-12);
    CHECK_FALSE(b.lead(step_penalty, {0.01, 0.02, 0.0201}).touching);
    b.input.radius_m = 0.003;
    CHECK(glm::length(b.lead(step_penalty, {0.01, 0.02, 0.021}).force_n - dvec3{0, 0, 1.6}) <
          1e-12);
    CHECK(glm::length(b.lead(step_penalty, {0.01, 0.02, 0.019}).force_n - dvec3{0, 0, 3.2}) <
          1e-12);
    CHECK(glm::length(b.state.force_n - 800.0 * (b.state.proxy_m - b.input.device_m)) < 1e-12);
}

TEST_CASE("penalty: beyond the middle of a plate it pushes out on the far side") {
    Bench b = box({0.05, 0.05, 0.001});
    b.input.stiffness_npm = 800.0;
    CHECK(b.lead(step_penalty, {0, 0, 1e-6}).force_n.z ==
          doctest::Approx(800 * 0.999e-3).scale(0.0));
    CHECK(b.lead(step_penalty, {0, 0, -1e-6}).force_n.z ==
          doctest::Approx(-800 * 0.999e-3).scale(0.0));
}

TEST_CASE("penalty: the push off an edge is along the line from it, and the ridge has one side") {
    Bench b = box({0.05, 0.05, 0.02});
    b.input.radius_m = 0.005;
    const dvec3 off{0.003, 0.0, 0.004}; // 5 mm from the edge: just touching
    CHECK_FALSE(b.lead(step_penalty, dvec3{0.05, 0.0, 0.02} + 1.01 * off).touching);
    const dvec3 f = b.lead(step_penalty, dvec3{0.05, 0.0, 0.02} + 0.5 * off).force_n;
    CHECK(glm::length(f - 500.0 * 0.0025 * off / 0.005) < 1e-9);
    // beside a roof of 20 degrees, where the plane of the far side says "inside"
    Bench roof;
    const double s = std::sin(0.17453292519943295), c = std::cos(0.17453292519943295);
    roof.quad({-s, -1, -c}, {0, -1, 0}, {0, 1, 0}, {-s, 1, -c});
    roof.quad({s, 1, -c}, {0, 1, 0}, {0, -1, 0}, {s, -1, -c});
    for (const double side : {-1.0, 1.0})
        CHECK_FALSE(roof.lead(step_penalty, {side * 0.01, 0, 0.005}).touching);
}

TEST_CASE("penalty: what is not finite gives no force") {
    Bench b = box({0.05, 0.05, 0.02});
    b.lead(step_penalty, {0, 0, 0.019});
    REQUIRE(glm::length(b.state.force_n) > 0.0);
    b.lead(step_penalty, {0, std::numeric_limits<double>::quiet_NaN(), 0.019});
    CHECK(b.state.force_n == dvec3{0.0});
    b.lead(step_penalty, {0, std::numeric_limits<double>::infinity(), 0.019});
    CHECK(b.state.force_n == dvec3{0.0});
}
