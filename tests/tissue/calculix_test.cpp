// tests/tissue/calculix_test.cpp
// The reference solver beside CalculiX on equal meshes, with the same energy and quadrature.
#include "tests/tissue/calculix.h"
#include "tests/tissue/reference_bodies.h"

#include <doctest/doctest.h>

using bodies::elastic;
using glm::dvec3;
using reference_bodies::flags;
using tissue::kHeld;

namespace {

// Without the program nothing is compared, and ctest says so: see SKIP_REGULAR_EXPRESSION.
bool skipped(const std::string& name) {
    if (!calculix::program().empty())
        return false;
    MESSAGE("SKIPPED: ", name, ": no program ccx on PATH (Debian package calculix-ccx)");
    return true;
}

struct Difference {
    double moved = 0.0; // greatest of a node, of the greatest displacement
    double force = 0.0; // greatest of a node, of the greatest internal force
};

Difference difference(const reference_bodies::Solved& ours, const calculix::Answer& theirs) {
    const auto& mesh = ours.model.mesh;
    std::vector<dvec3> force(mesh.rest_m.size());
    elastic_forces(ours.model, ours.state.position_m, force);
    Difference greatest;
    double moved_m = 0.0, force_n = 0.0;
    for (std::size_t i = 0; i < force.size(); ++i) {
        const dvec3 u = ours.state.position_m[i] - mesh.rest_m[i];
        moved_m = std::max(moved_m, glm::length(u));
        greatest.moved = std::max(greatest.moved, glm::length(u - theirs.moved_m[i]));
        force_n = std::max(force_n, glm::length(force[i]));
        greatest.force = std::max(greatest.force, glm::length(force[i] - theirs.internal_n[i]));
    }
    return {greatest.moved / moved_m, greatest.force / force_n};
}

// As good as seven printed digits can be: a disagreement of method would be thousands of times
// more.
constexpr double kPrinted = 1e-6;

calculix::Problem described(const tissue::QuadraticMesh& mesh, const tissue::Material& material,
                            const std::vector<std::uint8_t>& held, const std::vector<dvec3>& held_m,
                            const dvec3& gravity) {
    // C10 = mu/2, D1 = 2/K
    const double young = material.young_pa, nu = material.poisson;
    return {.mesh = mesh,
            .c10_pa = young / (4 * (1 + nu)),
            .d1_1pa = 6 * (1 - 2 * nu) / young,
            .density_kgpm3 = material.density_kgpm3,
            .gravity_mps2 = gravity,
            .held = held,
            .held_m = held_m};
}

struct Compared {
    reference_bodies::Solved ours;
    calculix::Answer theirs;
};

Compared compare(const tissue::QuadraticMesh& mesh, const tissue::Material& material,
                 const std::vector<std::uint8_t>& held, const std::vector<dvec3>& held_m,
                 const dvec3& gravity) {
    auto ours = reference_bodies::solve(mesh, material, tissue::Law::neo_hooke, held, {{}, held_m},
                                        gravity);
    return {std::move(ours), calculix::solve(described(mesh, material, held, held_m, gravity))};
}

void check(const reference_bodies::Solved& ours, const calculix::Answer& theirs) {
    CHECK(ours.report.converged);
    const Difference d = difference(ours, theirs);
    CHECK(d.moved < kPrinted);
    CHECK(d.force < kPrinted);
    MESSAGE("E ", ours.model.material.young_pa, " Pa, nu ", ours.model.material.poisson,
            ": displacements agree to ", d.moved, ", forces to ", d.force, "; ours ",
            ours.report.iterations, " iterations, least det F ", ours.report.min_det_f, "; ccx ",
            theirs.seconds, " s");
}

} // namespace

TEST_CASE("heavy beams hang where CalculiX lets the same quadratic tetrahedra hang") {
    if (skipped("heavy beams"))
        return;
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh({0.2, 0.04, 0.04}, {10, 2, 2}));
    const auto held = flags(mesh, [](const dvec3& x) { return x.x < 1e-9 ? kHeld : 0; });
    for (const double poisson : {0.3, 0.45}) {
        for (const double young : {100e3, 30e3}) {
            const auto [ours, theirs] =
                compare(mesh, elastic(young, poisson), held, {}, {0, -9.81, 0});
            check(ours, theirs);
        }
    }
}

TEST_CASE("a block pressed by a quarter of its height deforms and pushes back as in CalculiX") {
    if (skipped("pressed block"))
        return;
    const dvec3 size{0.03, 0.03, 0.03};
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh(size, {3, 3, 3}, 0.2, 3));
    const auto pressed = [&](const dvec3& x) {
        return x.z > size.z - 1e-9 &&
               std::max(std::abs(x.x - 0.015), std::abs(x.y - 0.015)) < 0.008;
    };
    const auto target = reference_bodies::places(
        mesh, [&](const dvec3& x) { return x - dvec3(0, 0, pressed(x) ? size.z / 4 : 0); });
    for (const double poisson : {0.3, 0.45}) {
        // a tool that sticks, and one that slides
        for (const std::uint8_t tool : {kHeld, tissue::kHeldZ}) {
            const auto held = flags(mesh, [&](const dvec3& x) {
                return x.z < 1e-9 ? kHeld : pressed(x) ? tool : 0;
            });
            const auto [ours, theirs] =
                compare(mesh, elastic(10e3, poisson), held, target, dvec3{0.0});
            check(ours, theirs);
        }
    }
}

TEST_CASE("a beam let go falls as in CalculiX, but for what the two rules differ in second order") {
    if (skipped("falling beam"))
        return;
    // midpoint against trapezoidal: the same limit, errors of order dt^2
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh({0.2, 0.04, 0.04}, {10, 2, 2}));
    const auto held = flags(mesh, [](const dvec3& x) { return x.x < 1e-9 ? kHeld : 0; });
    const dvec3 gravity{0, -9.81, 0};
    const tissue::Material material = elastic(100e3, 0.3);
    const auto moved = [&](int steps) {
        const double dt_s = 0.12 / steps;
        reference_bodies::Solved ours{
            make_reference(mesh, material, tissue::Law::neo_hooke, held, gravity), {}, {}};
        ours.state = rest_state(ours.model);
        tissue::ReferenceSystem system = make_system(ours.model);
        for (int n = 0; n < steps; ++n) {
            REQUIRE(step(ours.model, {}, dt_s, tissue::TimeRule::midpoint, {}, system, ours.state)
                        .converged);
        }
        calculix::Problem problem = described(mesh, material, held, {}, gravity);
        problem.steps = steps;
        problem.dt_s = dt_s;
        const double apart = difference(ours, calculix::solve(problem)).moved;
        MESSAGE(steps, " steps of ", dt_s, " s: displacements agree to ", apart);
        return apart;
    };
    const double coarse = moved(12), fine = moved(24);
    CHECK(fine < 5e-4);
    CHECK(std::abs(std::log2(coarse / fine) - 2.0) < 0.3);
}
