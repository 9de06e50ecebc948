#include "haptics/rigid/voxel_map.h"

#include "haptics/collision/triangle.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

namespace haptics {
namespace {

using glm::dvec3;

constexpr double kMarginVoxels = 2.0;

class Builder {
  public:
    Builder(const RigidSurface& surface, VoxelMap& map)
        : s_(surface), map_(map), nearest_(map.distance_m.size(), kRim) {}

    void run() {
        for (std::uint32_t t = 0; t < s_.triangle.size(); ++t)
            paint(t);
        for (const int way : {1, -1, 1, -1})
            spread(way);
        set_signs();
    }

  private:
    std::size_t index(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * map_.size[1] + y) * map_.size[0] + x;
    }
    dvec3 place(int x, int y, int z) const { return map_.first_m + map_.voxel_m * dvec3{x, y, z}; }
    int size(int axis) const { return static_cast<int>(map_.size[axis]); }

    std::array<dvec3, 3> corners(std::uint32_t t) const {
        const auto [a, b, c] = s_.triangle[t];
        return {s_.vertex_m[a], s_.vertex_m[b], s_.vertex_m[c]};
    }

    void offer(std::size_t node, const dvec3& at_m, std::uint32_t t) {
        const auto d =
            static_cast<float>(std::sqrt(nearest_on_triangle(corners(t), at_m).distance2_m2));
        if (nearest_[node] == kRim || d < map_.distance_m[node]) {
            nearest_[node] = t;
            map_.distance_m[node] = d;
        }
    }

    // Nodes within a voxel of a triangle's box: exact distance.
    void paint(std::uint32_t t) {
        const auto [a, b, c] = corners(t);
        const dvec3 low = (glm::min(a, glm::min(b, c)) - map_.first_m) / map_.voxel_m - 1.0;
        const dvec3 high = (glm::max(a, glm::max(b, c)) - map_.first_m) / map_.voxel_m + 1.0;
        const auto from = [&](int i) { return std::max(0, int(std::ceil(low[i]))); };
        const auto to = [&](int i) { return std::min(size(i) - 1, int(std::floor(high[i]))); };
        for (int z = from(2); z <= to(2); ++z)
            for (int y = from(1); y <= to(1); ++y)
                for (int x = from(0); x <= to(0); ++x)
                    offer(index(x, y, z), place(x, y, z), t);
    }

    // Hands each node the nearest triangles of the neighbours already passed.
    void spread(int way) {
        const auto start = [&](int i) { return way > 0 ? 0 : size(i) - 1; };
        for (int z = start(2); z >= 0 && z < size(2); z += way)
            for (int y = start(1); y >= 0 && y < size(1); y += way)
                for (int x = start(0); x >= 0 && x < size(0); x += way)
                    for (int near = 0; near < 13; ++near) { // those before it in this order
                        const int dx = near % 3 - 1, dy = near / 3 % 3 - 1, dz = near / 9 - 1;
                        take(x, y, z, x + way * dx, y + way * dy, z + way * dz);
                    }
    }

    void take(int x, int y, int z, int nx, int ny, int nz) {
        if (nx < 0 || ny < 0 || nz < 0 || nx >= size(0) || ny >= size(1) || nz >= size(2))
            return;
        const std::uint32_t t = nearest_[index(nx, ny, nz)];
        const std::size_t node = index(x, y, z);
        if (t != kRim && t != nearest_[node])
            offer(node, place(x, y, z), t);
    }

    // By the crossings of a line along z through each column, beside the nodes by a tiny odd shift
    // so that no edge is met; a column that comes out odd all the same goes by winding numbers.
    void set_signs() {
        std::vector<std::vector<double>> crossing(map_.size[0] * map_.size[1]);
        for (std::uint32_t t = 0; t < s_.triangle.size(); ++t)
            cross(t, crossing);
        for (int y = 0; y < size(1); ++y)
            for (int x = 0; x < size(0); ++x) {
                auto& at = crossing[y * map_.size[0] + x];
                std::sort(at.begin(), at.end());
                for (int z = 0; z < size(2); ++z) {
                    const double height = place(x, y, z).z;
                    const auto below = std::lower_bound(at.begin(), at.end(), height) - at.begin();
                    const bool inside = at.size() % 2 == 0
                                            ? below % 2 == 1
                                            : winding_number(s_, place(x, y, z)) > 0.5;
                    if (inside)
                        map_.distance_m[index(x, y, z)] *= -1.0f;
                }
            }
    }

