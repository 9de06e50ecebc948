// tests/tissue/footprint_test.cpp
// Footprint rows: what a kernel is, where it ends, and what lies below it.
#include "tissue/response/footprint.h"

#include "tests/tissue/block.h"
#include "tissue/response/footprint_kernel.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>

namespace {

using glm::dvec3;

const dvec3 kBlock_m{0.08, 0.08, 0.04};

// A cube's mesh blown up to a ball: every point goes out along its ray.
tissue::TetMesh ball_mesh(double radius_m, int cells) {
    tissue::TetMesh mesh = tissue::box_mesh(dvec3{2.0}, {cells, cells, cells});
    for (dvec3& x : mesh.rest_m) {
        const dvec3 p = x - dvec3{1.0};
        const double cube = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        x = glm::length(p) > 0.0 ? radius_m * cube * glm::normalize(p) : dvec3{0.0};
    }
    return mesh;
}

tissue::ContactSurface ball_skin(double radius_m, int cells) {
    const tissue::TetMesh fine = ball_mesh(radius_m, cells);
    tissue::ContactSurface skin;
    skin.triangles = tissue::boundary_triangles(fine);
    std::vector<std::int64_t> index(fine.rest_m.size(), -1);
    for (tissue::Triangle& triangle : skin.triangles) {
        for (std::uint32_t& node : triangle) {
            if (index[node] < 0) {
                index[node] = static_cast<std::int64_t>(skin.rest_m.size());
                skin.rest_m.push_back(fine.rest_m[node]);
            }
            node = static_cast<std::uint32_t>(index[node]);
        }
    }
    return skin;
}

void check_rows(const tissue::TetMesh& mesh, const tissue::ContactSurface& skin) {
    const std::size_t n = skin.rest_m.size();
    REQUIRE(skin.row_start.size() == n + 1);
    REQUIRE(skin.offset_m.size() == n);
    REQUIRE(skin.frame_node.size() == n);
    for (std::size_t v = 0; v < n; ++v) {
        double sum = 0.0;
        dvec3 carried{0.0};
        REQUIRE(skin.row_start[v + 1] > skin.row_start[v]);
        for (std::uint32_t k = skin.row_start[v]; k < skin.row_start[v + 1]; ++k) {
            if (k > skin.row_start[v])
                CHECK(skin.row_node[k] > skin.row_node[k - 1]);
            CHECK(skin.row_weight[k] > 0.0);
            sum += skin.row_weight[k];
            carried += skin.row_weight[k] * mesh.rest_m[skin.row_node[k]];
        }
        CHECK(std::abs(sum - 1.0) < 1e-12);
        CHECK(glm::distance(carried + skin.offset_m[v], skin.rest_m[v]) < 1e-12);
        CHECK(skin.thickness_m[v] > 0.0);
        CHECK(skin.mesh_term_n_m[v] == 0.0);
    }
}

std::size_t vertex_at(const tissue::ContactSurface& skin, const dvec3& place) {
    std::size_t best = 0;
    for (std::size_t v = 0; v < skin.rest_m.size(); ++v) {
        if (glm::distance(skin.rest_m[v], place) < glm::distance(skin.rest_m[best], place))
            best = v;
    }
    return best;
}

} // namespace

TEST_CASE("footprint: the samples integrate the kernel 2/(pi r^2) (1 - rho^2)") {
    // moments over the disc: <x> = 0, <x^2> = r^2/6, <x^4> = r^4/16 , <x^2 y^2> = r^4/48
    const auto tree = tissue::make_boundary_tree(tissue::box_mesh(kBlock_m, {7, 7, 3}));
    const dvec3 centre{0.041, 0.037, 0.04};
    const double r = 0.018;
    double mass = 0.0, x1 = 0.0, x2 = 0.0, x4 = 0.0, x2y2 = 0.0;
    const auto samples = tissue::kernel_samples(tree, centre, {0, 0, 1}, r, r);
    CHECK(samples.size() == 90);
    for (const auto& [at, share] : samples) {
        const dvec3 p = (tissue::position_m(tree, at) - centre) / r;
        CHECK(std::abs(p.z) < 1e-12);
        mass += share;
        x1 += share * p.x;
        x2 += share * p.x * p.x;
        x4 += share * std::pow(p.x, 4.0);
        x2y2 += share * p.x * p.x * p.y * p.y;
    }
    CHECK(std::abs(mass - 1.0) < 1e-12);
    CHECK(std::abs(x1) < 1e-12);
    CHECK(std::abs(x2 - 1.0 / 6.0) < 1e-12);
    CHECK(std::abs(x4 - 1.0 / 16.0) < 1e-12);
    CHECK(std::abs(x2y2 - 1.0 / 48.0) < 1e-12);
}

