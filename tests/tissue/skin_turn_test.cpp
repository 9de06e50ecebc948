// tests/tissue/skin_turn_test.cpp
// How a skin vertex moves with its nodes, the turning of its offset included: exact for rigid
// turns, and the derivative of where the surface is placed.
#include "tests/tissue/block.h"
#include "tests/tissue/bodies.h"
#include "tissue/response/footprint.h"
#include "tissue/response/skin_turn.h"

#include <doctest/doctest.h>

namespace {

using glm::dvec3;

struct Skinned {
    tissue::TetMesh mesh = tissue::box_mesh({0.04, 0.04, 0.03}, {4, 4, 3}, 0.1);
    tissue::ContactSurface skin = block::top_skin({0.04, 0.04, 0.03}, 4e-3);
    tissue::SkinFrames frames;
    std::vector<std::int32_t> dof;
    std::vector<dvec3> node_m, place_m, normal;

    Skinned() {
        tissue::make_footprints(mesh, {}, {}, skin);
        frames = tissue::make_skin_frames(skin, mesh.rest_m);
        for (std::size_t i = 0; i < mesh.rest_m.size(); ++i)
            dof.push_back(static_cast<std::int32_t>(3 * i));
        // turned as a whole, so that nothing is along an axis
        const glm::dmat3 R = bodies::rotation({1.0, 2.0, -0.5}, 0.7);
        for (const dvec3& x : mesh.rest_m)
            node_m.push_back(R * x);
        place_m = placed(node_m);
    }
    std::vector<dvec3> placed(const std::vector<dvec3>& nodes) {
        std::vector<dvec3> place(skin.rest_m.size());
        normal.resize(place.size());
        tissue::place_surface(skin, frames, nodes, place, normal);
        return place;
    }
    double motion(std::uint32_t v, const dvec3& direction, const std::vector<double>& du) const {
        return glm::dot(direction, tissue::vertex_value(dof, skin, v, du)) +
               tissue::turn_value(dof, tissue::skin_turn(skin, node_m, v, place_m[v], direction),
                                  du);
    }
};

const std::array<dvec3, 3> kDirections{dvec3{1, 0, 0}, dvec3{0, 0.6, 0.8},
                                       glm::normalize(dvec3{-1, 2, 3})};

} // namespace

TEST_CASE("skin turn: a body that turns carries every vertex with it") {
    Skinned s;
    const dvec3 omega{0.3, -0.8, 0.5};
    std::vector<double> du;
    for (const dvec3& x : s.node_m) {
        const dvec3 v = glm::cross(omega, x);
        du.insert(du.end(), {v.x, v.y, v.z});
    }
    double worst = 0.0, left_out = 0.0;
    for (std::uint32_t v = 0; v < s.place_m.size(); ++v) {
        for (const dvec3& d : kDirections) {
            const double exact = glm::dot(d, glm::cross(omega, s.place_m[v]));
            worst = std::max(worst, std::abs(s.motion(v, d, du) - exact));
            left_out =
                std::max(left_out,
                         std::abs(glm::dot(d, tissue::vertex_value(s.dof, s.skin, v, du)) - exact));
        }
    }
    CHECK(worst < 1e-14);
    CHECK(left_out > 1e-3); // metres per radian: the offset at the edge
}

TEST_CASE("skin turn: it is the derivative of where the surface is placed") {
    Skinned s;
    std::mt19937_64 random(3);
    std::vector<double> du;
    for (std::size_t k = 0; k < 3 * s.node_m.size(); ++k)
        du.push_back(bodies::signed_unit(random));
    constexpr double kStep = 1e-8;
    std::vector<dvec3> ahead = s.node_m, behind = s.node_m;
    for (std::size_t i = 0; i < ahead.size(); ++i) {
        const dvec3 d = kStep * dvec3{du[3 * i], du[3 * i + 1], du[3 * i + 2]};
        ahead[i] += d;
        behind[i] -= d;
    }
    const std::vector<dvec3> after = s.placed(ahead), before = s.placed(behind);
    for (std::uint32_t v = 0; v < after.size(); ++v) {
        for (const dvec3& d : kDirections) {
            const double found = glm::dot(d, after[v] - before[v]) / (2.0 * kStep);
            CHECK(s.motion(v, d, du) == doctest::Approx(found).epsilon(1e-5));
        }
    }
}

TEST_CASE("skin turn: what a force adds on the nodes does the work of the vertex") {
    Skinned s;
    std::mt19937_64 random(5);
    std::vector<double> du, load(3 * s.node_m.size());
    for (std::size_t k = 0; k < load.size(); ++k)
        du.push_back(bodies::signed_unit(random));
    const dvec3 d = kDirections[2];
    const std::uint32_t corner = 0;
    tissue::add_vertex_row(s.dof, s.skin, corner, 2.0 * d, load);
    tissue::add_turn(s.dof, tissue::skin_turn(s.skin, s.node_m, corner, s.place_m[corner], d), 2.0,
                     load);
    double work = 0.0;
    for (std::size_t k = 0; k < load.size(); ++k)
        work += load[k] * du[k];
    CHECK(work == doctest::Approx(2.0 * s.motion(corner, d, du)).epsilon(1e-12));
}
