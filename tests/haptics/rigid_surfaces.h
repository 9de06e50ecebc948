// tests/haptics/rigid_surfaces.h
// Closed surfaces by hand: profiles drawn along y, spheres, tori.
#pragma once

#include "haptics/rigid/convex_hull.h"
#include "haptics/rigid/surface_query.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// A polygon of the x-z plane, counter-clockwise seen from -y (x right, z up), and its triangles,
/// drawn out to y = +-half_m.
inline haptics::RigidSurface prism(const char* name, const std::vector<glm::dvec2>& profile_m,
                                   const Triangles& cap, double half_m) {
    std::vector<glm::dvec3> vertex;
    const auto n = static_cast<std::uint32_t>(profile_m.size());
    for (const double y : {-half_m, half_m})
        for (const glm::dvec2& p : profile_m)
            vertex.push_back({p.x, y, p.y});
    Triangles triangle;
    for (const auto& [a, b, c] : cap) {
        triangle.push_back({a, b, c});
        triangle.push_back({n + c, n + b, n + a});
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t j = (i + 1) % n;
        triangle.push_back({j, i, n + i});
        triangle.push_back({n + i, n + j, j});
    }
    return haptics::make_surface(name, vertex, triangle);
}

inline haptics::RigidSurface cube_surface(double half_m) {
    const double h = half_m;
    return prism("cube", {{-h, -h}, {h, -h}, {h, h}, {-h, h}}, {{{0, 1, 2}}, {{0, 2, 3}}}, h);
}

/// Legs of 40 mm, 10 mm thick: the corner of the L at the origin, open to +x and +z.
inline haptics::RigidSurface l_surface() {
    return prism("L", {{0, 0}, {0.04, 0}, {0.04, 0.01}, {0.01, 0.01}, {0.01, 0.04}, {0, 0.04}},
                 {{{0, 1, 2}}, {{0, 2, 3}}, {{0, 3, 4}}, {{0, 4, 5}}}, 0.02);
}

/// Channel 20 mm wide and 20 mm deep between walls of 10 mm, floor at z = 0.
inline haptics::RigidSurface u_surface() {
    return prism("U",
                 {{-0.02, -0.01},
                  {0.02, -0.01},
                  {0.02, 0.02},
                  {0.01, 0.02},
                  {0.01, 0},
                  {-0.01, 0},
                  {-0.01, 0.02},
                  {-0.02, 0.02}},
                 {{{0, 1, 4}}, {{1, 2, 3}}, {{1, 3, 4}}, {{0, 4, 5}}, {{0, 5, 6}}, {{0, 6, 7}}},
                 0.03);
}

/// Rings of a torus of radii R and r; R = 0 is not a sphere.
inline haptics::RigidSurface torus_surface(double ring_m, double tube_m, std::uint32_t n,
                                           std::uint32_t m) {
    std::vector<glm::dvec3> vertex;
    Triangles triangle;
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < m; ++j) {
            const double u = 6.283185307179586 * i / n, v = 6.283185307179586 * j / m;
            const double r = ring_m + tube_m * std::cos(v);
            vertex.push_back({r * std::cos(u), r * std::sin(u), tube_m * std::sin(v)});
            const std::uint32_t a = i * m + j, b = (i + 1) % n * m + j;
            const std::uint32_t c = (i + 1) % n * m + (j + 1) % m, d = i * m + (j + 1) % m;
            triangle.push_back({a, b, c});
            triangle.push_back({c, d, a});
        }
    return haptics::make_surface("torus", vertex, triangle);
}

/// A cube's faces cut n x n and blown up to a sphere.
inline haptics::RigidSurface sphere_surface(double radius_m, std::uint32_t n) {
    std::vector<glm::dvec3> vertex;
    Triangles triangle;
    std::vector<std::array<std::int64_t, 3>> key;
    const auto number = [&](const glm::dvec3& p) {
        const std::array<std::int64_t, 3> k{std::llround(p.x * n), std::llround(p.y * n),
                                            std::llround(p.z * n)};
        for (std::uint32_t i = 0; i < key.size(); ++i)
            if (key[i] == k)
                return i;
        key.push_back(k);
        vertex.push_back(radius_m * glm::normalize(p));
        return static_cast<std::uint32_t>(key.size() - 1);
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0})
            for (std::uint32_t i = 0; i < n; ++i)
                for (std::uint32_t j = 0; j < n; ++j) {
                    std::array<std::uint32_t, 4> at{};
                    for (std::uint32_t c = 0; c < 4; ++c) {
                        glm::dvec3 p{0.0};
                        p[axis] = side;
                        p[(axis + 1) % 3] = side * (2.0 * (i + (c == 1 || c == 2)) / n - 1.0);
                        p[(axis + 2) % 3] = 2.0 * (j + (c > 1)) / n - 1.0;
                        at[c] = number(p);
                    }
                    triangle.push_back({at[0], at[1], at[2]});
                    triangle.push_back({at[2], at[3], at[0]});
                }
    return haptics::make_surface("sphere", vertex, triangle);
}

/// The faces of a hull as fans of triangles.
inline haptics::RigidSurface hull_surface(const char* name, const haptics::ConvexHull& hull) {
    Triangles triangle;
    for (std::size_t f = 0; f < hull.normal.size(); ++f) {
        const auto corner = hull.corners(f);
        for (std::size_t i = 2; i < corner.size(); ++i)
            triangle.push_back({corner[0], corner[i - 1], corner[i]});
    }
    return haptics::make_surface(name, hull.vertex_m, triangle);
}
