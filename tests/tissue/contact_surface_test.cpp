// tests/tissue/contact_surface_test.cpp
#include "tissue/mesh/contact_surface.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <rapidcheck.h>
#include <stdexcept>
#include <string>

using glm::dvec3;

namespace {

// The boundary of a box as a skin 1 mm above its nodes, each vertex carried by five nodes with
// arbitrary weights of sum 1, some of them negative.
tissue::ContactSurface loose_skin(const tissue::TetMesh& mesh) {
    tissue::ContactSurface s;
    s.triangles = tissue::boundary_triangles(mesh);
    const std::vector<tissue::Triangle> frames = s.triangles;
    s.rest_m = mesh.rest_m; // interior nodes too: vertices without a triangle are allowed
    s.row_start = {0};
    std::mt19937_64 random(3);
    for (std::size_t v = 0; v < s.rest_m.size(); ++v) {
        dvec3 carried{0.0};
        double left = 1.0;
        for (int k = 0; k < 5; ++k) {
            const auto node = static_cast<std::uint32_t>(random() % mesh.rest_m.size());
            const double w = k == 4 ? left : static_cast<double>(random() % 1000) / 800.0 - 0.4;
            left -= w;
            s.row_node.push_back(node);
            s.row_weight.push_back(w);
            carried += w * mesh.rest_m[node];
        }
        s.row_start.push_back(static_cast<std::uint32_t>(s.row_node.size()));
        s.offset_m.push_back(s.rest_m[v] - carried);
        s.frame_node.push_back(frames[random() % frames.size()]);
    }
    return s;
}

std::string message_of(const std::vector<tissue::Triangle>& triangles) {
    try {
        tissue::triangle_neighbours(triangles);
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
    return "";
}

} // namespace

TEST_CASE("a skin follows any rigid motion exactly, and so do its normals") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.04, 0.03, 0.03}, {4, 3, 3}, 0.1);
    const tissue::ContactSurface skin = loose_skin(mesh);
    const std::size_t n = skin.rest_m.size();
    std::vector<dvec3> rest(n), rest_normal(n), placed(n), normal(n);
    tissue::place_surface(skin, tissue::make_skin_frames(skin, mesh.rest_m), mesh.rest_m, rest,
                          rest_normal);

    CHECK(rc::check("rigid", [&](int a, int b, int c, unsigned turn) {
        const dvec3 axis = glm::normalize(dvec3(a % 100 + 0.5, b % 100, c % 100));
        const glm::dquat q = glm::angleAxis(turn % 6283 * 1e-3, axis);
        const dvec3 shift = 1e-3 * dvec3(b % 100, c % 100, a % 100);
        std::vector<dvec3> x;
        for (const dvec3& p : mesh.rest_m)
            x.push_back(q * p + shift);
        tissue::place_surface(skin, tissue::make_skin_frames(skin, mesh.rest_m), x, placed, normal);
        for (std::size_t v = 0; v < n; ++v) {
            RC_ASSERT(glm::length(placed[v] - (q * skin.rest_m[v] + shift)) < 1e-12);
        }
        for (const tissue::Triangle& t : skin.triangles) {
            for (const std::uint32_t v : t) {
                RC_ASSERT(glm::length(normal[v] - q * rest_normal[v]) < 1e-12);
            }
        }
    }));
}

