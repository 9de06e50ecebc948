// tests/tissue/elastic_bed_test.cpp
// The bed that holds an organ: its integral, its closed form, and that two meshes are held alike.
#include "tests/tissue/block.h"
#include "tests/tissue/bodies.h"
#include "tissue/response/linear_statics.h"
#include "tissue/response/mesh_term.h"
#include "tissue/response/subgrid.h"

#include <doctest/doctest.h>
#include <limits>
#include <numbers>

namespace {

using glm::dvec3;

double total_m(std::span<const tissue::BedSample> bed) {
    double sum = 0.0;
    for (const auto& sample : bed)
        sum += sample.stiffness_m;
    return sum;
}

const auto kEverywhere = [](const dvec3&) { return true; };

} // namespace

TEST_CASE("bed: over a whole body it sums to volume / L^2, whatever the mesh") {
    for (const auto& cells : {std::array{1, 1, 1}, std::array{5, 4, 3}}) {
        const auto bed =
            tissue::make_bed(tissue::box_mesh({0.05, 0.04, 0.03}, cells, 0.2), kEverywhere, 0.02);
        CHECK(total_m(bed) == doctest::Approx(0.05 * 0.04 * 0.03 / 4e-4).scale(0.0).epsilon(1e-12));
    }
}

TEST_CASE("bed: a ball inside holds with the ball's volume on coarse and on fine tets") {
    const dvec3 centre{0.041, 0.038, 0.033};
    const double radius = 0.02, length = 0.01;
    const auto ball = [&](const dvec3& x) { return glm::distance(x, centre) < radius; };
    const double truth = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius / length / length;
    for (const auto& [cells, slack] :
         {std::pair{std::array{5, 5, 4}, 0.03}, std::pair{std::array{10, 10, 9}, 0.01}}) {
        const auto mesh = tissue::box_mesh({0.08, 0.08, 0.07}, cells);
        CHECK(total_m(tissue::make_bed(mesh, ball, length)) ==
              doctest::Approx(truth).scale(0.0).epsilon(slack));
        // nodes in the ball, each with its share of the volume, would not do
        double nodes = 0.0;
        const auto model = tissue::make_corotated(mesh, bodies::elastic(8e3, 0.4, 1.0), {});
        for (std::size_t i = 0; i < mesh.rest_m.size(); ++i)
            nodes += ball(mesh.rest_m[i]) ? model.mass_kg[i] / length / length : 0.0;
        CHECK(std::abs(nodes / truth - 1.0) >
              std::abs(total_m(tissue::make_bed(mesh, ball, length)) / truth - 1.0));
    }
}

TEST_CASE("bed: a bar lying in it gives way at its end as coth says") {
    // E A u'' = (E/L^2) A u, E A u'(l) = P, u'(0) = 0:  u(l) = P L / (E A) coth(l / L)
    const double young_pa = 8e3, load_n = 1e-2, length = 0.02, bar_m = 0.06, area_m2 = 4e-4;
    const auto mesh = tissue::box_mesh({bar_m, 0.02, 0.02}, {24, 2, 2});
    const auto model = tissue::make_corotated(mesh, bodies::elastic(young_pa, 0.0), {}, dvec3{0.0},
                                              tissue::make_bed(mesh, kEverywhere, length));
    std::vector<double> load(static_cast<std::size_t>(model.unknowns), 0.0);
    double end_m = 0.0, weight = 0.0;
    for (const tissue::Triangle& t : tissue::boundary_triangles(mesh)) {
        const bool end = std::all_of(t.begin(), t.end(),
                                     [&](auto i) { return mesh.rest_m[i].x > bar_m - 1e-9; });
        const double share = glm::length(glm::cross(mesh.rest_m[t[1]] - mesh.rest_m[t[0]],
                                                    mesh.rest_m[t[2]] - mesh.rest_m[t[0]])) /
                             6.0 / area_m2;
        for (const auto node : t)
            load[model.dof[node]] += end ? share * load_n : 0.0;
    }
    auto state = tissue::rest_state(model);
    CHECK(tissue::solve_static(model, load, 1e-10, 20, state).converged);
    for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
        end_m += load[model.dof[i]] * (state.position_m[i].x - mesh.rest_m[i].x);
        weight += load[model.dof[i]];
    }
    const double truth = load_n * length / (young_pa * area_m2) / std::tanh(bar_m / length);
    CHECK(end_m / weight == doctest::Approx(truth).scale(0.0).epsilon(0.005));
}

