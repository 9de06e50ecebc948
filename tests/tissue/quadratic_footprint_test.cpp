// Footprint rows on quadratic shapes: what a row is, and that a block of ten-node tetrahedra under
// them answers as the tissue does, without a mesh term. The block and its truth: pressed_block.h.
#include "tests/tissue/block.h"
#include "tests/tissue/pressed_block.h"
#include "tissue/mesh/quadratic_mesh.h"
#include "tissue/response/footprint.h"
#include "tissue/response/linear_statics.h"
#include "tissue/response/mesh_term.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace {

using glm::dvec3;

constexpr int kNormal = 2, kTangent = 0;
constexpr double kTips_m[] = {1.5e-3, 2.5e-3, 5e-3};
constexpr double kMiddle_m = 40e-3;
const dvec3 kBlock_m{0.08, 0.08, 0.04};
const tissue::FootprintOptions kQuadratic{.order = 2, .tip_radius_max_m = 5e-3};

const block::PressedBlock& coarse() {
    static const block::PressedBlock pressed = block::quadratic_box(kBlock_m, {7, 7, 3});
    return pressed;
}

const block::PressedBlock& uneven() {
    static const block::PressedBlock pressed = block::quadratic_box(kBlock_m, {9, 9, 4}, 0.2);
    return pressed;
}

double relative_error(double value, double truth) {
    return std::abs(value - truth) / std::abs(truth);
}

// sum_i w_i f(x_i) of row v.
template <class Field>
double row_mean(const tissue::ContactSurface& skin, std::span<const dvec3> node_m, std::size_t v,
                const Field& field) {
    double sum = 0.0;
    for (std::uint32_t k = skin.row_start[v]; k < skin.row_start[v + 1]; ++k)
        sum += skin.row_weight[k] * field(node_m[skin.row_node[k]]);
    return sum;
}

} // namespace

TEST_CASE("quadratic footprint: a row is the kernel's mean of every quadratic field") {
    // moments of 2/(pi r^2) (1 - rho^2): <x> = x0, <x^2> = x0^2 + r^2/6, <x y> = x0 y0
    const auto mesh = tissue::box_mesh(kBlock_m, {7, 7, 3});
    const auto nodes = tissue::quadratic_mesh(mesh).rest_m;
    auto skin = block::top_skin(kBlock_m, 4e-3);
    tissue::make_footprints(mesh, block::bottom_anchored(mesh), kQuadratic, skin);
    int inner = 0;
    for (std::size_t v = 0; v < skin.rest_m.size(); ++v) {
        const dvec3 at = skin.rest_m[v];
        const double r = skin.footprint_radius_m[v];
        const auto mean = [&](const auto& field) { return row_mean(skin, nodes, v, field); };
        CHECK(std::abs(mean([](const dvec3&) { return 1.0; }) - 1.0) < 1e-12);
        if (std::min({at.x, at.y, kBlock_m.x - at.x, kBlock_m.y - at.y}) < r)
            continue; // cut at the edge
        ++inner;
        CHECK(std::abs(mean([](const dvec3& x) { return x.x; }) - at.x) < 1e-12);
        CHECK(std::abs(mean([](const dvec3& x) { return x.x * x.x; }) - at.x * at.x - r * r / 6) <
              1e-12);
        CHECK(std::abs(mean([](const dvec3& x) { return x.y * x.y; }) - at.y * at.y - r * r / 6) <
              1e-12);
        CHECK(std::abs(mean([](const dvec3& x) { return x.x * x.y; }) - at.x * at.y) < 1e-12);
    }
    CHECK(inner > 20);

    // negative control: linear shapes bend a parabola into facets
    tissue::make_footprints(mesh, {}, {.tip_radius_max_m = 5e-3}, skin);
    const std::size_t middle = skin.rest_m.size() / 2;
    const double x = skin.rest_m[middle].x, r = skin.footprint_radius_m[middle];
    CHECK(row_mean(skin, mesh.rest_m, middle, [](const dvec3& p) { return p.x * p.x; }) - x * x >
          1.1 * r * r / 6);
}

