// tests/tissue/mesh_term_test.cpp
// The mesh term: sign, what it recovers, and what it refuses.
#include "tissue/response/mesh_term.h"

#include "tests/tissue/block.h"
#include "tissue/response/footprint_kernel.h"
#include "tissue/response/linear_statics.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

namespace {

using glm::dvec3;

constexpr double kPoisson = 0.45;

double energy(const tissue::LinearStatics& statics, std::span<const double> load) {
    std::vector<double> u(load.begin(), load.end());
    tissue::SparseFactor factor(statics.pattern);
    REQUIRE(factor.factor(statics.stiffness_m));
    factor.solve(u, 1);
    double sum = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i)
        sum += load[i] * u[i];
    return sum;
}

// E W of a row of the surface on linear tets, along `axis`.
double row_compliance(const tissue::TetMesh& mesh, std::span<const std::uint8_t> anchored,
                      const tissue::ContactSurface& skin, std::size_t v, int axis) {
    const auto statics = tissue::make_linear_statics(mesh, 1, kPoisson, anchored);
    std::vector<double> load(statics.unknowns, 0.0);
    for (std::uint32_t k = skin.row_start[v]; k < skin.row_start[v + 1]; ++k)
        load[statics.dof[skin.row_node[k]] + axis] += skin.row_weight[k];
    return energy(statics, load);
}

// The same of a kernel on quadratic tets of a mesh, sampled so finely that the mesh cannot tell.
double kernel_compliance(const tissue::TetMesh& mesh, std::span<const std::uint8_t> anchored,
                         const dvec3& at_m, double radius_m, int axis) {
    const auto statics = tissue::make_linear_statics(mesh, 2, kPoisson, anchored);
    const auto tree = tissue::make_boundary_tree(mesh);
    std::vector<double> load(statics.unknowns, 0.0);
    for (const auto& [at, share] :
         tissue::kernel_samples(tree, at_m, {0, 0, 1}, radius_m, 0.01, 14)) {
        const auto shape = tissue::surface_shape(statics, tree.triangle[at.triangle], at.weight);
        for (int k = 0; k < shape.count; ++k)
            load[statics.dof[shape.node[k]] + axis] += share * shape.value[k];
    }
    return energy(statics, load);
}

} // namespace

TEST_CASE("mesh term: it is never negative, on structured, jittered and thin bodies") {
    for (const auto& [size, cells, jitter] :
         {std::tuple{dvec3{.08, .08, .04}, std::array{5, 5, 3}, 0.0},
          std::tuple{dvec3{.08, .08, .04}, std::array{6, 4, 3}, 0.25},
          std::tuple{dvec3{.08, .06, .005}, std::array{8, 6, 1}, 0.0}}) {
        const auto mesh = tissue::box_mesh(size, cells, jitter);
        const auto anchored = block::bottom_anchored(mesh);
        auto skin = block::top_skin(size, 5e-3);
        tissue::make_footprints(mesh, anchored, {}, skin);
        tissue::make_mesh_terms(mesh, kPoisson, anchored, {}, skin);
        CHECK(*std::min_element(skin.mesh_term_n_m.begin(), skin.mesh_term_n_m.end()) > 0.0);
        CHECK(*std::min_element(skin.mesh_term_t_m.begin(), skin.mesh_term_t_m.end()) > 0.0);
    }
}

TEST_CASE("mesh term: with it coarse linear tets yield as fine quadratic ones under the kernel") {
    const dvec3 size{0.08, 0.08, 0.04}, at_m{0.043, 0.037, 0.04};
    const tissue::FootprintOptions options{.size_factor = 1.2};
    const auto mesh = tissue::box_mesh(size, {6, 6, 3});
    const auto anchored = block::bottom_anchored(mesh);
    auto skin = block::grid_skin(at_m - dvec3{1e-3, 1e-3, 0}, 2e-3, 2e-3, 2, 2); // 4: its middle
    tissue::make_footprints(mesh, anchored, options, skin);
    tissue::make_mesh_terms(mesh, kPoisson, anchored, options, skin);

    const auto fine = tissue::box_mesh(size, {10, 10, 5});
    for (const int axis : {0, 2}) {
        CAPTURE(axis);
        const double truth = kernel_compliance(fine, block::bottom_anchored(fine), at_m,
                                               skin.footprint_radius_m[4], axis);
        const double bare = row_compliance(mesh, anchored, skin, 4, axis);
        const double term = axis == 2 ? skin.mesh_term_n_m[4] : skin.mesh_term_t_m[4];
        CHECK(std::abs((bare + term) / truth - 1.0) < 0.04); // quadratic at 1.2 h: 2 to 3 % of W
        CHECK(bare / truth < 0.85);                          // what the term has to make up for
    }
}

