// Polygons of surface files, and how many triangles are too many. Called by the readers.
#include "assets/bake/import/read_surface.h"

#include <array>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace bake {
namespace {

constexpr std::size_t kMostEars = 32;

using Flat = std::array<double, 2>;

double turn(const Flat& a, const Flat& b, const Flat& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// The polygon in the plane of its area vector (Newell), counter-clockwise.
std::vector<Flat> flatten(std::span<const std::uint32_t> corners, const Soup& soup) {
    glm::dvec3 area{0.0};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 a = soup.point[corners[i]] - soup.point[corners[0]];
        const glm::dvec3 b = soup.point[corners[(i + 1) % corners.size()]] - soup.point[corners[0]];
        area += glm::cross(a, b);
    }
    int drop = 0; // the axis nearest to the normal
    for (int d = 1; d < 3; ++d) {
        drop = std::abs(area[d]) > std::abs(area[drop]) ? d : drop;
    }
    const int u = (drop + 1) % 3, v = (drop + 2) % 3;
    std::vector<Flat> flat;
    for (const auto c : corners) {
        const glm::dvec3 p = soup.point[c] - soup.point[corners[0]];
        flat.push_back(area[drop] < 0.0 ? Flat{p[v], p[u]} : Flat{p[u], p[v]});
    }
    return flat;
}

bool is_ear(const std::vector<Flat>& flat, const std::vector<std::size_t>& ring, std::size_t at) {
    const std::size_t n = ring.size();
    const Flat &a = flat[ring[(at + n - 1) % n]], &b = flat[ring[at]],
               &c = flat[ring[(at + 1) % n]];
    if (turn(a, b, c) <= 0.0) {
        return false;
    }
    for (std::size_t i = 0; i < n; ++i) {
        const Flat& p = flat[ring[i]];
        const bool corner = i == at || i == (at + n - 1) % n || i == (at + 1) % n;
        if (!corner && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) {
            return false;
        }
    }
    return true;
}

} // namespace

void add_polygon(std::span<const std::uint32_t> corners, Soup& soup) {
    if (corners.size() < 3) {
        return;
    }
    if (corners.size() == 3 || corners.size() > kMostEars) {
        for (std::size_t i = 2; i < corners.size(); ++i) {
            soup.triangles.push_back({corners[0], corners[i - 1], corners[i]});
        }
        return;
    }
    const auto flat = flatten(corners, soup);
    std::vector<std::size_t> ring;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        ring.push_back(i);
    }
    while (ring.size() > 3) {
        std::size_t ear = 0;
        while (ear < ring.size() && !is_ear(flat, ring, ear)) {
            ++ear;
        }
        ear = ear == ring.size() ? 1 : ear; // a polygon that crosses itself: like a fan
        const std::size_t n = ring.size();
        soup.triangles.push_back(
            {corners[ring[(ear + n - 1) % n]], corners[ring[ear]], corners[ring[(ear + 1) % n]]});
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    soup.triangles.push_back({corners[ring[0]], corners[ring[1]], corners[ring[2]]});
}

void check_count(const Soup& soup) {
    if (soup.triangles.empty()) {
        throw ReadError("it has no triangles: accepted: a closed surface of triangles");
    }
    if (soup.triangles.size() > kMaxTriangles) {
        throw ReadError(fmt::format("it has {} triangles: accepted: up to {}",
                                    soup.triangles.size(), kMaxTriangles));
    }
}

} // namespace bake