TEST_CASE("quadratic footprint: rows name nodes of the pressed face, frames its corners") {
    const auto mesh = tissue::box_mesh(kBlock_m, {7, 7, 3});
    const auto nodes = tissue::quadratic_mesh(mesh).rest_m;
    auto skin = block::top_skin(kBlock_m, 4e-3);
    tissue::make_footprints(mesh, block::bottom_anchored(mesh), kQuadratic, skin);
    std::size_t of_edges = 0;
    for (std::size_t v = 0; v < skin.rest_m.size(); ++v) {
        dvec3 carried{0.0};
        for (std::uint32_t k = skin.row_start[v]; k < skin.row_start[v + 1]; ++k) {
            REQUIRE(skin.row_node[k] < nodes.size());
            CHECK((k == skin.row_start[v] || skin.row_node[k] > skin.row_node[k - 1]));
            carried += skin.row_weight[k] * nodes[skin.row_node[k]];
            of_edges += skin.row_node[k] >= mesh.rest_m.size() ? 1 : 0;
            CHECK(std::abs(nodes[skin.row_node[k]].z - kBlock_m.z) < 1e-12);
        }
        CHECK(glm::distance(carried + skin.offset_m[v], skin.rest_m[v]) < 1e-12);
        for (const std::uint32_t node : skin.frame_node[v])
            CHECK(node < mesh.rest_m.size());
        CHECK(std::abs(skin.thickness_m[v] - kBlock_m.z) < 1e-9);
    }
    CHECK(of_edges > skin.row_node.size() / 2);
}

TEST_CASE("quadratic footprint: a rigid motion carries the skin exactly, on a curved body too") {
    tissue::TetMesh mesh = tissue::box_mesh(kBlock_m, {6, 5, 3});
    for (dvec3& x : mesh.rest_m)
        x.z += 8.0 * x.x * x.y; // a saddle
    auto skin = block::top_skin(kBlock_m, 4e-3);
    for (dvec3& x : skin.rest_m)
        x.z += 8.0 * x.x * x.y + 5e-4 * std::sin(300.0 * x.x); // not where the triangles are
    tissue::make_footprints(mesh, {}, kQuadratic, skin);

    const dvec3 axis = glm::normalize(dvec3{1, 2, 3}), shift{0.1, -0.2, 0.05};
    const auto moved = [&](const dvec3& p) { // Rodrigues, 2 rad
        return shift + std::cos(2.0) * p + std::sin(2.0) * glm::cross(axis, p) +
               (1.0 - std::cos(2.0)) * glm::dot(axis, p) * axis;
    };
    std::vector<dvec3> nodes = tissue::quadratic_mesh(mesh).rest_m;
    const auto frames = tissue::make_skin_frames(skin, nodes);
    std::transform(nodes.begin(), nodes.end(), nodes.begin(), moved);
    std::vector<dvec3> position(skin.rest_m.size()), normal(skin.rest_m.size());
    tissue::place_surface(skin, frames, nodes, position, normal);
    for (std::size_t v = 0; v < position.size(); ++v)
        CHECK(glm::distance(position[v], moved(skin.rest_m[v])) < 1e-12);
}

TEST_CASE("quadratic footprint: statics, rows and solver number the nodes alike") {
    const auto mesh = tissue::box_mesh({0.03, 0.02, 0.01}, {3, 2, 2}, 0.2);
    const auto nodes = tissue::quadratic_mesh(mesh).rest_m;
    const std::vector<std::uint8_t> none(mesh.rest_m.size(), 0);
    const auto statics = tissue::make_linear_statics(mesh, 2, 0.3, none);
    CHECK(statics.dof.size() == nodes.size());
    for (const auto& [low, high, node] : statics.mid)
        CHECK(nodes[node] == 0.5 * (mesh.rest_m[low] + mesh.rest_m[high]));
}

TEST_CASE("quadratic footprint: normal stiffness is the tissue's at every place, for every tip") {
    for (const auto* pressed : {&coarse(), &uneven()}) {
        for (const double a_m : kTips_m) {
            CAPTURE(a_m);
            const block::Spread s = block::spread(*pressed, kNormal, a_m);
            CHECK(std::abs(s.mean - 1.0) < 0.05); // of a kernel of 1.25 h some 5 % are missed
            CHECK(s.deviation < 0.02);
            CHECK(s.low > 0.93);
            CHECK(s.high < 1.07);
        }
    }
}