TEST_CASE("footprint: rows sum to one and stay on the pressed face") {
    const auto mesh = tissue::box_mesh(kBlock_m, {7, 7, 3});
    auto skin = block::top_skin(kBlock_m, 4e-3);
    tissue::make_footprints(mesh, block::bottom_anchored(mesh), {}, skin);
    check_rows(mesh, skin);
    CHECK(skin.neighbours.size() == skin.triangles.size());
    for (const std::uint32_t node : skin.row_node)
        CHECK(std::abs(mesh.rest_m[node].z - kBlock_m.z) < 1e-12);
    // away from the edges a linear field is reproduced: the row stands at its vertex
    const std::size_t middle = vertex_at(skin, {0.04, 0.04, 0.04});
    CHECK(glm::length(skin.offset_m[middle]) < 1e-12);
}

TEST_CASE("footprint: the kernel shrinks towards a free edge, to the tip's or half a tet's") {
    const auto mesh = tissue::box_mesh(kBlock_m, {7, 7, 3});
    auto skin = block::top_skin(kBlock_m, 2e-3);
    const tissue::FootprintOptions options;
    tissue::make_footprints(mesh, block::bottom_anchored(mesh), options, skin);
    const double size_m = tissue::nodal_size_m(mesh)[vertex_at(skin, {})];
    const double least = std::max(1.3175 * options.tip_radius_max_m, 0.5 * size_m);
    const double most = options.size_factor * size_m;
    for (const double s : {0.0, 2e-3, 6e-3, 10e-3, 16e-3, 40e-3}) {
        const std::size_t v = vertex_at(skin, {s, 0.04, 0.04});
        const double expected = std::max(least, std::min(most, s));
        CHECK(std::abs(skin.footprint_radius_m[v] / expected - 1.0) < 0.02);
    }
}

TEST_CASE("footprint: a concave corner is not an edge") {
    // an L: the step's upper half removed, tool on the lower tread next to the riser
    tissue::TetMesh mesh = tissue::box_mesh({0.08, 0.08, 0.08}, {8, 8, 8});
    std::erase_if(mesh.tets, [&](const tissue::Tet& t) {
        dvec3 centre{0.0};
        for (const std::uint32_t node : t)
            centre += mesh.rest_m[node] / 4.0;
        return centre.x < 0.04 && centre.z > 0.04;
    });
    const auto tree = tissue::make_boundary_tree(mesh);
    const double r = tissue::kernel_radius_m(tree, {0.03, 0.04, 0.04}, {0, 0, 1}, 0.012, {});
    CHECK(std::abs(r - 0.018) < 1e-9);
    // on the upper tread at the same distance from the step it is one
    const double edge = tissue::kernel_radius_m(tree, {0.05, 0.04, 0.08}, {0, 0, 1}, 0.012, {});
    CHECK(std::abs(edge - 0.010) < 2e-4);
}

TEST_CASE("footprint: thickness is the way to what is anchored") {
    for (const double thickness_m : {20e-3, 10e-3, 5e-3}) {
        const auto mesh = tissue::box_mesh({0.08, 0.08, thickness_m}, {10, 10, 2});
        auto skin = block::top_skin({0.08, 0.08, thickness_m}, 4e-3);
        tissue::make_footprints(mesh, block::bottom_anchored(mesh), {}, skin);
        for (const double t : skin.thickness_m)
            CHECK(std::abs(t - thickness_m) < 1e-9);
        tissue::make_footprints(mesh, {}, {}, skin);
        for (const double t : skin.thickness_m)
            CHECK(t == tissue::kUnbacked_m);
    }
}