TEST_CASE("a stretch without rotation does not turn the offset, whatever edge comes first") {
    // one vertex over one triangle in the plane z = 0; in-plane F symmetric positive: R = I
    const std::array<dvec3, 3> corner{{{0.01, 0.002, 0}, {0.03, 0.01, 0}, {0.005, 0.025, 0}}};
    for (std::uint32_t first = 0; first < 3; ++first) {
        tissue::ContactSurface s;
        s.rest_m = {{0.012, 0.013, 0.002}};
        s.row_start = {0, 1};
        s.row_node = {0};
        s.row_weight = {1.0};
        s.offset_m = {s.rest_m[0] - corner[0]};
        s.frame_node = {{first, (first + 1) % 3, (first + 2) % 3}};
        std::vector<dvec3> x;
        for (const dvec3& p : corner)
            x.push_back({1.4 * p.x + 0.3 * p.y, 0.3 * p.x + 0.8 * p.y, 0});
        std::vector<dvec3> placed(1), normal(1);
        tissue::place_surface(s, tissue::make_skin_frames(s, corner), x, placed, normal);
        CHECK(glm::length(placed[0] - (x[0] + s.offset_m[0])) < 1e-15);
    }
}

TEST_CASE("normals of a plate have unit length and face out") {
    const tissue::TetMesh mesh = tissue::box_mesh({0.04, 0.03, 0.03}, {4, 3, 3});
    const tissue::ContactSurface skin = loose_skin(mesh);
    std::vector<dvec3> x(skin.rest_m.size()), normal(x.size());
    tissue::place_surface(skin, tissue::make_skin_frames(skin, mesh.rest_m), mesh.rest_m, x,
                          normal);
    for (std::size_t v = 0; v < x.size(); ++v) {
        CHECK(glm::length(normal[v]) == doctest::Approx(1.0).scale(0.0).epsilon(1e-14));
        const dvec3 p = skin.rest_m[v];
        const bool edge = p.x < 1e-9 || p.x > 0.04 - 1e-9 || p.y < 1e-9 || p.y > 0.03 - 1e-9;
        if (p.z > 0.03 - 1e-9 && !edge)
            CHECK(normal[v].z == doctest::Approx(1.0).scale(0.0));
    }
}

TEST_CASE("rigid scenery stays at rest") {
    tissue::ContactSurface s;
    s.rest_m = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}};
    s.triangles = {{0, 1, 2}};
    std::vector<dvec3> x(3), normal(3);
    tissue::place_surface(s, {}, {}, x, normal);
    CHECK(x == s.rest_m);
    CHECK(normal[0] == dvec3(0, 0, 1));
}

TEST_CASE("neighbours are mutual and lie across the edge opposite the corner") {
    const auto triangles =
        tissue::boundary_triangles(tissue::box_mesh({0.04, 0.03, 0.03}, {4, 3, 3}));
    const auto neighbours = tissue::triangle_neighbours(triangles);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            REQUIRE(neighbours[i][k] >= 0); // closed
            const auto j = static_cast<std::size_t>(neighbours[i][k]);
            const std::uint32_t from = triangles[i][(k + 1) % 3], to = triangles[i][(k + 2) % 3];
            bool mutual = false;
            for (int m = 0; m < 3; ++m) {
                const bool same_edge =
                    triangles[j][(m + 1) % 3] == to && triangles[j][(m + 2) % 3] == from;
                mutual |= same_edge && neighbours[j][m] == static_cast<std::int32_t>(i);
            }
            CHECK(mutual);
        }
    }
}

TEST_CASE("a sheet has a rim") {
    const std::vector<tissue::Triangle> sheet{{0, 1, 2}, {2, 1, 3}};
    const auto neighbours = tissue::triangle_neighbours(sheet);
    CHECK(neighbours[0] == std::array<std::int32_t, 3>{1, -1, -1});
    CHECK(neighbours[1] == std::array<std::int32_t, 3>{-1, -1, 0});
}

TEST_CASE("a surface that is not manifold is refused by its edge") {
    CHECK(message_of({{0, 1, 2}, {2, 1, 3}, {1, 2, 4}}).find("edge 1-2") != std::string::npos);
    CHECK(message_of({{0, 1, 2}, {1, 2, 3}}).find("edge 1-2") != std::string::npos);
    CHECK(message_of({{0, 1, 1}}).find("vertex 1 twice") != std::string::npos);
    CHECK(message_of({{0, 1, 2}, {2, 1, 3}}).empty());
}