TEST_CASE("quadratic footprint: at the centre a flat tip meets 23.3, 39.8 and 84.5 N/m") {
    const double truth_npm[] = {23.3, 39.8, 84.5}; // 27-node hexahedra
    for (const auto* pressed : {&coarse(), &uneven()}) {
        for (int i = 0; i < 3; ++i) {
            const double k = pressed->stiffness_npm(kMiddle_m, kMiddle_m, kNormal, kTips_m[i]);
            CHECK(relative_error(k, truth_npm[i]) < 0.05);
        }
    }
}

TEST_CASE("quadratic footprint: tangential stiffness is the tissue's, a slide feels no mesh") {
    for (const auto* pressed : {&coarse(), &uneven()}) {
        for (const double a_m : kTips_m) {
            CAPTURE(a_m);
            CHECK(std::abs(block::spread(*pressed, kTangent, a_m).mean - 1.0) < 0.08);
            CHECK(block::worst_slide_step(*pressed, kNormal, a_m) < 2e-3);
            CHECK(block::worst_slide_step(*pressed, kTangent, a_m) < 2e-3);
            const auto law =
                tissue::make_sphere_law(a_m, block::kYoung_pa, block::kPoisson, 10, 257);
            CHECK(block::worst_force_step_n(*pressed, 4e-3, law, a_m) < 1e-3);
        }
    }
}

TEST_CASE("quadratic footprint: the force of a sphere follows its depth") {
    // series law on the hexahedra above; held by an axisymmetric contact solution to 1 %
    const double depth_mm[] = {.5, 1, 2, 3, 4, 6, 8};
    const double force_mn[3][7] = {{4.3, 11.7, 31.0, 52.9, 75.8, 122.3, 168.9},
                                   {5.6, 15.7, 43.0, 76.0, 112.2, 189.0, 267.8},
                                   {8.1, 23.0, 64.9, 118.1, 179.5, 319.2, 473.0}};
    for (int i = 0; i < 3; ++i) {
        const auto law =
            tissue::make_sphere_law(kTips_m[i], block::kYoung_pa, block::kPoisson, 10, 257);
        for (int k = 0; k < 7; ++k) {
            CAPTURE(depth_mm[k]);
            const double force =
                1e3 * coarse().force_n(kMiddle_m, kMiddle_m, 1e-3 * depth_mm[k], law, kTips_m[i]);
            CHECK(relative_error(force, force_mn[i][k]) < 0.03);
        }
    }
}

TEST_CASE("quadratic footprint: a bonded layer one tet thick stiffens as Hayes says") {
    // P = 4 G a w kappa / (1-nu), nu 0.45
    const double shear_pa = block::kYoung_pa / (2.0 * (1.0 + block::kPoisson));
    for (const auto& [thickness_m, ratio, kappa] :
         {std::array{20e-3, .2, 1.252}, std::array{10e-3, .4, 1.599}, std::array{5e-3, .6, 2.033},
          std::array{5e-3, 1., 3.091}}) {
        CAPTURE(ratio);
        const auto pressed = block::quadratic_box({.08, .08, thickness_m}, {10, 10, 1});
        const double a_m = ratio * thickness_m;
        const double truth = 4.0 * shear_pa * a_m * kappa / (1.0 - block::kPoisson);
        CHECK(relative_error(pressed.stiffness_npm(.041, .043, kNormal, a_m), truth) < 0.07);
    }
}

TEST_CASE("quadratic footprint: near a free edge the tissue gives way") {
    // hexahedra of 2 mm, kernel of 1.3175 a cut at the edge, a = 2.5 mm. At 5 mm, less than half a
    // tet from a right angle, tets of 10 mm do not show all of it: W is 12 % too low there.
    const auto pressed = block::quadratic_box(kBlock_m, {10, 10, 5}, 0.0, false, 2.5e-3);
    struct Fact {
        double from_edge_m, compliance_mpn, tolerance;
    };
    for (const auto& [s_m, w, tolerance] :
         {Fact{5e-3, 34.8e-3, 0.15}, Fact{9e-3, 29.5e-3, 0.10}, Fact{20e-3, 26.5e-3, 0.07}}) {
        CAPTURE(s_m);
        CHECK(relative_error(pressed.compliance_mpn(s_m, kMiddle_m, kNormal, 2.5e-3), w) <
              tolerance);
    }
}

