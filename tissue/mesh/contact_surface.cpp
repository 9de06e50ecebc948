// tissue/mesh/contact_surface.cpp
// Places the skin on its tissue (tissue loop, every step) and finds which triangles touch
// (load and bake time).
#include "tissue/mesh/contact_surface.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

struct HalfEdge {
    std::uint32_t low, high; // vertices
    std::uint32_t triangle;
    std::uint32_t opposite; // corner
    bool forward;           // the triangle runs from low to high
};

std::string edge_name(const HalfEdge& e) {
    return "edge " + std::to_string(e.low) + "-" + std::to_string(e.high);
}

// Orthonormal frame of a triangle: first edge, in-plane normal to it, normal. False if degenerate.
bool triangle_frame(const dvec3& a, const dvec3& b, const dvec3& c, dmat3& frame) noexcept {
    const dvec3 normal = glm::cross(b - a, c - a);
    const double area = glm::length(normal), edge = glm::length(b - a);
    if (!(area > 0.0) || !(edge > 0.0))
        return false;
    frame[0] = (b - a) / edge;
    frame[2] = normal / area;
    frame[1] = glm::cross(frame[2], frame[0]);
    return true;
}

// Rotation of a triangle from rest to x: its normal turns into the new normal, and within the
// plane it turns by the rotation part of the in-plane deformation gradient
// F = [1 s; 0 t] scaled by the first edge, whose angle is atan2(F10 - F01, F00 + F11).
dmat3 triangle_rotation(const std::array<dvec3, 3>& rest, const std::array<dvec3, 3>& x) noexcept {
    dmat3 from, to;
    if (!triangle_frame(rest[0], rest[1], rest[2], from) || !triangle_frame(x[0], x[1], x[2], to)) {
        return dmat3(1.0);
    }
    // in-plane coordinates: first edge (p, 0), second edge (q, r)
    const double p0 = glm::dot(rest[1] - rest[0], from[0]), p1 = glm::dot(x[1] - x[0], to[0]);
    const double q0 = glm::dot(rest[2] - rest[0], from[0]), q1 = glm::dot(x[2] - x[0], to[0]);
    const double r0 = glm::dot(rest[2] - rest[0], from[1]), r1 = glm::dot(x[2] - x[0], to[1]);
    const double f00 = p1 / p0, f11 = r1 / r0, f01 = (q1 - f00 * q0) / r0;
    const double size = std::hypot(f00 + f11, f01);
    const double cosine = (f00 + f11) / size, sine = -f01 / size;
    const dmat3 turned{cosine * to[0] + sine * to[1], cosine * to[1] - sine * to[0], to[2]};
    return turned * glm::transpose(from);
}

} // namespace

std::vector<std::array<std::int32_t, 3>> triangle_neighbours(std::span<const Triangle> triangles) {
    std::vector<HalfEdge> edges;
    edges.reserve(3 * triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t from = triangles[i][(k + 1) % 3], to = triangles[i][(k + 2) % 3];
            edges.push_back({std::min(from, to), std::max(from, to), i, k, from < to});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        if (a.low != b.low)
            return a.low < b.low;
        if (a.high != b.high)
            return a.high < b.high;
        return a.triangle < b.triangle;
    });

    std::vector<std::array<std::int32_t, 3>> neighbours(triangles.size(), {-1, -1, -1});
    for (std::size_t i = 0; i < edges.size();) {
        const HalfEdge& a = edges[i];
        if (a.low == a.high) {
            throw std::invalid_argument("surface: triangle " + std::to_string(a.triangle) +
                                        " names vertex " + std::to_string(a.low) + " twice");
        }
        std::size_t end = i + 1;
        while (end < edges.size() && edges[end].low == a.low && edges[end].high == a.high)
            ++end;
        if (end - i > 2) {
            throw std::invalid_argument("surface: " + edge_name(a) + " has " +
                                        std::to_string(end - i) + " triangles: at most 2");
        }
        if (end - i == 2) {
            const HalfEdge& b = edges[i + 1];
            if (a.forward == b.forward) {
                throw std::invalid_argument("surface: the two triangles of " + edge_name(a) +
                                            " face opposite ways");
            }
            neighbours[a.triangle][a.opposite] = static_cast<std::int32_t>(b.triangle);
            neighbours[b.triangle][b.opposite] = static_cast<std::int32_t>(a.triangle);
        }
        i = end;
    }
    return neighbours;
}

void place_surface(const ContactSurface& surface, std::span<const dvec3> rest_node_m,
                   std::span<const dvec3> node_m, std::span<dvec3> position_m,
                   std::span<dvec3> normal) noexcept {
    // rigid scenery has no rows: it stays where it is
    const bool rigid = surface.row_start.empty();
    for (std::size_t v = 0; v < surface.rest_m.size(); ++v) {
        normal[v] = dvec3{0.0};
        if (rigid) {
            position_m[v] = surface.rest_m[v];
            continue;
        }
        dvec3 carried{0.0};
        for (std::uint32_t k = surface.row_start[v]; k < surface.row_start[v + 1]; ++k) {
            carried += surface.row_weight[k] * node_m[surface.row_node[k]];
        }
        const std::array<std::uint32_t, 3>& f = surface.frame_node[v];
        const dmat3 turn =
            triangle_rotation({rest_node_m[f[0]], rest_node_m[f[1]], rest_node_m[f[2]]},
                              {node_m[f[0]], node_m[f[1]], node_m[f[2]]});
        position_m[v] = carried + turn * surface.offset_m[v];
    }

    // area-weighted normals of the surface as placed
    for (const Triangle& t : surface.triangles) {
        const dvec3 area =
            glm::cross(position_m[t[1]] - position_m[t[0]], position_m[t[2]] - position_m[t[0]]);
        for (const std::uint32_t v : t)
            normal[v] += area;
    }
    for (std::size_t v = 0; v < surface.rest_m.size(); ++v) {
        const double size = glm::length(normal[v]);
        normal[v] = size > 0.0 ? normal[v] / size : dvec3{0.0, 0.0, 1.0};
    }
}

} // namespace tissue
