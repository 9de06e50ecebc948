// tests/haptics/walk_meshes.h
// Triangulated surfaces to walk on, and where points of them are. For the tests of walks.
#pragma once

#include "haptics/contact/surface_walk.h"

#include <map>
#include <random>
#include <vector>

namespace walk_tests {

using haptics::SurfacePoint;

struct Mesh {
    std::vector<glm::dvec3> vertex;
    std::vector<std::array<int, 3>> triangle;
    std::vector<std::array<int, 3>> across;

    glm::dvec3 position(int t, int corner) const { return vertex[triangle[t][corner]]; }
    int neighbour(int t, int corner) const { return across[t][corner]; }
    glm::dvec3 at(const SurfacePoint& p) const {
        return p.weight.x * position(p.triangle, 0) + p.weight.y * position(p.triangle, 1) +
               p.weight.z * position(p.triangle, 2);
    }
    void connect() {
        std::map<std::pair<int, int>, std::pair<int, int>> owner;
        across.assign(triangle.size(), {-1, -1, -1});
        for (int t = 0; t < static_cast<int>(triangle.size()); ++t)
            for (int k = 0; k < 3; ++k)
                owner[{triangle[t][(k + 1) % 3], triangle[t][(k + 2) % 3]}] = {t, k};
        for (const auto& [edge, side] : owner)
            if (const auto other = owner.find({edge.second, edge.first}); other != owner.end())
                across[side.first][side.second] = other->second.first;
    }
};

// (n+1)^2 vertices of a unit square, inner ones shaken, diagonals at random, corners rotated.
inline Mesh flat_mesh(std::uint32_t seed, int n, double shake) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Mesh m;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const bool inner = i > 0 && i < n && j > 0 && j < n;
            m.vertex.push_back({(i + (inner ? shake * uniform(rng) : 0.0)) / n,
                                (j + (inner ? shake * uniform(rng) : 0.0)) / n, 0.0});
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i;
            const int b = a + 1;
            const int c = a + n + 2;
            const int d = a + n + 1;
            if (uniform(rng) > 0.0) {
                m.triangle.push_back({a, b, c});
                m.triangle.push_back({c, d, a});
            } else {
                m.triangle.push_back({b, c, d});
                m.triangle.push_back({b, d, a});
            }
        }
    m.connect();
    return m;
}

// Octahedron, split and pushed onto the unit sphere: eight triangles meet at no vertex, four at
// six of them, six elsewhere.
inline Mesh sphere_mesh(int splits) {
    Mesh m;
    m.vertex = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    m.triangle = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                  {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int s = 0; s < splits; ++s) {
        std::map<std::pair<int, int>, int> middle;
        std::vector<std::array<int, 3>> finer;
        const auto mid = [&](int a, int b) {
            const auto key = std::minmax(a, b);
            if (!middle.contains(key)) {
                middle[key] = static_cast<int>(m.vertex.size());
                m.vertex.push_back(glm::normalize(m.vertex[a] + m.vertex[b]));
            }
            return middle[key];
        };
        for (const auto& t : m.triangle) {
            const int a = mid(t[0], t[1]);
            const int b = mid(t[1], t[2]);
            const int c = mid(t[2], t[0]);
            finer.insert(finer.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
        }
        m.triangle = finer;
    }
    m.connect();
    return m;
}

inline SurfacePoint find(const Mesh& m, const glm::dvec3& place) {
    for (int t = 0; t < static_cast<int>(m.triangle.size()); ++t) {
        const std::array p{m.position(t, 0), m.position(t, 1), m.position(t, 2)};
        const glm::dvec3 n = haptics::walk_detail::plane_normal(p);
        if (n == glm::dvec3{0.0})
            continue;
        glm::dvec3 w = haptics::walk_detail::weight_change(p, n, place - p[0]);
        w.x += 1.0;
        if (w.x >= 0 && w.y >= 0 && w.z >= 0)
            return {t, w};
    }
    return {};
}

inline bool sound(const SurfacePoint& p) {
    const double sum = p.weight.x + p.weight.y + p.weight.z;
    return p.weight.x >= 0 && p.weight.y >= 0 && p.weight.z >= 0 && std::abs(sum - 1.0) < 1e-12;
}

} // namespace walk_tests
