// tissue/response/patch.cpp
// Gathers the triangles around a contact. Tissue loop, every step, per tool.
#include "tissue/response/patch.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dvec3;

constexpr std::int32_t kOutside = -1;

// Forgets the last patch in its own time, not in that of the whole surface.
void clear(Patch& patch) noexcept {
    for (const std::uint32_t v : patch.vertex)
        patch.vertex_local[v] = kOutside;
    for (const std::uint32_t t : patch.triangle)
        patch.triangle_local[t] = kOutside;
    patch.vertex.clear();
    patch.triangle.clear();
    patch.corner.clear();
    patch.neighbour.clear();
}

// False if the triangle does not fit any more.
bool append(const ContactSurface& surface, std::uint32_t triangle, Patch& patch) noexcept {
    const Triangle& t = surface.triangles[triangle];
    const auto fresh = std::count_if(
        t.begin(), t.end(), [&](std::uint32_t v) { return patch.vertex_local[v] == kOutside; });
    if (patch.triangle.size() >= patch.max_triangles ||
        patch.vertex.size() + static_cast<std::size_t>(fresh) > patch.max_vertices) {
        return false;
    }
    std::array<std::int16_t, 3> corner;
    for (int k = 0; k < 3; ++k) {
        std::int32_t& local = patch.vertex_local[t[k]];
        if (local == kOutside) {
            local = static_cast<std::int32_t>(patch.vertex.size());
            patch.vertex.push_back(t[k]);
        }
        corner[k] = static_cast<std::int16_t>(local);
    }
    patch.triangle_local[triangle] = static_cast<std::int32_t>(patch.triangle.size());
    patch.triangle.push_back(triangle);
    patch.corner.push_back(corner);
    return true;
}

} // namespace

Patch make_patch(const ContactSurface& surface, int max_vertices, int max_triangles) {
    constexpr int kMost = std::numeric_limits<std::int16_t>::max();
    if (max_vertices < 3 || max_triangles < 1 || max_vertices > kMost || max_triangles > kMost) {
        throw std::invalid_argument("patch of " + std::to_string(max_vertices) + " vertices and " +
                                    std::to_string(max_triangles) + " triangles: 3 and 1 to " +
                                    std::to_string(kMost));
    }
    Patch patch;
    patch.max_vertices = static_cast<std::size_t>(max_vertices);
    patch.max_triangles = static_cast<std::size_t>(max_triangles);
    patch.vertex.reserve(patch.max_vertices);
    patch.triangle.reserve(patch.max_triangles);
    patch.corner.reserve(patch.max_triangles);
    patch.neighbour.reserve(patch.max_triangles);
    patch.vertex_local.assign(surface.rest_m.size(), kOutside);
    patch.triangle_local.assign(surface.triangles.size(), kOutside);
    return patch;
}

void gather_patch(const ContactSurface& surface, std::span<const dvec3> position_m,
                  std::uint32_t centre, double radius_m, Patch& patch) noexcept {
    clear(patch);
    const Triangle& c = surface.triangles[centre];
    const dvec3 middle = (position_m[c[0]] + position_m[c[1]] + position_m[c[2]]) / 3.0;
    const auto within = [&](const Triangle& t) {
        return std::any_of(t.begin(), t.end(), [&](std::uint32_t v) {
            const dvec3 away = position_m[v] - middle;
            return glm::dot(away, away) <= radius_m * radius_m;
        });
    };

    // the list of triangles is the queue
    bool room = append(surface, centre, patch);
    for (std::size_t next = 0; room && next < patch.triangle.size(); ++next) {
        for (const std::int32_t n : surface.neighbours[patch.triangle[next]]) {
            if (n < 0 || patch.triangle_local[n] != kOutside)
                continue;
            const auto triangle = static_cast<std::uint32_t>(n);
            if (!within(surface.triangles[triangle]))
                continue;
            room = append(surface, triangle, patch);
            if (!room)
                break;
        }
    }
    for (const std::uint32_t t : patch.triangle) {
        std::array<std::int16_t, 3> local;
        for (int k = 0; k < 3; ++k) {
            const std::int32_t n = surface.neighbours[t][k];
            local[k] = static_cast<std::int16_t>(n < 0 ? kOutside : patch.triangle_local[n]);
        }
        patch.neighbour.push_back(local);
    }
}

} // namespace tissue
