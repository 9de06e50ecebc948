// tests/tissue/onto_skin_test.cpp
// Coarse facets laid on a smooth skin: a block whose top is a paraboloid, known in closed form.
#include "tests/tissue/reference_bodies.h"
#include "tissue/mesh/refine.h"
#include "tissue/reference/indenter.h"
#include "tissue/reference/onto_skin.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <numbers>

namespace {

using glm::dvec3;

constexpr double kSide = 60.0, kHeight = 30.0, kCurve = 40.0; // mm; radius of curvature on top
constexpr double kTip = 1.5;
const dvec3 kMiddle{kSide / 2, kSide / 2, 0.0};

// z = height - (x^2 + y^2) / (2 curve) on top, straight down to a flat bottom
dvec3 bulged(const dvec3& x) {
    const dvec3 d = x - kMiddle;
    return {x.x, x.y, x.z * (1.0 - (d.x * d.x + d.y * d.y) / (2.0 * kCurve * kHeight))};
}

tissue::TetMesh block(int across, int up) {
    auto mesh = tissue::box_mesh({kSide, kSide, kHeight}, {across, across, up});
    for (dvec3& x : mesh.rest_m)
        x = bulged(x);
    return mesh;
}

// The top as it is, and its normal, where x and y are.
dvec3 on_top(const dvec3& x) {
    return bulged({x.x, x.y, kHeight});
}
dvec3 normal_at(const dvec3& x) {
    const dvec3 d = x - kMiddle;
    return glm::normalize(dvec3{d.x / kCurve, d.y / kCurve, 1.0});
}

tissue::SmoothSkin skin() {
    const auto mesh = block(12, 4);
    tissue::ContactSurface surface;
    surface.rest_m = mesh.rest_m;
    surface.triangles = tissue::boundary_triangles(mesh);
    return tissue::make_smooth_skin(surface);
}

// Facets of 15 mm stand off the top by up to 1.4 mm: in the middle of one that is not symmetric.
const dvec3 kPlace = on_top({36.0, 33.0, 0.0});

tissue::RefinedMesh fine(const tissue::SmoothSkin* onto, double edge = 0.5 * kTip) {
    tissue::RefinedMesh r{block(4, 2), {}, {}};
    for (int coarser = 16; coarser >= 1; coarser /= 2) {
        r = tissue::refined(r.mesh, {}, {}, kPlace,
                            {.edge_m = edge * coarser, .core_m = kTip, .growth = 1.0});
        if (onto != nullptr)
            CHECK(tissue::lay_onto_skin(*onto, kPlace, 3 * kTip, r.mesh) < 0.01);
    }
    return r;
}

double degrees_between(const dvec3& a, const dvec3& b) {
    return std::acos(std::min(1.0, glm::dot(glm::normalize(a), glm::normalize(b)))) * 180.0 /
           std::numbers::pi;
}

// Lean of the force on a tip that is pressed square to the true top, shallow.
double lean_deg(const tissue::RefinedMesh& r) {
    const auto mesh = tissue::quadratic_mesh(r.mesh);
    const auto held = reference_bodies::flags(
        mesh, [](const dvec3& x) { return x.z < 1e-9 ? int{tissue::kHeld} : 0; });
    const auto model =
        tissue::make_reference(mesh, bodies::elastic(1.0, 0.45), tissue::Law::neo_hooke, held);
    auto system = tissue::make_system(model);
    auto state = tissue::rest_state(model);
    const auto facets = tissue::make_boundary_tree(r.mesh);
    const auto place_m = tissue::position_m(facets, tissue::nearest_point(facets, kPlace));
    tissue::Press press{.place_m = place_m,
                        .into = -normal_at(kPlace),
                        .radius_m = kTip,
                        .depth_m = {0.2 * kTip},
                        .step_m = 0.1 * kTip};
    press.place_m += tissue::touch_depth_m(mesh, press) * press.into;
    const auto report = tissue::press(model, press, system, state);
    REQUIRE(report.point.size() == 1);
    REQUIRE(glm::length(report.point[0].force_n) > 0.0);
    return degrees_between(report.point[0].force_n, normal_at(kPlace));
}

} // namespace

TEST_CASE("onto skin: between its vertices the smooth skin is the paraboloid, its triangles not") {
    const auto s = skin();
    double worst = 0.0, flat = 0.0;
    for (double x = 20.0; x < 40.0; x += 0.7) {
        for (double y = 20.0; y < 40.0; y += 1.1) {
            const dvec3 at = on_top({x, y, 0.0}), laid = tissue::on_smooth_skin(s, at);
            worst = std::max(worst, std::abs(laid.z - on_top(laid).z));
            flat = std::max(flat, tissue::nearest_point(s.tree, at).distance_m);
        }
    }
    CHECK(flat > 0.1); // h^2 / 4 curve over a diagonal of 5 x 5 mm
    CHECK(worst < 0.03 * flat);
}

TEST_CASE("onto skin: facets near the place lie on it, those far away as before, tets stay sound") {
    const auto s = skin();
    const auto flat = fine(nullptr), laid = fine(&s);
    CHECK_NOTHROW(tissue::check_mesh(laid.mesh));
    CHECK(tissue::least_shape_quality(laid.mesh) > 0.5 * tissue::least_shape_quality(flat.mesh));
    double near = 0.0;
    std::vector<std::uint8_t> outer(laid.mesh.rest_m.size(), 0);
    for (const auto& t : tissue::boundary_triangles(laid.mesh)) {
        for (const auto node : t)
            outer[node] = 1;
    }
    for (std::size_t i = 0; i < outer.size(); ++i) {
        const dvec3& x = laid.mesh.rest_m[i];
        if (outer[i] && glm::distance(x, kPlace) < 3 * kTip)
            near = std::max(near, std::abs(x.z - on_top(x).z));
    }
    CHECK(tissue::nearest_point(tissue::make_boundary_tree(flat.mesh), kPlace).distance_m > 0.3);
    CHECK(near < 0.01);
    // corners of the coarse block keep their numbers
    const auto coarse = block(4, 2);
    int far = 0;
    for (std::size_t i = 0; i < coarse.rest_m.size(); ++i) {
        if (!outer[i] || glm::distance(coarse.rest_m[i], kPlace) < 25.0)
            continue;
        ++far;
        CHECK(laid.mesh.rest_m[i] == coarse.rest_m[i]);
    }
    CHECK(far > 20);
}

TEST_CASE("onto skin: laid at once by more than its edges, no tet turns over and the gap is told") {
    const auto s = skin();
    auto r = fine(nullptr, 0.2 * kTip);
    const double before = tissue::volume_m3(r.mesh, r.mesh.rest_m);
    const double off = tissue::lay_onto_skin(s, kPlace, 3 * kTip, r.mesh);
    CHECK_NOTHROW(tissue::check_mesh(r.mesh));
    CHECK(tissue::volume_m3(r.mesh, r.mesh.rest_m) > before);
    double worst = 0.0;
    for (const auto& t : tissue::boundary_triangles(r.mesh)) {
        for (const auto node : t) {
            const dvec3& x = r.mesh.rest_m[node];
            if (glm::distance(x, kPlace) < 3 * kTip)
                worst = std::max(worst, glm::distance(tissue::on_smooth_skin(s, x), x));
        }
    }
    CHECK(off == doctest::Approx(worst).epsilon(1e-12).scale(1.0));
}

TEST_CASE("onto skin: a first touch leans as the organ and not as its facet") {
    const auto s = skin();
    CHECK(lean_deg(fine(&s)) < 1.5);
    CHECK(lean_deg(fine(nullptr)) > 5.0); // negative control
}
