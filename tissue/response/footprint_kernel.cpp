// tissue/response/footprint_kernel.cpp
// The sample points of a contact kernel on a body. Bake time, any thread.
#include "tissue/response/footprint_kernel.h"

#include "tissue/response/layer_theory.h"

#include <algorithm>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

namespace tissue {
namespace {

using glm::dvec3;
using std::numbers::pi;

constexpr double kFacing = 0.4;        // cos 66 deg: turned further, it is another side
constexpr double kPunchRatio = 1.3175; // 2.0695 / (pi/2): keeps the sub-grid term positive
constexpr double kResolved = 0.5;
constexpr int kEdgeDirections = 24; // finds a straight edge to within 1 %
constexpr int kEdgeSteps = 4;
constexpr int kEdgeBisections = 8;

// Carries `point` along the normal onto the side of the body that faces the same way.
std::optional<BoundaryPoint> carry(const BoundaryTree& tree, const dvec3& point,
                                   const dvec3& normal, double reach_m) {
    std::optional<BoundaryPoint> best;
    for (const BoundaryPoint& hit : line_hits(tree, point, normal, -reach_m, reach_m)) {
        if (glm::dot(tree.normal[hit.triangle], normal) > kFacing &&
            (!best || std::abs(hit.distance_m) < std::abs(best->distance_m)))
            best = hit;
    }
    return best;
}

// Below a wall that rises out of a concave corner the tangent plane runs inside the body: no edge.
bool inside(const BoundaryTree& tree, const dvec3& point, const dvec3& normal) {
    const double far = 2.0 * glm::length(tree.box[0].high - tree.box[0].low);
    const auto hits = line_hits(tree, point, normal, 0.0, far);
    return !hits.empty() && glm::dot(tree.normal[hits.front().triangle], normal) > 0.0;
}

} // namespace

glm::dmat3 tangent_frame(const dvec3& normal) {
    // the axis least along the normal
    const dvec3 size = glm::abs(normal);
    const dvec3 axis = size.x <= size.y && size.x <= size.z ? dvec3{1, 0, 0}
                       : size.y <= size.z                   ? dvec3{0, 1, 0}
                                                            : dvec3{0, 0, 1};
    const dvec3 tangent = glm::normalize(axis - glm::dot(axis, normal) * normal);
    return {tangent, glm::cross(normal, tangent), normal};
}

// int f k dA over u = rho^2 is int f 2 (1-u) du: Gauss points in u.
std::vector<KernelSample> kernel_samples(const BoundaryTree& tree, const dvec3& centre_m,
                                         const dvec3& normal, double radius_m, double reach_m,
                                         int rings) {
    const QuadratureRule rule = gauss_legendre(rings); // on [-1, 1]
    const glm::dmat3 frame = tangent_frame(normal);
    std::vector<KernelSample> samples;
    double kept = 0.0;
    for (int ring = 0; ring < rings; ++ring) {
        const double u = 0.5 * (1.0 + rule.point[ring]);
        const int points = 6 * (ring + 1);
        const double share = rule.weight[ring] * (1.0 - u) / points;
        for (int k = 0; k < points; ++k) {
            const double angle = 2.0 * pi * (k + (ring % 2 == 1 ? 0.5 : 0.0)) / points;
            const dvec3 point =
                centre_m +
                radius_m * std::sqrt(u) * (std::cos(angle) * frame[0] + std::sin(angle) * frame[1]);
            if (const auto at = carry(tree, point, normal, reach_m)) {
                samples.push_back({*at, share});
                kept += samples.back().share;
            }
        }
    }
    if (samples.empty())
        return {{nearest_point(tree, centre_m), 1.0}};
    for (KernelSample& sample : samples)
        sample.share /= kept;
    return samples;
}

BoundaryPoint point_below(const BoundaryTree& tree, const dvec3& place_m, const dvec3& normal,
                          double reach_m) {
    const auto at = carry(tree, place_m, normal, reach_m);
    return at ? *at : nearest_point(tree, place_m);
}

double kernel_reach_m(double size_m, const FootprintOptions& options) {
    return std::max(kPunchRatio * options.tip_radius_max_m, options.size_factor * size_m);
}

double kernel_radius_m(const BoundaryTree& tree, const dvec3& centre_m, const dvec3& normal,
                       double size_m, const FootprintOptions& options) {
    const double least = kPunchRatio * options.tip_radius_max_m;
    const double reach = kernel_reach_m(size_m, options);
    const glm::dmat3 frame = tangent_frame(normal);
    double edge_m = reach;
    for (int k = 0; k < kEdgeDirections; ++k) {
        const double angle = 2.0 * pi * k / kEdgeDirections;
        const dvec3 away = std::cos(angle) * frame[0] + std::sin(angle) * frame[1];
        const auto on_body = [&](double distance) {
            const dvec3 point = centre_m + distance * away;
            return carry(tree, point, normal, reach) || inside(tree, point, normal);
        };
        for (int step = 1; step <= kEdgeSteps; ++step) {
            double low = edge_m * (step - 1) / kEdgeSteps, high = edge_m * step / kEdgeSteps;
            if (on_body(high))
                continue;
            for (int i = 0; i < kEdgeBisections; ++i) {
                const double middle = 0.5 * (low + high);
                (on_body(middle) ? low : high) = middle;
            }
            edge_m = low;
            break;
        }
    }
    // below half the nodal size not even quadratic tetrahedra see the kernel's own dimple
    edge_m = std::max(edge_m, kResolved * size_m);
    return std::max(least, std::min(options.size_factor * size_m, edge_m));
}

std::vector<dvec3> vertex_normals(std::span<const dvec3> position_m,
                                  std::span<const Triangle> triangles) {
    std::vector<dvec3> normal(position_m.size(), dvec3{0.0});
    for (const auto& [i, j, k] : triangles) {
        const dvec3 area = glm::cross(position_m[j] - position_m[i], position_m[k] - position_m[i]);
        normal[i] += area;
        normal[j] += area;
        normal[k] += area;
    }
    for (dvec3& n : normal) {
        const double length = glm::length(n);
        n = length > 0.0 ? n / length : dvec3{0.0};
    }
    return normal;
}

} // namespace tissue
