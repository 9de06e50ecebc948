// tests/sim/organ_bench.h
// Blocks of tissue that fall, lie, topple and are pressed, and rigid floors: for the tests of
// organs that meet. Gravity, which organs of scenes are baked under, acts here on whoever asks.
#pragma once

#include "sim/loop/tissue_loop.h"
#include "tissue/response/footprint.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace organ_tests {

inline constexpr double kRadius_m = 3e-3, kGravity_mps2 = 9.81;
inline constexpr std::array<tissue::Tier, 3> kSoft{tissue::Tier::linear, tissue::Tier::corotated,
                                                   tissue::Tier::quadratic};

struct Block {
    glm::dvec3 low_m{0.0}, size_m{0.04};
    std::array<int, 3> cells{4, 4, 4};
    double young_pa = 20e3, skin_m = 4e-3;
    bool held_below = false; // its lowest nodes
    bool held_left = false;  // those of least x
    bool heavy = true;
};

inline tissue::Material material_of(const Block& block, double damping_1ps) {
    return {.young_pa = block.young_pa,
            .poisson = 0.4,
            .density_kgpm3 = 1000.0,
            .damping_mass_1ps = damping_1ps,
            .damping_stiffness_s = 3e-3,
            .source = "test"};
}

/// The whole boundary of a box, in triangles of about `edge_m`.
inline tissue::ContactSurface box_skin(const glm::dvec3& low_m, const glm::dvec3& size_m,
                                       double edge_m) {
    std::array<int, 3> cells;
    for (int k = 0; k < 3; ++k)
        cells[static_cast<std::size_t>(k)] = std::max(1, static_cast<int>(size_m[k] / edge_m + .5));
    const tissue::TetMesh fine = tissue::box_mesh(size_m, cells);
    tissue::ContactSurface skin;
    std::vector<std::int64_t> number(fine.rest_m.size(), -1);
    for (tissue::Triangle t : tissue::boundary_triangles(fine)) {
        for (std::uint32_t& v : t) {
            if (number[v] < 0) {
                number[v] = static_cast<std::int64_t>(skin.rest_m.size());
                skin.rest_m.push_back(low_m + fine.rest_m[v]);
            }
            v = static_cast<std::uint32_t>(number[v]);
        }
        skin.triangles.push_back(t);
    }
    return skin;
}

inline sim::Body make_block(const Block& block, tissue::Tier tier, double step_s = 0.01,
                            double damping_1ps = 4.0) {
    auto organ = std::make_shared<tissue::BakedOrgan>();
    organ->name = "block";
    organ->order = tier == tissue::Tier::quadratic ? 2 : 1;
    organ->mesh = tissue::box_mesh(block.size_m, block.cells);
    for (glm::dvec3& x : organ->mesh.rest_m) {
        organ->anchored.push_back((block.held_below && x.z < 1e-9) ||
                                  (block.held_left && x.x < 1e-9));
        x += block.low_m;
    }
    organ->surface = box_skin(block.low_m, block.size_m, block.skin_m);
    tissue::make_footprints(organ->mesh, organ->anchored,
                            {.order = organ->order, .tip_radius_max_m = kRadius_m}, organ->surface);
    const tissue::Material material = material_of(block, damping_1ps);
    sim::Body body =
        sim::make_body(organ, material, {kRadius_m, kRadius_m, kRadius_m}, step_s, tier);
    if (block.heavy) {
        body.soft->solid = tissue::make_solid(tier, {organ->mesh, organ->anchored, {}}, material,
                                              {0.0, 0.0, -kGravity_mps2}, step_s);
        body.soft->resting = false;
    }
    return body;
}

inline double weight_n(const Block& block) {
    return 1000.0 * block.size_m.x * block.size_m.y * block.size_m.z * kGravity_mps2;
}

/// A rigid floor at height 0, looking up.
inline sim::Body make_floor(double half_m = 0.15, int cells = 12) {
    auto organ = std::make_shared<tissue::BakedOrgan>();
    organ->name = "floor";
    organ->rigid = true;
    for (int j = 0; j <= cells; ++j) {
        for (int i = 0; i <= cells; ++i)
            organ->surface.rest_m.push_back(
                {half_m * (2.0 * i / cells - 1.0), half_m * (2.0 * j / cells - 1.0), 0.0});
    }
    for (int j = 0; j < cells; ++j) {
        for (int i = 0; i < cells; ++i) {
            const auto v = static_cast<std::uint32_t>(i + j * (cells + 1));
            const auto up = v + static_cast<std::uint32_t>(cells) + 1;
            organ->surface.triangles.push_back({v, v + 1, up + 1});
            organ->surface.triangles.push_back({v, up + 1, up});
        }
    }
    organ->surface.neighbours = tissue::triangle_neighbours(organ->surface.triangles);
    return sim::make_body(organ, {}, {kRadius_m, kRadius_m, kRadius_m}, 0.01);
}

/// Blocks in their order, then the floor.
inline std::vector<sim::Body> on_floor(const std::vector<Block>& blocks, tissue::Tier tier,
                                       double step_s = 0.01) {
    std::vector<sim::Body> bodies;
    for (const Block& block : blocks)
        bodies.push_back(make_block(block, tier, step_s));
    bodies.push_back(make_floor());
    return bodies;
}

struct Bench {
    sim::TissueRig rig;
    std::unique_ptr<sim::TissueAnswer> answer = std::make_unique<sim::TissueAnswer>();
    sim::ToolsNow tools;
    sim::StepOutcome last;

    explicit Bench(std::vector<sim::Body> bodies, double step_s = 0.01, bool meet = true)
        : rig(sim::make_tissue_rig(std::move(bodies), {.step_s = step_s, .organs_meet = meet})) {
        for (haptics::ToolTip& tip : tools.tip)
            tip = {{0.0, 0.0, 10.0}, kRadius_m};
    }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            tools.tick += 10;
            last = sim::tissue_step(rig, tools, *answer);
        }
    }
    /// On body `of` by what it meets.
    glm::dvec3 push_n(std::int32_t of) const {
        glm::dvec3 sum{0.0};
        for (const sim::OrganRow& row : rig.organs->rows.row) {
            if (row.vertex_of == of)
                sum += row.force_n * row.normal;
            if (row.skin_of == of)
                sum -= row.force_n * row.normal;
        }
        return sum;
    }
    /// How deep vertices of skin `a` are in body `b`, by its nearest skin.
    double depth_m(std::size_t a, std::size_t b) const {
        double deepest_m = 0.0;
        for (const glm::dvec3& x : rig.bodies[a].skin_m) {
            const sim::Foot foot = sim::nearest_on(rig.bodies[b], x);
            const glm::dvec3 away = x - sim::place_on(rig.bodies[b], foot.at);
            if (glm::dot(away, sim::normal_on(rig.bodies[b], foot.at)) < 0.0)
                deepest_m = std::max(deepest_m, foot.distance_m);
        }
        return deepest_m;
    }
    double depth_m() const {
        double deepest_m = 0.0;
        for (std::size_t a = 0; a < rig.bodies.size(); ++a) {
            for (std::size_t b = 0; b < rig.bodies.size(); ++b) {
                if (a != b)
                    deepest_m = std::max(deepest_m, depth_m(a, b));
            }
        }
        return deepest_m;
    }
    double top_m(std::size_t body) const {
        double top_m = -1.0;
        for (const glm::dvec3& x : rig.bodies[body].skin_m)
            top_m = std::max(top_m, x.z);
        return top_m;
    }
    bool rests(std::size_t body) const { return rig.bodies[body].soft->resting; }
};

} // namespace organ_tests