TEST_CASE("footprint: on a coarse ball every row stays near its vertex") {
    // tets of 12 mm under a skin of 4 mm: the kernel sinks r^2/(6 R) at most, the coarse body
    // lies h^2/(8 R) per direction below the skin
    const double radius_m = 0.04;
    const auto mesh = ball_mesh(radius_m, 6);
    auto skin = ball_skin(radius_m, 18);
    tissue::make_footprints(mesh, {}, {}, skin);
    check_rows(mesh, skin);
    for (std::size_t v = 0; v < skin.rest_m.size(); ++v) {
        const double r = skin.footprint_radius_m[v];
        const double sink = r * r / (6.0 * radius_m) + 0.018 * 0.018 / (4.0 * radius_m);
        CHECK(glm::dot(skin.offset_m[v], skin.rest_m[v]) / radius_m < sink);
        CHECK(glm::length(skin.offset_m[v]) < sink + 0.1 * r);
        CHECK(skin.row_start[v + 1] - skin.row_start[v] >= 3);
    }
}

TEST_CASE("footprint: at a thin margin samples do not fall on the far side") {
    // a plate 4 mm thick, its skin on top: kernel wider than the plate is thick
    const dvec3 size{0.06, 0.06, 0.004};
    const auto mesh = tissue::box_mesh(size, {5, 5, 1});
    auto skin = block::top_skin(size, 3e-3);
    tissue::make_footprints(mesh, {}, {}, skin);
    check_rows(mesh, skin);
    for (const std::uint32_t node : skin.row_node)
        CHECK(std::abs(mesh.rest_m[node].z - size.z) < 1e-12);
    // even for a skin that has sunk below the middle of a body that is too coarse
    const auto tree = tissue::make_boundary_tree(mesh);
    for (const auto& sample :
         tissue::kernel_samples(tree, {0.03, 0.03, 0.001}, {0, 0, 1}, 0.01, 0.01))
        CHECK(std::abs(tissue::position_m(tree, sample.at).z - size.z) < 1e-12);
}

TEST_CASE("footprint: nodal size is the mean edge and grows by at most 0.3 of the distance") {
    // Kuhn's cube: three edges 1, two sqrt 2, one sqrt 3 in each tet
    const auto cube = tissue::box_mesh(dvec3{0.04}, {4, 4, 4});
    for (const double h : tissue::nodal_size_m(cube))
        CHECK(std::abs(h / (0.01 * (3.0 + 2.0 * std::sqrt(2.0) + std::sqrt(3.0)) / 6.0) - 1.0) <
              1e-12);

    tissue::TetMesh graded = tissue::box_mesh(dvec3{0.04}, {8, 8, 8});
    for (dvec3& x : graded.rest_m)
        x *= std::pow(glm::max(x.x, glm::max(x.y, x.z)) / 0.04, 2.0); // a factor 100 in size
    const auto size = tissue::nodal_size_m(graded);
    int too_steep = 0;
    for (std::size_t i = 0; i < size.size(); ++i) {
        for (std::size_t j = 0; j < size.size(); ++j) {
            const double gap_m = glm::distance(graded.rest_m[i], graded.rest_m[j]);
            too_steep += size[i] < size[j] - 0.3 * gap_m - 1e-15;
        }
    }
    CHECK(too_steep == 0);
}

TEST_CASE("footprint: the negative control puts a vertex on one triangle") {
    const auto mesh = tissue::box_mesh(kBlock_m, {7, 7, 3});
    auto skin = block::top_skin(kBlock_m, 4e-3);
    tissue::make_footprints(mesh, {}, {.point_rows = true}, skin);
    check_rows(mesh, skin);
    for (std::size_t v = 0; v < skin.rest_m.size(); ++v) {
        CHECK(skin.row_start[v + 1] - skin.row_start[v] <= 3);
        CHECK(glm::length(skin.offset_m[v]) < 1e-12);
    }
}

TEST_CASE("footprint: bad input is refused by name") {
    const auto mesh = tissue::box_mesh(kBlock_m, {2, 2, 2});
    auto skin = block::top_skin(kBlock_m, 20e-3);
    const std::vector<std::uint8_t> short_flags(3, 1);
    CHECK_THROWS_WITH(tissue::make_footprints(mesh, short_flags, {}, skin),
                      doctest::Contains("3 anchor flags for 27 nodes"));
    CHECK_THROWS_WITH(tissue::make_footprints(mesh, {}, {.size_factor = 0.0}, skin),
                      doctest::Contains("size_factor = 0"));
    skin.rest_m.push_back({});
    CHECK_THROWS_WITH(tissue::make_footprints(mesh, {}, {}, skin),
                      doctest::Contains("skin vertex 25 has no area"));
    skin.triangles[1][2] = 99;
    CHECK_THROWS_WITH(tissue::make_footprints(mesh, {}, {}, skin),
                      doctest::Contains("skin triangle 1 names vertex 99"));
}