TEST_CASE("bed: its force is the slope of its energy, and the tangent that of its force") {
    const auto mesh = tissue::box_mesh({0.04, 0.03, 0.03}, {3, 2, 2}, 0.1);
    const auto bed = tissue::make_bed(
        mesh, [](auto x) { return x.x + x.y < 0.031; }, 0.004);
    const auto model = tissue::make_corotated(mesh, bodies::elastic(8e3, 0.4), {}, dvec3{0.0}, bed);
    const auto state =
        bodies::moved(model, tissue::rest_state(model), bodies::random_unknowns(model, 5), 5e-4);
    const auto d = bodies::random_unknowns(model, 9);
    const double h = 1e-7;
    const auto up = bodies::moved(model, state, d, h), down = bodies::moved(model, state, d, -h);
    auto system = tissue::make_system(model);
    tissue::linearize(model, state, bodies::kStatics, system);
    double slope_n = 0.0;
    for (std::size_t i = 0; i < d.size(); ++i)
        slope_n += system.internal_n[i] * d[i];
    CHECK((tissue::elastic_energy_j(model, up) - tissue::elastic_energy_j(model, down)) / (2 * h) ==
          doctest::Approx(slope_n).scale(0.0).epsilon(1e-6));
    std::vector<double> product(d.size());
    tissue::multiply(model.pattern, system.stiffness, d, product);
    tissue::linearize(model, up, bodies::kStatics, system);
    std::vector<double> difference = system.internal_n;
    tissue::linearize(model, down, bodies::kStatics, system);
    for (std::size_t i = 0; i < d.size(); ++i)
        difference[i] = (difference[i] - system.internal_n[i]) / (2 * h) - product[i];
    CHECK(bodies::norm(difference) < 1e-5 * bodies::norm(product));
}

TEST_CASE("bed: it holds linear and quadratic tets with the same energy for a linear field") {
    const auto mesh = tissue::box_mesh({0.03, 0.02, 0.04}, {2, 2, 2}, 0.2);
    const auto bed = tissue::make_bed(
        mesh, [](auto x) { return x.z < 0.015; }, 0.01);
    const std::vector<std::uint8_t> loose(mesh.rest_m.size(), 0);
    double energy[2];
    for (const int order : {1, 2}) {
        const auto bare = tissue::make_linear_statics(mesh, order, 0.4, loose);
        const auto held = tissue::make_linear_statics(mesh, order, 0.4, loose, bed);
        std::vector<dvec3> place = mesh.rest_m;
        for (const auto& [low, high, node] : held.mid)
            place.push_back(0.5 * (mesh.rest_m[low] + mesh.rest_m[high]));
        std::vector<double> u(held.unknowns), f(held.unknowns), g(held.unknowns);
        for (std::size_t i = 0; i < place.size(); ++i) {
            const dvec3 move = dvec3{1.0, -2.0, 0.5} + 30.0 * dvec3{place[i].y, place[i].z, 0.0};
            for (int axis = 0; axis < 3; ++axis)
                u[held.dof[i] + axis] = move[axis];
        }
        tissue::multiply(held.pattern, held.stiffness_m, u, f);
        tissue::multiply(bare.pattern, bare.stiffness_m, u, g);
        energy[order - 1] = 0.0;
        for (std::size_t i = 0; i < u.size(); ++i)
            energy[order - 1] += u[i] * (f[i] - g[i]);
    }
    CHECK(energy[0] > 0.0);
    CHECK(energy[1] == doctest::Approx(energy[0]).scale(0.0).epsilon(1e-9));
}

TEST_CASE("bed: a weak one gives a loose body the mesh terms of a held one, to 1 % of a tip") {
    const dvec3 size{0.08, 0.08, 0.04};
    const auto mesh = tissue::box_mesh(size, {6, 6, 3});
    const auto anchored = block::bottom_anchored(mesh);
    const std::vector<std::uint8_t> loose(mesh.rest_m.size(), 0);
    auto held = block::grid_skin({.03, .03, .04}, .02, .02, 3, 3);
    tissue::make_footprints(mesh, {}, {}, held);
    auto free = held;
    tissue::make_mesh_terms(mesh, 0.45, anchored, {}, held);
    tissue::make_mesh_terms(mesh, 0.45, loose, {}, free, tissue::weak_bed(mesh));
    for (std::size_t v = 0; v < held.rest_m.size(); ++v) {
        const double punch = tissue::punch_compliance_mpn(1.0, 0.45, 3e-3, tissue::kUnbacked_m);
        CHECK(std::abs(free.mesh_term_n_m[v] - held.mesh_term_n_m[v]) < 0.012 * punch);
        CHECK(std::abs(free.mesh_term_t_m[v] - held.mesh_term_t_m[v]) <
              0.012 * tissue::tangential_ratio(0.45) * punch);
    }
}

TEST_CASE("bed: a length that is not positive is refused, and a tet that the mesh lacks") {
    const auto mesh = tissue::box_mesh(dvec3{0.01}, {1, 1, 1});
    CHECK_THROWS_WITH(tissue::make_bed(mesh, kEverywhere, 0.0), doctest::Contains("length_m"));
    CHECK_THROWS_WITH(
        tissue::make_corotated(mesh, bodies::elastic(8e3, 0.4), {}, dvec3{0.0},
                               std::vector<tissue::BedSample>{{6, {1, 0, 0, 0}, 1.0}}),
        doctest::Contains("tet 6 of 6"));
}
