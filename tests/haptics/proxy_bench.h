// tests/haptics/proxy_bench.h
// Small meshes, and a ball led over them, for the tests of the contact methods.
#pragma once

#include "haptics/collision/index.h"
#include "haptics/contact/proxy_method.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

namespace proxy_bench {

using glm::dvec3;

struct Bench {
    std::vector<dvec3> vertex;
    std::vector<haptics::Corners> triangle;
    haptics::CollisionIndex index;
    haptics::ProxyInput input;
    haptics::ProxyState state;

    haptics::MeshView mesh() const { return {vertex, triangle, {}}; }
    void quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
        const auto v = static_cast<std::uint32_t>(vertex.size());
        vertex.insert(vertex.end(), {a, b, c, d});
        triangle.insert(triangle.end(), {{v, v + 1, v + 2}, {v, v + 2, v + 3}});
        index = haptics::make_index("brute-force", mesh());
    }
    template <class Step> const haptics::ProxyState& lead(Step step, const dvec3& device_m) {
        input.device_m = device_m;
        step(index, mesh(), input, state);
        return state;
    }
};

/// 200 mm square in z = 0, up.
inline Bench floor() {
    Bench b;
    b.quad({-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0});
    return b;
}

/// The cube corner x, y, z >= 0: three walls, facing in.
inline Bench cube_corner() {
    Bench b;
    b.quad({0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0});
    b.quad({0, 0, 0}, {0, 0.1, 0}, {0, 0.1, 0.1}, {0, 0, 0.1});
    b.quad({0, 0, 0}, {0, 0, 0.1}, {0.1, 0, 0.1}, {0.1, 0, 0});
    return b;
}

/// A closed ball of 15 to 20 mm about the origin, ridges and pits everywhere, star-shaped.
inline Bench crumpled_ball(std::uint64_t seed) {
    constexpr std::uint32_t kRings = 6, kSegments = 10;
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> radius_m(0.015, 0.02);
    Bench b;
    const auto vertex = [&](double theta, double phi) {
        b.vertex.push_back(radius_m(engine) * dvec3{std::sin(theta) * std::cos(phi),
                                                    std::sin(theta) * std::sin(phi),
                                                    std::cos(theta)});
    };
    vertex(0.0, 0.0);
    for (std::uint32_t j = 1; j <= kRings; ++j)
        for (std::uint32_t i = 0; i < kSegments; ++i)
            vertex(3.14159265 * j / (kRings + 1), 6.2831853 * i / kSegments);
    vertex(3.14159265, 0.0);
    const std::uint32_t last = kRings * kSegments + 1, low = last - kSegments;
    for (std::uint32_t i = 0; i < kSegments; ++i) {
        const std::uint32_t next = (i + 1) % kSegments;
        b.triangle.push_back({0, 1 + i, 1 + next});
        for (std::uint32_t row = 1; row < low; row += kSegments) {
            b.triangle.push_back({row + i, row + kSegments + i, row + kSegments + next});
            b.triangle.push_back({row + i, row + kSegments + next, row + next});
        }
        b.triangle.push_back({low + i, last, low + next});
    }
    b.index = haptics::make_index("brute-force", b.mesh());
    return b;
}

/// A hand that is drawn into the ball and wanders there: the next place, at most 0.3 m/s.
struct Hand {
    std::mt19937_64 engine;
    dvec3 place_m{0.03, 0.0, 0.0}, velocity_mps{0.0};
    dvec3 next() {
        std::normal_distribution<double> n;
        const dvec3 push{n(engine), n(engine), n(engine)};
        velocity_mps = 0.98 * velocity_mps + 0.02 * push - 0.2 * place_m;
        velocity_mps *= std::min(1.0, 0.3 / glm::length(velocity_mps));
        return place_m += 1e-3 * velocity_mps;
    }
};

/// How far inside the star-shaped ball a place is, along its own direction; below 0: outside.
inline double inside_m(const Bench& b, const dvec3& place_m) {
    const double out_m = glm::length(place_m);
    return haptics::cast_segment(b.index, b.mesh(), {0, 0, 0}, 0.05 / out_m * place_m).distance_m -
           out_m;
}

} // namespace proxy_bench
