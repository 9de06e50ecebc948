// The solids of the studies against closed forms, published numbers and each other's solvers.
#include "sim/study/solid_run.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

namespace {

double off(double value, double expected) {
    return std::abs(value - expected) / std::abs(expected);
}

// 100 x 20 x 20 mm, 10 kPa, 10 mN on its end, small deflections.
sim::SolidCase bar(double poisson, const char* element, const std::array<int, 3>& cells) {
    sim::SolidCase c;
    c.length_m = 0.1;
    c.height_m = c.width_m = 0.02;
    c.material.young_pa = 10e3;
    c.material.poisson = poisson;
    c.gravity_mps2 = 0.0;
    c.load_n = {0.01};
    c.cells = cells;
    c.model = "linear";
    c.element = element;
    c.statics = true;
    return c;
}

double deflection_m(const sim::SolidCase& c) {
    const sim::SolidResult r = sim::run_solid(c);
    REQUIRE(r.failure.empty());
    CHECK(r.settled);
    return r.row.back().depth_m;
}

// 60 x 40 x 80 mm, glued below, 6 kPa, nu 0, so that it answers as a spring E A/h.
sim::SolidCase block(const char* model, const char* element = "") {
    sim::SolidCase c;
    c.shape = sim::SolidShape::block;
    c.length_m = 0.06;
    c.height_m = 0.04;
    c.width_m = 0.08;
    c.cells = {3, 2, 4};
    c.material.young_pa = 6e3;
    c.material.poisson = 0.0;
    c.gravity_mps2 = 0.0;
    c.model = model;
    c.element = element;
    c.statics = true;
    return c;
}
constexpr double kSpring_npm = 6e3 * 0.06 * 0.08 / 0.04;

// Cook's membrane: lengths in mm, E 1, thickness 10, total shear 10.
double cook_mm(const char* element, const std::array<int, 3>& cells, double poisson) {
    sim::SolidCase c;
    c.shape = sim::SolidShape::membrane;
    c.length_m = 0.048;
    c.height_m = 0.044;
    c.width_m = 0.010;
    c.cells = cells;
    c.material.young_pa = 1e3;
    c.material.poisson = poisson;
    c.gravity_mps2 = 0.0;
    c.load_n = {0.01};
    c.model = "linear";
    c.element = element;
    c.statics = true;
    return 1e3 * sim::run_solid(c).row.back().tip_m.y;
}

} // namespace

TEST_CASE("solid: a bar without lateral contraction bends as Timoshenko's") {
    // P L^3/(3 E I) + P L/(kappa G A), kappa = 10/12 (Cowper 1966): 25.000 + 0.600 mm
    CHECK(off(deflection_m(bar(0.0, "p2", {10, 2, 2})), 25.6e-3) < 5e-3);
}

TEST_CASE("solid: linear tetrahedra lock, quadratic ones do not") {
    // deflections that an independent solver found on the same meshes
    CHECK(off(deflection_m(bar(0.30, "p1", {10, 2, 2})), 13.06e-3) < 1e-3);
    CHECK(off(deflection_m(bar(0.49, "p1", {10, 2, 2})), 3.22e-3) < 2e-3);
    CHECK(off(deflection_m(bar(0.30, "p2", {10, 2, 2})), 25.21e-3) < 1e-3);
    CHECK(off(deflection_m(bar(0.49, "p2", {10, 2, 2})), 23.59e-3) < 1e-3);
}

TEST_CASE("solid: Cook's membrane leans as other tetrahedra let it") {
    CHECK(off(cook_mm("p1", {8, 8, 2}, 0.45), 13.07) < 2e-3);
    CHECK(off(cook_mm("p2", {8, 8, 2}, 1.0 / 3.0), 23.66) < 2e-3);
}

TEST_CASE("solid: a block without lateral contraction is a spring, under pressure and punch") {
    for (const auto& [model, element] :
         {std::pair{"linear", "p1"}, {"linear", "p2"}, {"corotated", "p1"}}) {
        CAPTURE(std::string(model));
        sim::SolidCase c = block(model, element);
        c.load_n = {0.5, 2.0};
        const sim::SolidResult r = sim::run_solid(c);
        REQUIRE(r.row.size() == 2);
        for (int k = 0; k < 2; ++k)
            CHECK(off(r.row[k].depth_m, c.load_n[k] / kSpring_npm) < 1e-7);
    }
    // corotated energy mu |F - R|^2 has no other term: E (stretch - 1) at any depth
    sim::SolidCase c = block("corotated");
    c.press = sim::SolidPress::punch;
    c.depth_m = {1e-3, 0.012};
    const sim::SolidResult r = sim::run_solid(c);
    REQUIRE(r.row.size() == 2);
    for (int k = 0; k < 2; ++k)
        CHECK(off(r.row[k].force_n, kSpring_npm * c.depth_m[k]) < 1e-7);
}