    void cross(std::uint32_t t, std::vector<std::vector<double>>& crossing) const {
        const auto [a, b, c] = corners(t);
        const dvec3 low = (glm::min(a, glm::min(b, c)) - map_.first_m) / map_.voxel_m;
        const dvec3 high = (glm::max(a, glm::max(b, c)) - map_.first_m) / map_.voxel_m;
        const dvec3 shift = map_.voxel_m * dvec3{1.7e-5, 2.9e-5, 0.0};
        const auto side = [](const dvec3& p, const dvec3& q) { return p.x * q.y - p.y * q.x; };
        for (int y = std::max(0, int(low.y) - 1); y <= std::min(size(1) - 1, int(high.y) + 1); ++y)
            for (int x = std::max(0, int(low.x) - 1); x <= std::min(size(0) - 1, int(high.x) + 1);
                 ++x) {
                const dvec3 at = place(x, y, 0) + shift;
                const dvec3 p = a - at, q = b - at, r = c - at;
                const double u = side(q, r), v = side(r, p), w = side(p, q);
                if ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))
                    crossing[y * map_.size[0] + x].push_back((u * a.z + v * b.z + w * c.z) /
                                                             (u + v + w));
            }
    }

    const RigidSurface& s_;
    VoxelMap& map_;
    std::vector<std::uint32_t> nearest_;
};

} // namespace

VoxelMap make_voxel_map(const RigidSurface& surface, double voxel_m, std::size_t most_bytes) {
    const auto fail = [&](const std::string& what) {
        throw std::invalid_argument("voxel map of " + surface.name + ": " + what);
    };
    if (!surface.closed)
        fail("the surface is open");
    if (!(voxel_m > 0.0))
        fail("the voxel must be above 0");
    dvec3 low{std::numeric_limits<double>::infinity()}, high{-low};
    for (const dvec3& v : surface.vertex_m) {
        low = glm::min(low, v);
        high = glm::max(high, v);
    }
    VoxelMap map{.voxel_m = voxel_m, .first_m = low - kMarginVoxels * voxel_m};
    const dvec3 nodes = glm::ceil((high - low) / voxel_m + 2.0 * kMarginVoxels) + 1.0;
    const double bytes = 4.0 * nodes.x * nodes.y * nodes.z;
    if (!(bytes <= static_cast<double>(most_bytes)))
        fail(std::to_string(bytes) + " bytes are needed, more than " + std::to_string(most_bytes) +
             "; a voxel of " +
             std::to_string(1e3 * voxel_m * std::cbrt(bytes / static_cast<double>(most_bytes))) +
             " mm would do");
    for (int i = 0; i < 3; ++i)
        map.size[i] = static_cast<std::uint32_t>(nodes[i]);
    map.distance_m.resize(static_cast<std::size_t>(map.size[0]) * map.size[1] * map.size[2]);
    Builder(surface, map).run();
    return map;
}

VoxelDistance distance_at(const VoxelMap& map, const dvec3& place_m) noexcept {
    const dvec3 at = (place_m - map.first_m) / map.voxel_m;
    std::array<std::size_t, 3> cell{};
    dvec3 part{0.0};
    for (int i = 0; i < 3; ++i) {
        if (!(at[i] >= 0.0 && at[i] < map.size[i] - 1.0))
            return {};
        cell[i] = static_cast<std::size_t>(at[i]);
        part[i] = at[i] - static_cast<double>(cell[i]);
    }
    const std::size_t row = map.size[0], layer = row * map.size[1];
    const float* d = &map.distance_m[cell[2] * layer + cell[1] * row + cell[0]];
    // along x, then y, then z; differences beside
    const auto mix = [](double low, double high, double share) {
        return low + share * (high - low);
    };
    const double x00 = mix(d[0], d[1], part.x), x10 = mix(d[row], d[row + 1], part.x);
    const double x01 = mix(d[layer], d[layer + 1], part.x);
    const double x11 = mix(d[layer + row], d[layer + row + 1], part.x);
    const double y0 = mix(x00, x10, part.y), y1 = mix(x01, x11, part.y);
    const double dx0 = mix(d[1] - d[0], d[row + 1] - d[row], part.y);
    const double dx1 = mix(d[layer + 1] - d[layer], d[layer + row + 1] - d[layer + row], part.y);
    return {.distance_m = mix(y0, y1, part.z),
            .gradient = dvec3{mix(dx0, dx1, part.z), mix(x10 - x00, x11 - x01, part.z), y1 - y0} /
                        map.voxel_m};
}

} // namespace haptics
