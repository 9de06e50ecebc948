#include "assets/bake/import/size_field.h"

#include "assets/bake/nearest.h"
#include "assets/bake/remesh.h"

#include <algorithm>
#include <cmath>

namespace bake {
namespace {

constexpr double kRadiiPerEdge = 1.8;     // of curvature
constexpr double kThicknessPerEdge = 1.2; // one layer of tetrahedra through a thin place
constexpr double kCurvedShare = 0.5, kThinShare = 0.25; // of the edge, at least
constexpr int kShrinks = 12;
constexpr double kApart = 0.5; // cosine: the ball is held from the side, not by curvature

double ball_m(const NearestOnSurface& nearest, const glm::dvec3& p, const glm::dvec3& inward,
              double most_m) {
    double radius_m = 0.5 * most_m;
    glm::dvec3 held = p;
    for (int i = 0; i < kShrinks; ++i) {
        const glm::dvec3 centre = p + radius_m * inward;
        const auto near = nearest(centre);
        if (near.distance_m >= radius_m * (1.0 - 1e-6)) {
            break;
        }
        const glm::dvec3 d = near.point_m - p;
        const double along = glm::dot(d, inward);
        if (along <= 1e-3 * glm::length(d)) {
            break; // beside p on the same sheet
        }
        held = near.point_m;
        radius_m = glm::dot(d, d) / (2.0 * along);
    }
    const glm::dvec3 centre = p + radius_m * inward;
    const double cosine = glm::dot(p - centre, held - centre) / (radius_m * radius_m);
    return held == p || cosine > kApart ? most_m : std::min(most_m, 2.0 * radius_m);
}

} // namespace

double edge_for_nodes(double volume_m3, double area_m2, double nodes) {
    const auto count = [&](double h) {
        return area_m2 / (0.5 * std::sqrt(3.0) * h * h) +
               std::max(0.0, volume_m3 - 0.5 * h * area_m2) * std::sqrt(2.0) / (h * h * h);
    };
    double low = 1e-5, high = 1.0; // falls with h
    for (int i = 0; i < 60; ++i) {
        const double middle = std::sqrt(low * high);
        (count(middle) > nodes ? low : high) = middle;
    }
    return high;
}

std::vector<double> thickness_m(const Surface& s, double most_m) {
    const NearestOnSurface nearest(s);
    const auto normal = vertex_normals(s);
    std::vector<double> thickness(s.point_m.size(), most_m);
    for (std::size_t v = 0; v < thickness.size(); ++v) {
        thickness[v] = std::min(ball_m(nearest, s.point_m[v], -normal[v], most_m),
                                ball_m(nearest, s.point_m[v], normal[v], most_m));
    }
    return thickness;
}

SizeAt shape_size(const Surface& s, double edge_m) {
    std::vector<double> size = thickness_m(s, edge_m / kThicknessPerEdge);
    for (double& m : size) {
        m = std::clamp(kThicknessPerEdge * m, kThinShare * edge_m, edge_m);
    }
    const SizeAt thin = graded_size(s, std::move(size));
    const SizeAt curved = curvature_size(s, edge_m, kRadiiPerEdge, kCurvedShare);
    return [thin, curved](const glm::dvec3& p) { return std::min(thin(p), curved(p)); };
}

} // namespace bake