// A beam that is held at one end and loaded near its other, on top: upwards and to the side it
// bends, along itself it does not, and what it owes leans between top and end face.
TEST_CASE("mesh term: in every direction, along the skin and aslant, it makes up for the mesh") {
    const dvec3 size{.08, .016, .012};
    const auto mesh = tissue::box_mesh(size, {10, 2, 2});
    std::vector<std::uint8_t> anchored(mesh.rest_m.size());
    for (std::size_t i = 0; i < anchored.size(); ++i)
        anchored[i] = mesh.rest_m[i].x < 1e-9 ? 1 : 0;
    auto skin = block::top_skin(size, 4e-3);
    tissue::make_footprints(mesh, anchored, {}, skin);
    tissue::make_mesh_terms(mesh, kPoisson, anchored, {}, skin);
    const std::size_t v = static_cast<std::size_t>(
        std::ranges::max_element(skin.rest_m, {},
                                 [](const dvec3& x) { return x.x - std::abs(x.y - .008); }) -
        skin.rest_m.begin());
    const dvec3 n = tissue::vertex_normals(skin.rest_m, skin.triangles)[v];
    const auto term = [&](const dvec3& d, bool leans) {
        const auto& s = skin.mesh_lean_m[v];
        const double normal = glm::dot(d, n) * glm::dot(d, n);
        const double plain =
            skin.mesh_term_n_m[v] * normal + skin.mesh_term_t_m[v] * (1.0 - normal);
        return plain + (leans ? s[0] * d.x * d.x + s[1] * d.y * d.y + s[2] * d.z * d.z +
                                    2.0 * (s[3] * d.y * d.z + s[4] * d.x * d.z + s[5] * d.x * d.y)
                              : 0.0);
    };
    const auto kernel = [&](int order, const dvec3& d) {
        const auto statics = tissue::make_linear_statics(mesh, order, kPoisson, anchored);
        const auto tree = tissue::make_boundary_tree(mesh);
        std::vector<double> load(statics.unknowns, 0.0);
        for (const auto& [at, share] : tissue::kernel_samples(
                 tree, skin.rest_m[v], n, skin.footprint_radius_m[v], 0.01, 14)) {
            const auto shape =
                tissue::surface_shape(statics, tree.triangle[at.triangle], at.weight);
            for (int k = 0; k < shape.count; ++k)
                for (int axis = 0; axis < 3; ++axis)
                    if (const std::int32_t dof = statics.dof[shape.node[k]]; dof >= 0)
                        load[dof + axis] += share * shape.value[k] * d[axis];
        }
        return energy(statics, load);
    };
    double missed = 0.0;
    for (const dvec3& d : {dvec3{1, 0, 0}, dvec3{0, 1, 0}, dvec3{0, 0, 1}, dvec3{.6, 0, .8},
                           dvec3{.6, .8, 0}, dvec3{-.6, 0, .8}}) {
        const double owed = kernel(2, d) - kernel(1, d), most = kernel(2, {0, 1, 0});
        CHECK(std::abs(term(d, true) - owed) < 0.02 * most); // of sampling
        missed = std::max(missed, std::abs(term(d, false) - owed) / most);
    }
    CHECK(missed > 0.1); // along and across alone
}

TEST_CASE("mesh term: progress runs to the end") {
    static double last;
    last = -1.0;
    const auto mesh = tissue::box_mesh({.08, .08, .04}, {4, 4, 2});
    const auto anchored = block::bottom_anchored(mesh);
    auto skin = block::top_skin({.08, .08, .04}, 20e-3);
    tissue::make_footprints(mesh, anchored, {}, skin);
    tissue::make_mesh_terms(mesh, kPoisson, anchored, {}, skin, {}, [](double share) {
        CHECK(share > last);
        last = share;
    });
    CHECK(last == 1.0);
}

TEST_CASE("mesh term: a body that nothing holds is refused with the reason") {
    const auto mesh = tissue::box_mesh({.08, .08, .04}, {2, 2, 1});
    std::vector<std::uint8_t> anchored(mesh.rest_m.size(), 0);
    auto skin = block::top_skin({.08, .08, .04}, 20e-3);
    CHECK_THROWS_WITH(tissue::make_mesh_terms(mesh, kPoisson, anchored, {}, skin),
                      doctest::Contains("no footprints yet"));
    tissue::make_footprints(mesh, anchored, {}, skin);
    CHECK_THROWS_WITH(tissue::make_mesh_terms(mesh, kPoisson, anchored, {}, skin),
                      doctest::Contains("0 anchored nodes do not hold the body"));
    anchored[0] = anchored[1] = anchored[2] = 1; // one edge: it can still turn
    CHECK_THROWS_WITH(tissue::make_mesh_terms(mesh, kPoisson, anchored, {}, skin),
                      doctest::Contains("3 anchored nodes do not hold the body"));
    anchored[4] = 1;
    CHECK_NOTHROW(tissue::make_mesh_terms(mesh, kPoisson, anchored, {}, skin));
    anchored.pop_back();
    CHECK_THROWS_WITH(tissue::make_mesh_terms(mesh, kPoisson, anchored, {}, skin),
                      doctest::Contains("17 anchor flags for 18 nodes"));
}
