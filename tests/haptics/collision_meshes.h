// tests/haptics/collision_meshes.h
// Random meshes of every character for tests of collision methods, about 2 units large.
#pragma once

#include "haptics/collision/mesh_view.h"

#include <cmath>
#include <random>
#include <vector>

struct CollisionRandom {
    std::mt19937_64 engine;
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }
    double power(double low, double high) { return std::pow(10.0, between(low, high)); }
    std::uint32_t below(std::size_t n) { return static_cast<std::uint32_t>(engine() % n); }
    glm::dvec3 place(double size) {
        return {between(-size, size), between(-size, size), between(-size, size)};
    }
};

struct CollisionMesh {
    std::vector<glm::dvec3> vertex, before;
    std::vector<haptics::Corners> triangle;
    haptics::MeshView view() const { return {vertex, triangle, before}; }
};

// Triangles of any size anywhere; every third a sliver, every seventh without area.
inline CollisionMesh soup(CollisionRandom& random, std::uint32_t triangles) {
    CollisionMesh mesh;
    for (std::uint32_t t = 0; t < triangles; ++t) {
        const glm::dvec3 at = random.place(1.0);
        const double size = random.power(-2.0, -0.3);
        const glm::dvec3 a = at + random.place(size), b = at + random.place(size);
        glm::dvec3 c = at + random.place(size);
        if (t % 3 == 0)
            c = a + random.between(0, 1) * (b - a) + random.place(random.power(-12.0, -3.0));
        if (t % 7 == 0)
            c = t % 2 ? a : a + 0.5 * (b - a);
        for (const glm::dvec3& p : {a, b, c})
            mesh.vertex.push_back(p);
        mesh.triangle.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    return mesh;
}

// Closed, crumpled; its poles are many vertices in one place, so there are triangles without area.
inline CollisionMesh ball(CollisionRandom& random, std::uint32_t n) {
    CollisionMesh mesh;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const double theta = 3.14159265358979 * j / n, phi = 6.28318530717959 * i / n;
            const double r = j % n == 0 ? 1.0 : random.between(0.8, 1.0);
            mesh.vertex.push_back(r * glm::dvec3{std::sin(theta) * std::cos(phi),
                                                 std::sin(theta) * std::sin(phi), std::cos(theta)});
            if (j == n)
                continue;
            const std::uint32_t a = j * n + i, b = j * n + (i + 1) % n;
            mesh.triangle.push_back({a, b, a + n});
            mesh.triangle.push_back({b, b + n, a + n});
        }
    return mesh;
}

// n x n cells over [-1, 1]^2 at a height, in either winding.
inline void add_sheet(CollisionMesh& mesh, std::uint32_t n, double height_m) {
    const auto first = static_cast<std::uint32_t>(mesh.vertex.size());
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) {
            mesh.vertex.push_back({2.0 * i / n - 1.0, 2.0 * j / n - 1.0, height_m});
            if (i == n || j == n)
                continue;
            const std::uint32_t a = first + j * (n + 1) + i;
            mesh.triangle.push_back({a, a + 1, a + n + 1});
            mesh.triangle.push_back({a + 1, a + n + 2, a + n + 1});
        }
}

inline CollisionMesh height_field(CollisionRandom& random, std::uint32_t n) {
    CollisionMesh mesh;
    add_sheet(mesh, n, 0.0);
    for (glm::dvec3& v : mesh.vertex)
        v.z = 0.3 * std::sin(5.0 * v.x) * std::cos(4.0 * v.y) + random.between(-0.02, 0.02);
    return mesh;
}

// Two sheets close together, askew: a closed membrane but for its rim.
inline CollisionMesh thin_sheet(CollisionRandom& random, std::uint32_t n, double thickness_m) {
    CollisionMesh mesh;
    add_sheet(mesh, n, 0.0);
    add_sheet(mesh, n, thickness_m);
    const double turn = random.between(0.0, 6.28), c = std::cos(turn), s = std::sin(turn);
    for (glm::dvec3& v : mesh.vertex) {
        const glm::dvec3 p = v;
        v = {c * p.x - s * p.z, p.y, s * p.x + c * p.z};
    }
    return mesh;
}

inline CollisionMesh any_mesh(CollisionRandom& random) {
    switch (random.below(5)) {
    case 0:
        return soup(random, 1 + random.below(300));
    case 1:
        return ball(random, 12);
    case 2:
        return height_field(random, 12);
    case 3:
        return thin_sheet(random, 9, random.power(-6.0, -1.0));
    default: { // everything twice: ties and duplicate vertices
        CollisionMesh mesh = soup(random, 60);
        const CollisionMesh once = mesh;
        for (const haptics::Corners& t : once.triangle)
            mesh.triangle.push_back({t[2], t[0], t[1]});
        mesh.vertex.insert(mesh.vertex.end(), once.vertex.begin(), once.vertex.end());
        return mesh;
    }
    }
}

// All vertices go somewhere else within the interval, from where they are: together, by
// themselves, or both.
inline void move(CollisionRandom& random, CollisionMesh& mesh) {
    mesh.before = mesh.vertex;
    const glm::dvec3 together =
        random.below(3) ? random.place(random.power(-3.0, 0.0)) : glm::dvec3{0.0};
    const double apart = random.below(3) ? random.power(-4.0, -0.5) : 0.0;
    for (glm::dvec3& v : mesh.vertex)
        v += together + random.place(apart);
}