TEST_CASE("solid: small pressure finds the same spring in every model that knows nu = 0") {
    for (const char* model : {"quadratic", "reference", "tled"}) {
        CAPTURE(std::string(model));
        sim::SolidCase c = block(model);
        c.load_n = {1e-3}; // a stretch of 3e-5: what laws differ by
        const sim::SolidResult r = sim::run_solid(c);
        REQUIRE(r.failure.empty());
        // stopped when it stays to 0.1 %
        CHECK(off(r.row.back().depth_m, 1e-3 / kSpring_npm) < 2e-3);
    }
}

TEST_CASE("solid: under a punch the real-time quadratic block pushes back as the reference's") {
    sim::SolidCase c = block("quadratic");
    c.material.poisson = 0.45;
    c.press = sim::SolidPress::punch;
    c.patch_m = 0.02;
    c.cells = {3, 2, 8};
    c.depth_m = {0.004, 0.012};
    const sim::SolidResult ours = sim::run_solid(c);
    c.model = "reference";
    const sim::SolidResult reference = sim::run_solid(c);
    REQUIRE(ours.row.size() == 2);
    REQUIRE(reference.row.size() == 2);
    for (int k = 0; k < 2; ++k) {
        CHECK(off(ours.row[k].depth_m, c.depth_m[k]) < 1e-9);
        CHECK(off(ours.row[k].force_n, reference.row[k].force_n) < 1e-5);
    }
}

TEST_CASE("solid: the settled quadratic beam is within 3 % of the converged one") {
    // CalculiX 2.20 and an independent solver of quadratic tetrahedra
    const glm::dvec3 converged{-38.2e-3, -113.8e-3, 0.0};
    sim::SolidCase c;
    c.statics = true;
    const sim::SolidResult r = sim::run_solid(c);
    REQUIRE(r.settled);
    CHECK(r.nodes == 525);
    CHECK(r.tets == 240);
    CHECK(glm::length(r.row[0].tip_m - converged) < 0.03 * glm::length(converged));
    CHECK(r.worst_residual() < 1e-6);
}

TEST_CASE("solid: steps that damp long enough end where statics do") {
    for (const char* model : {"corotated", "linear", "quadratic"}) {
        CAPTURE(std::string(model));
        sim::SolidCase c;
        c.model = model;
        c.cells = {5, 1, 1};
        c.element = std::string(model) == "linear" ? "p1" : "";
        c.material.damping_mass_1ps = 20.0;
        c.steps = 300;
        const sim::SolidResult moved = sim::run_solid(c);
        CHECK(moved.settled);
        CHECK(moved.worst_linear_residual() < 1e-3);
        CHECK(moved.ms().p99 <= moved.ms().max);
        c.statics = true;
        const sim::SolidResult still = sim::run_solid(c);
        REQUIRE(still.settled);
        CHECK(glm::length(moved.row.back().tip_m - still.row[0].tip_m) <
              1e-3 * glm::length(still.row[0].tip_m));
    }
}

TEST_CASE("solid: baselines take the same steps and come to rest") {
    for (const char* model : {"mass-spring", "xpbd", "tled", "projective"}) {
        CAPTURE(std::string(model));
        sim::SolidCase c;
        c.model = model;
        c.cells = {4, 1, 1};
        c.steps = 20;
        CHECK(sim::run_solid(c).row.size() == 20);
        c.statics = true;
        const sim::SolidResult still = sim::run_solid(c);
        CHECK(still.settled);
        CHECK(still.row.back().tip_m.y < 0.0);
    }
}

TEST_CASE("solid: the middle of the end and its mean are displacements, for any number of cells") {
    for (const std::array<int, 3>& cells : {std::array{4, 2, 2}, {4, 3, 3}, {4, 1, 1}, {3, 2, 1}})
        for (const char* element : {"p1", "p2"}) {
            const sim::SolidBody body = sim::make_solid_body(bar(0.3, element, cells));
            std::vector<glm::dvec3> x = body.rest_m;
            for (glm::dvec3& p : x) // linear in the place: exact for both elements
                p += glm::dvec3{0.1 * p.y, 0.2 * p.z, 0.3 * p.x};
            const glm::dvec3 middle{1e-3, 2e-3, 3e-2};
            CHECK(glm::length(sim::tip_of(body, x) - middle) < 1e-15);
            CHECK(glm::length(sim::mean_of(body, x) - middle) < 1e-15);
        }
}