TEST_CASE("quadratic footprint: what is left out is missed") {
    const double a_m = 2.5e-3;
    // bare points: far too stiff, and another stiffness at every place
    const auto points = block::quadratic_box(kBlock_m, {7, 7, 3}, 0.0, true);
    const block::Spread bare = block::spread(points, kNormal, a_m, {.subgrid = false});
    CHECK(bare.mean > 1.2);
    CHECK(bare.deviation > 0.05);
    // a footprint without the sub-grid term: far too stiff
    CHECK(block::spread(coarse(), kNormal, a_m, {.subgrid = false}).mean > 3.0);
    // a half-space's sub-grid term on a layer
    const auto layer = block::quadratic_box({.08, .08, .005}, {10, 10, 1});
    CHECK(layer.stiffness_npm(.041, .043, kNormal, 3e-3, {.layer = false}) <
          0.85 * layer.stiffness_npm(.041, .043, kNormal, 3e-3));
}

TEST_CASE("quadratic footprint: quadratic shapes owe no mesh term") {
    const auto mesh = tissue::box_mesh(kBlock_m, {4, 4, 2});
    const auto anchored = block::bottom_anchored(mesh);
    auto skin = block::top_skin(kBlock_m, 20e-3);
    tissue::make_footprints(mesh, anchored, kQuadratic, skin);
    CHECK_THROWS_WITH(tissue::make_mesh_terms(mesh, 0.45, anchored, kQuadratic, skin),
                      doctest::Contains("order = 2"));
    CHECK(skin.mesh_term_n_m == std::vector<double>(skin.rest_m.size(), 0.0));
    CHECK(skin.mesh_term_t_m == std::vector<double>(skin.rest_m.size(), 0.0));
}

TEST_CASE("quadratic footprint: graded tetrahedra get the wider kernel, even ones the narrow one") {
    const auto radius_over_size = [](const tissue::TetMesh& mesh, const dvec3& place_m) {
        auto skin = block::grid_skin(place_m - dvec3{1e-3, 1e-3, 0}, 2e-3, 2e-3, 2, 2);
        tissue::make_footprints(mesh, {}, {.order = 2, .tip_radius_max_m = 1e-4}, skin);
        std::size_t below = 0;
        for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
            if (glm::distance(mesh.rest_m[i], place_m) < glm::distance(mesh.rest_m[below], place_m))
                below = i;
        }
        REQUIRE(glm::distance(mesh.rest_m[below], place_m) < 1e-12);
        return skin.footprint_radius_m[4] / tissue::nodal_size_m(mesh)[below];
    };
    tissue::TetMesh even = tissue::box_mesh({0.12, 0.12, 0.06}, {12, 12, 6});
    CHECK(std::abs(radius_over_size(even, {0.06, 0.06, 0.06}) - 1.25) < 1e-9);
    // the same grid drawn together around the place: from 2.5 mm to 20 mm
    tissue::TetMesh graded = even;
    for (dvec3& x : graded.rest_m) {
        const auto drawn = [](double s) { return s * std::abs(s); };
        x.x = 0.06 + 0.06 * drawn((x.x - 0.06) / 0.06);
        x.y = 0.06 + 0.06 * drawn((x.y - 0.06) / 0.06);
        x.z = 0.06 * (1.0 + drawn(x.z / 0.06 - 1.0));
    }
    CHECK(std::abs(radius_over_size(graded, {0.06, 0.06, 0.06}) - 1.5) < 1e-9);
}

TEST_CASE("quadratic footprint: an order that there is not is refused") {
    const auto mesh = tissue::box_mesh(kBlock_m, {2, 2, 2});
    auto skin = block::top_skin(kBlock_m, 20e-3);
    CHECK_THROWS_WITH(tissue::make_footprints(mesh, {}, {.order = 3}, skin),
                      doctest::Contains("order = 3: must be 1 or 2"));
    CHECK_THROWS_WITH(tissue::make_footprints(mesh, {}, {.order = 2, .even_factor = 0.0}, skin),
                      doctest::Contains("even_factor = 0"));
}
