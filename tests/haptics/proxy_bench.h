// tests/haptics/proxy_bench.h
// Small meshes, and a ball led over them, for the tests of the contact methods.
#pragma once

#include "haptics/collision/index.h"
#include "haptics/contact/proxy_method.h"

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

} // namespace proxy_bench
