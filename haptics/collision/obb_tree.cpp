#include "haptics/collision/obb_tree.h"

#include "haptics/collision/principal_axes.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <numeric>

namespace haptics {
namespace {

using glm::dvec3;
using Box = ObbTree::Box;

constexpr std::uint32_t kLeafSize = 2;
constexpr std::uint32_t kFairShare = 8; // neither half has less than an eighth

struct Setup {
    const MeshView& mesh;
    ObbTree& tree;

    void list_corners(std::span<const std::uint32_t> triangle) {
        const auto first = static_cast<std::ptrdiff_t>(tree.corner.size());
        for (const std::uint32_t t : triangle)
            tree.corner.insert(tree.corner.end(), mesh.triangle[t].begin(), mesh.triangle[t].end());
        std::sort(tree.corner.begin() + first, tree.corner.end());
        tree.corner.erase(std::unique(tree.corner.begin() + first, tree.corner.end()),
                          tree.corner.end());
    }

    double along(std::uint32_t t, const SurfaceSpread& spread, int axis) const {
        const auto [a, b, c] = mesh.corners(t);
        return glm::dot((a + b + c) / 3.0 - spread.mean_m, spread.axes[axis]);
    }

    /// Parts `order` at the mean of the surface along its longest axis at which that is fair, else
    /// at the median along the first. Ties by number: the same tree from any library.
    std::uint32_t part(std::span<std::uint32_t> order, const SurfaceSpread& spread) const {
        const auto count = static_cast<std::uint32_t>(order.size());
        for (int k = 0; k < 3; ++k) {
            const auto middle =
                std::stable_partition(order.begin(), order.end(),
                                      [&](std::uint32_t t) { return along(t, spread, k) < 0.0; });
            const auto left = static_cast<std::uint32_t>(middle - order.begin());
            if (left >= std::max(1u, count / kFairShare) &&
                count - left >= std::max(1u, count / kFairShare))
                return left;
        }
        std::nth_element(order.begin(), order.begin() + count / 2, order.end(),
                         [&](std::uint32_t a, std::uint32_t b) {
                             const double x = along(a, spread, 0), y = along(b, spread, 0);
                             return x != y ? x < y : a < b;
                         });
        return count / 2;
    }

    void split(std::span<std::uint32_t> order, std::uint32_t first) {
        const auto at = static_cast<std::uint32_t>(tree.box.size());
        const SurfaceSpread spread = surface_spread(mesh, order);
        tree.box.push_back({.axes = spread.axes,
                            .first = first,
                            .first_corner = static_cast<std::uint32_t>(tree.corner.size())});
        list_corners(order);
        if (order.size() <= kLeafSize) {
            tree.box[at].count = static_cast<std::uint32_t>(order.size());
        } else {
            const std::uint32_t left = part(order, spread);
            split(order.first(left), first);
            split(order.subspan(left), first + left);
        }
        tree.box[at].after = static_cast<std::uint32_t>(tree.box.size());
    }
};

} // namespace

ObbTree make_obb_tree(const MeshView& mesh) {
    std::vector<std::uint32_t> all(mesh.triangle.size());
    std::iota(all.begin(), all.end(), 0u);
    return make_obb_tree(mesh, all);
}

ObbTree make_obb_tree(const MeshView& mesh, std::span<const std::uint32_t> triangle) {
    ObbTree tree;
    tree.triangle.assign(triangle.begin(), triangle.end());
    if (triangle.empty())
        return tree;
    Setup setup{.mesh = mesh, .tree = tree};
    setup.split(tree.triangle, 0);
    tree.box.push_back({.first_corner = static_cast<std::uint32_t>(tree.corner.size())});
    refit(tree, mesh);
    return tree;
}

void refit(ObbTree& tree, const MeshView& mesh) noexcept {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    tree.largest_m = 0.0;
    for (std::uint32_t at = 0; at < tree.boxes(); ++at) {
        Box& box = tree.box[at];
        const std::uint32_t end = tree.box[at + 1].first_corner;
        dvec3 low{kInfinity}, high{-kInfinity}, origin{0.0};
        bool first = true;
        const auto add = [&](const dvec3& place) {
            if (!std::isfinite(place.x + place.y + place.z))
                return;
            origin = first ? place : origin;
            first = false;
            const dvec3 p = (place - origin) * box.axes;
            low = glm::min(low, p);
            high = glm::max(high, p);
        };
        for (std::uint32_t i = box.first_corner; i < end; ++i) {
            add(mesh.vertex_m[tree.corner[i]]);
            if (!mesh.before_m.empty())
                add(mesh.before_m[tree.corner[i]]);
        }
        box.centre_m = origin + box.axes * (0.5 * (low + high));
        box.half_m = 0.5 * (high - low);
        if (at == 0 && !first) {
            const dvec3 far = glm::abs(box.centre_m) + glm::length(box.half_m);
            tree.largest_m = std::max({far.x, far.y, far.z});
        }
    }
}

} // namespace haptics
