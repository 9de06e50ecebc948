// tests/haptics/ring_meshes.h
// Meshes for tests of the wide tree and its ring: seeded, nice ones and nasty ones.
#pragma once

#include "haptics/collision/mesh_view.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

namespace ring_meshes {

struct Mesh {
    std::vector<glm::dvec3> vertex_m;
    std::vector<haptics::Corners> triangle;
    std::vector<glm::dvec3> before_m; // empty: rests
    haptics::MeshView view() const { return {vertex_m, triangle, before_m}; }
};

inline glm::dvec3 random_place(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> u(-size, size);
    const double x = u(random), y = u(random);
    return {x, y, u(random)};
}

/// Closed, bumpy, about `radius_m` across; 2 n (2 n - 1) triangles.
inline Mesh ball(int n, double radius_m, std::uint32_t seed, double bumps = 0.1) {
    Mesh mesh;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(1.0 - bumps, 1.0 + bumps);
    const int around = 2 * n;
    mesh.vertex_m.push_back({0.0, 0.0, radius_m * u(random)});
    for (int i = 1; i < n; ++i)
        for (int j = 0; j < around; ++j) {
            const double polar = M_PI * i / n, turn = 2.0 * M_PI * j / around;
            mesh.vertex_m.push_back(radius_m * u(random) *
                                    glm::dvec3{std::sin(polar) * std::cos(turn),
                                               std::sin(polar) * std::sin(turn), std::cos(polar)});
        }
    mesh.vertex_m.push_back({0.0, 0.0, -radius_m * u(random)});
    const auto last = static_cast<std::uint32_t>(mesh.vertex_m.size() - 1);
    const auto at = [&](int i, int j) {
        return i == 0   ? 0u
               : i == n ? last
                        : static_cast<std::uint32_t>(1 + (i - 1) * around + j % around);
    };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < around; ++j) {
            if (i > 0)
                mesh.triangle.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            if (i + 1 < n)
                mesh.triangle.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
        }
    return mesh;
}

/// Two bumpy layers a little apart, open at the rim.
inline Mesh sheet(int n, double size_m, double apart_m, std::uint32_t seed) {
    Mesh mesh;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(-0.2, 0.2);
    for (int layer = 0; layer < 2; ++layer) {
        const auto first = static_cast<std::uint32_t>(mesh.vertex_m.size());
        for (int i = 0; i <= n; ++i)
            for (int j = 0; j <= n; ++j)
                mesh.vertex_m.push_back(
                    {size_m * (i - n / 2.0) / n, size_m * (j - n / 2.0) / n,
                     apart_m * (layer + u(random)) + 0.05 * size_m * std::sin(9.0 * i / n)});
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const auto a = static_cast<std::uint32_t>(first + i * (n + 1) + j);
                const auto up = static_cast<std::uint32_t>(a + n + 1);
                mesh.triangle.push_back({a, up, a + 1});
                mesh.triangle.push_back({a + 1, up, up + 1});
            }
    }
    return mesh;
}

/// Anything: triangles of all sizes, slivers, points, twins, corners twice.
inline Mesh soup(int triangles, double size_m, std::uint32_t seed) {
    Mesh mesh;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    for (int t = 0; t < triangles; ++t) {
        const glm::dvec3 a = random_place(random, size_m);
        const double edge = size_m * std::pow(10.0, -4.0 * u(random));
        glm::dvec3 b = a + random_place(random, edge), c = a + random_place(random, edge);
        const int kind = static_cast<int>(8.0 * u(random));
        if (kind == 0)
            c = a + u(random) * (b - a) + random_place(random, 1e-7 * edge); // sliver
        if (kind == 1)
            c = a + u(random) * (b - a); // no area
        if (kind == 2)
            b = c = a;
        const auto first = static_cast<std::uint32_t>(mesh.vertex_m.size());
        mesh.vertex_m.insert(mesh.vertex_m.end(), {a, b, c});
        mesh.triangle.push_back({first, first + 1, first + 2});
        if (kind == 3)
            mesh.triangle.push_back({first, first + 2, first + 1}); // its back again
        if (kind == 4)
            mesh.triangle.push_back({first, first, first + 1});
    }
    return mesh;
}

} // namespace ring_meshes
