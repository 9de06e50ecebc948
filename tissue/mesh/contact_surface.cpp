// tissue/mesh/contact_surface.cpp
// Places the skin on its tissue (tissue loop, every step) and finds which triangles touch
// (load and bake time).
#include "tissue/mesh/contact_surface.h"

#include "tissue/mesh/skin_rows.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numeric>
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

// What of a triangle at rest never changes, and its frame; edge_1pm 0 if it is degenerate.
SkinFrame rest_frame(const dvec3& a, const dvec3& b, const dvec3& c, dmat3& from) noexcept {
    SkinFrame frame;
    if (!triangle_frame(a, b, c, from))
        return frame;
    frame.edge_1pm = 1.0 / glm::dot(b - a, from[0]);
    frame.height_1pm = 1.0 / glm::dot(c - a, from[1]);
    frame.skew = frame.edge_1pm * glm::dot(c - a, from[0]) * frame.height_1pm;
    return frame;
}

// How a frame triangle turned: its normal turns into the new normal, and within the plane it turns
// by the rotation part of the in-plane deformation gradient F = [f00 f01; 0 f11], whose angle is
// atan2(-f01, f00 + f11). False if it is degenerate, now or at rest.
bool turned(const SkinFrame& rest, const dvec3& a, const dvec3& b, const dvec3& c,
            dmat3& to) noexcept {
    if (rest.edge_1pm == 0.0 || !triangle_frame(a, b, c, to))
        return false;
    const double f00 = glm::dot(b - a, to[0]) * rest.edge_1pm;
    const double f11 = glm::dot(c - a, to[1]) * rest.height_1pm;
    const double f01 =
        glm::dot(c - a, to[0]) * rest.height_1pm - glm::dot(b - a, to[0]) * rest.skew;
    const double size = std::sqrt((f00 + f11) * (f00 + f11) + f01 * f01);
    const double cosine = (f00 + f11) / size, sine = -f01 / size;
    const dvec3 first = cosine * to[0] + sine * to[1];
    to[1] = cosine * to[1] - sine * to[0];
    to[0] = first;
    return true;
}

void add_offsets(const ContactSurface& surface, const SkinFrames& frames,
                 std::span<const dvec3> node_m, std::span<dvec3> position_m) noexcept {
    std::uint32_t k = 0;
    for (const SkinFrame& frame : frames.frame) {
        dmat3 to;
        const bool firm =
            turned(frame, node_m[frame.node[0]], node_m[frame.node[1]], node_m[frame.node[2]], to);
        for (; k < frame.stop; ++k) {
            const std::uint32_t v = frames.vertex[k];
            position_m[v] += firm ? to * frames.offset_m[k] : surface.offset_m[v];
        }
    }
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

SkinFrames make_skin_frames(const ContactSurface& surface, std::span<const dvec3> rest_node_m) {
    SkinFrames frames;
    frames.vertex.resize(surface.frame_node.size());
    std::iota(frames.vertex.begin(), frames.vertex.end(), 0u);
    std::ranges::stable_sort(frames.vertex, {}, [&](auto v) { return surface.frame_node[v]; });
    dmat3 from;
    bool firm = false;
    for (std::size_t k = 0; k < frames.vertex.size(); ++k) {
        const std::uint32_t v = frames.vertex[k];
        if (k == 0 || frames.frame.back().node != surface.frame_node[v]) {
            const auto [i, j, l] = surface.frame_node[v];
            SkinFrame& frame = frames.frame.emplace_back(
                rest_frame(rest_node_m[i], rest_node_m[j], rest_node_m[l], from));
            frame.node = surface.frame_node[v];
            firm = frame.edge_1pm != 0.0;
        }
        frames.frame.back().stop = static_cast<std::uint32_t>(k + 1);
        frames.offset_m.push_back(firm ? glm::transpose(from) * surface.offset_m[v]
                                       : surface.offset_m[v]);
    }
    return frames;
}

dmat3 triangle_turn(const std::array<dvec3, 3>& rest_m,
                    const std::array<dvec3, 3>& now_m) noexcept {
    dmat3 from, to;
    const SkinFrame rest = rest_frame(rest_m[0], rest_m[1], rest_m[2], from);
    return turned(rest, now_m[0], now_m[1], now_m[2], to) ? to * glm::transpose(from) : dmat3{1.0};
}

void place_surface(const ContactSurface& surface, const SkinFrames& frames,
                   std::span<const dvec3> node_m, std::span<dvec3> position_m,
                   std::span<dvec3> normal) noexcept {
    std::fill(normal.begin(), normal.end(), dvec3{0.0});
    // rigid scenery has no rows: it stays where it is
    if (surface.row_start.empty()) {
        std::copy(surface.rest_m.begin(), surface.rest_m.end(), position_m.begin());
    } else {
        carry_rows(surface, node_m, position_m);
        add_offsets(surface, frames, node_m, position_m);
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
