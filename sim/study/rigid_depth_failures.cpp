// sim/study/rigid_depth_failures.cpp
// Tools deep in thin and concave things: where the nearest way out leads, by method.
#include "haptics/rigid/penetration.h"
#include "haptics/rigid/step_rigid.h"
#include "sim/study/rigid_failures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <random>

namespace sim {
namespace {

using glm::dvec3;
using haptics::ConvexHull;
using haptics::Penetration;
using haptics::RigidModel;
using haptics::RigidPose;

constexpr double kStep_m = 1e-4;  // per tick: 100 mm/s
constexpr double kFelt_n = 1e-6;  // less has no direction worth the name
constexpr double kSoft_npm = 4.0; // so that the virtual tool follows the device in

ConvexHull box(const dvec3& low, const dvec3& high) {
    std::vector<dvec3> p;
    for (int i = 0; i < 8; ++i)
        p.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    return haptics::convex_hull(p, "box");
}

struct Scene {
    const char* name;
    RigidModel model;
    std::vector<dvec3> path_m; // of the tool
    dvec3 way_in_reversed{0, 0, 1};
};

Scene make_scene(const char* name, std::vector<ConvexHull> scenery, std::vector<ConvexHull> tool,
                 std::vector<dvec3> path_m) {
    const std::array device{haptics::DeviceDamping{0.5, 1e-4, 1e-3}};
    haptics::RigidParams params;
    params.contact_npm = kSoft_npm;
    return {name,
            haptics::make_rigid_model({{haptics::make_shape("scenery", std::move(scenery)), {}}},
                                      {{haptics::make_shape("tool", std::move(tool)), {}}}, device,
                                      params),
            std::move(path_m)};
}

// An L of two boxes that do not feel each other's side.
std::vector<ConvexHull> l_pieces() {
    std::vector<ConvexHull> l{box({0, -0.02, 0}, {0.04, 0.02, 0.01}),
                              box({0, -0.02, 0.01}, {0.01, 0.02, 0.04})};
    for (std::size_t f = 0; f < l[1].normal.size(); ++f)
        l[1].inner[f] = l[1].normal[f].z < -0.5;
    return l;
}

std::vector<Scene> scenes() {
    std::vector<Scene> all;
    all.push_back(make_scene("F17 slab 60 % through a slab",
                             {box({-0.01, -0.01, -2e-3}, {0.01, 0.01, 0})},
                             {box({-5e-3, -5e-3, 0}, {5e-3, 5e-3, 1e-3})},
                             {{0, 0, 3e-3}, {0, 0, -1.9e-3}, {3e-3, 2e-3, -1.9e-3}}));
    all.push_back(make_scene("F17 L 60 % through a slab",
                             {box({-0.05, -0.05, -2e-3}, {0.05, 0.05, 0})}, l_pieces(),
                             {{-0.01, 0, 3e-3}, {-0.01, 0, -7.3e-3}, {0.01, 0.01, -7.3e-3}}));
    all.push_back(make_scene("F17 bar in a U-channel",
                             {box({-0.02, -0.03, -0.002}, {0.02, 0.03, 0}),
                              box({-0.02, -0.03, 0}, {-0.0101, 0.03, 0.02}),
                              box({0.0101, -0.03, 0}, {0.02, 0.03, 0.02})},
                             {box({-0.01, -0.01, 0}, {0.01, 0.01, 4e-3})},
                             {{0, 0, 8e-3}, {0, 0, -3.8e-3}, {0, 5e-3, -3.8e-3}}));
    return all;
}

/// Force on the tool at a pose; called along the path, tick by tick.
using Feel = std::function<dvec3(const Scene&, const RigidPose&)>;

dvec3 sum_of_pairs(const Scene& scene, const RigidPose& tool,
                   const std::function<Penetration(const ConvexHull&, const ConvexHull&)>& way) {
    dvec3 sum{0.0};
    haptics::PairList pairs;
    const auto& scenery = scene.model.scenery[0].shape;
    const auto& shape = scene.model.tool[0].shape;
    haptics::close_pairs(scenery, shape, tool, 0.0, pairs);
    for (const haptics::PiecePair& p : pairs) {
        const Penetration out = way(scenery.piece[p.a], shape.piece[p.b]);
        sum += std::max(0.0, out.depth_m) * kSoft_npm * out.normal;
    }
    return sum;
}

dvec3 nearest_way_out(const Scene& scene, const RigidPose& tool) {
    return sum_of_pairs(scene, tool, [&](const ConvexHull& a, const ConvexHull& b) {
        return haptics::penetration(a, b, tool);
    });
}

dvec3 single_walk(const Scene& scene, const RigidPose& tool) {
    return sum_of_pairs(scene, tool, [&](const ConvexHull& a, const ConvexHull& b) {
        return haptics::walk_penetration(a, b, tool,
                                         haptics::to_world(tool, b.centre_m) - a.centre_m);
    });
}

double degrees(const dvec3& u, const dvec3& v) {
    return 57.29577951308232 * std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

struct Turns {
    double per_tick_deg = 0.0, from_way_in_deg = 0.0;
    int ticks = 0, felt = 0;
};

Turns along_path(const Scene& scene, const Feel& feel) {
    Turns turns;
    dvec3 last{0.0};
    for (std::size_t i = 1; i < scene.path_m.size(); ++i) {
        const dvec3 way_m = scene.path_m[i] - scene.path_m[i - 1];
        const int ticks = static_cast<int>(std::ceil(glm::length(way_m) / kStep_m));
        for (int t = 1; t <= ticks; ++t) {
            const RigidPose tool{glm::dmat3(1.0),
                                 scene.path_m[i - 1] + way_m * (double(t) / ticks)};
            const dvec3 force_n = feel(scene, tool);
            ++turns.ticks;
            if (glm::length(force_n) > kFelt_n) {
                ++turns.felt;
                turns.from_way_in_deg =
                    std::max(turns.from_way_in_deg, degrees(force_n, scene.way_in_reversed));
                if (glm::length(last) > kFelt_n)
                    turns.per_tick_deg = std::max(turns.per_tick_deg, degrees(force_n, last));
            }
            last = force_n;
        }
    }
    return turns;
}

Turns coherent(const Scene& scene) {
    haptics::RigidState state;
    haptics::RigidScratch scratch;
    haptics::RigidTick tick;
    return along_path(scene, [&](const Scene& s, const RigidPose& tool) {
        haptics::step_rigid(s.model, {&tool, 1}, state, scratch, tick);
        return tick.wrench[0].force_n;
    });
}

/// Smallest support distance over all faces and all crossings of edges.
double brute_depth(const ConvexHull& a, const ConvexHull& b, const RigidPose& pose) {
    double least_m = 1e300;
    const auto look = [&](const dvec3& n) {
        const dvec3 back = glm::transpose(pose.rotation) * -n;
        const dvec3 on_a = a.vertex_m[haptics::farthest_vertex(a, n, 0)];
        const dvec3 on_b =
            haptics::to_world(pose, b.vertex_m[haptics::farthest_vertex(b, back, 0)]);
        least_m = std::min(least_m, glm::dot(n, on_a - on_b));
    };
    for (const dvec3& n : a.normal)
        look(n);
    for (const dvec3& n : b.normal)
        look(-(pose.rotation * n));
    for (std::uint32_t v = 0; v < a.vertex_m.size(); ++v)
        for (const std::uint32_t u : a.neighbours(v))
            for (std::uint32_t p = 0; u > v && p < b.vertex_m.size(); ++p)
                for (const std::uint32_t q : b.neighbours(p)) { // both ways: both signs
                    const dvec3 n = glm::cross(a.vertex_m[u] - a.vertex_m[v],
                                               pose.rotation * (b.vertex_m[q] - b.vertex_m[p]));
                    if (glm::length(n) > 1e-9 * a.radius_m * b.radius_m)
                        look(glm::normalize(n));
                }
    return least_m;
}

struct DepthErrors {
    double single_percent = 0.0, default_percent = 0.0;
};

// Bars and plates of random points, their middles close together.
DepthErrors depth_errors(int pairs) {
    std::mt19937 random(17);
    const auto number = [&](double low, double high) {
        return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
    };
    const auto direction = [&] { return dvec3{number(-1, 1), number(-1, 1), number(-1, 1)}; };
    const auto piece = [&] {
        const dvec3 half{number(1e-3, 1e-2), number(1e-3, 1e-2), 1e-2};
        std::vector<dvec3> p;
        for (int i = 0; i < 12; ++i)
            p.push_back(half * direction());
        return haptics::convex_hull(p, "random");
    };
    DepthErrors worst;
    for (int i = 0; i < pairs; ++i) {
        const ConvexHull a = piece(), b = piece();
        const dvec3 z = glm::normalize(direction());
        const dvec3 x = glm::normalize(glm::cross(z, direction()));
        const RigidPose pose{{x, glm::cross(z, x), z}, 3e-3 * direction()};
        const double exact_m = brute_depth(a, b, pose);
        if (exact_m < 1e-4)
            continue;
        const auto percent = [&](const Penetration& p) { return 100 * (p.depth_m / exact_m - 1); };
        const dvec3 centres = haptics::to_world(pose, b.centre_m) - a.centre_m;
        worst.single_percent =
            std::max(worst.single_percent, percent(haptics::walk_penetration(a, b, pose, centres)));
        worst.default_percent =
            std::max(worst.default_percent, percent(haptics::penetration(a, b, pose)));
    }
    return worst;
}

} // namespace

std::vector<RigidFailureRow> rigid_depth_failures() {
    std::vector<RigidFailureRow> rows;
    const auto add = [&](const char* scene, const char* method, const char* quantity, double value,
                         double bound, bool fails) {
        rows.push_back({scene, method, quantity, value, bound, fails, value <= bound});
    };
    for (const Scene& scene : scenes()) {
        const auto both = [&](const char* method, const Turns& turns, bool fails) {
            add(scene.name, method, "turn per tick, degrees", turns.per_tick_deg, 30.0, fails);
            add(scene.name, method, "force from the way in, degrees", turns.from_way_in_deg, 60.0,
                fails);
            add(scene.name, method, "path without force, %",
                100.0 - 100.0 * turns.felt / turns.ticks, 50.0, false);
        };
        both("nearest-way-out", along_path(scene, nearest_way_out), true);
        both("single-walk", along_path(scene, single_walk), true);
        both("coherent", coherent(scene), false);
    }
    const DepthErrors errors = depth_errors(200);
    add("F17 convex pairs", "single-walk", "depth above brute force, %", errors.single_percent, 1.0,
        true);
    add("F17 convex pairs", "default starts", "depth above brute force, %", errors.default_percent,
        1.0, false);
    return rows;
}

} // namespace sim
