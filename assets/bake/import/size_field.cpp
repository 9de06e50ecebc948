#include "assets/bake/import/size_field.h"

#include "assets/bake/edge_for_nodes.h"
#include "assets/bake/nearest.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bake {
namespace {

constexpr double kThicknessPerEdge = 1.5; // one layer of tetrahedra through a thin place
constexpr double kCurvedShare = 0.35, kThinShare = 0.25; // of the edge, at least
constexpr double kCreaseDeg = 45.0, kTipDeg = 180.0;
constexpr double kMostCreases = 0.3;   // length of creases times the skin's edge, over area
constexpr double kMostDangling = 0.05; // share of crease points where one crease ends
constexpr int kSmoothings = 4;
constexpr int kShrinks = 12;
constexpr double kFarSide = -0.3; // cosine at the ball's centre

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
    return held == p || cosine > kFarSide ? most_m : std::min(most_m, 2.0 * radius_m);
}

/// Creases of every point.
std::vector<int> count_creases(const Surface& s, double crease_deg, double& length_m) {
    std::vector<int> count(s.point_m.size(), 0);
    length_m = 0.0;
    if (crease_deg >= 180.0) {
        return count;
    }
    const HalfEdgeMesh mesh = make_half_edges(s);
    for (const auto e : mesh.edges()) {
        const auto h = mesh.halfedge_handle(e, 0);
        if (std::abs(mesh.calc_dihedral_angle(h)) > crease_deg * std::numbers::pi / 180.0) {
            ++count[static_cast<std::size_t>(mesh.from_vertex_handle(h).idx())];
            ++count[static_cast<std::size_t>(mesh.to_vertex_handle(h).idx())];
            length_m += mesh.calc_edge_length(e);
        }
    }
    return count;
}

/// Points to the middle of their neighbours, half the way; points on creases stay.
Surface smoothed(Surface s, const std::vector<int>& creases) {
    for (int round = 0; round < kSmoothings; ++round) {
        std::vector<glm::dvec3> sum(s.point_m.size(), glm::dvec3{0.0});
        std::vector<double> count(s.point_m.size(), 0.0);
        for (const auto& t : s.triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                sum[t[k]] += s.point_m[t[(k + 1) % 3]];
                count[t[k]] += 1.0;
            }
        }
        for (std::size_t v = 0; v < s.point_m.size(); ++v) {
            if (count[v] > 0.0 && creases[v] == 0) {
                s.point_m[v] = 0.5 * (s.point_m[v] + sum[v] / count[v]);
            }
        }
    }
    return s;
}

/// Smallest radius of curvature at every point, along the edges; none at creases.
std::vector<double> radius_m(const Surface& s, const std::vector<int>& creases, double most_m) {
    const auto normal = vertex_normals(s);
    std::vector<double> radius(s.point_m.size(), most_m);
    for (const auto& t : s.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = t[k], b = t[(k + 1) % 3];
            const double bend = glm::length(normal[b] - normal[a]);
            if (creases[a] > 0 || creases[b] > 0 || bend == 0.0) {
                continue;
            }
            const double r = glm::length(s.point_m[b] - s.point_m[a]) / bend;
            radius[a] = std::min(radius[a], r);
            radius[b] = std::min(radius[b], r);
        }
    }
    return radius;
}

} // namespace

RemeshOptions edges_to_keep(const Surface& s, double skin_m) {
    double length_m = 0.0;
    const auto creases = count_creases(s, kCreaseDeg, length_m);
    std::size_t on = 0, dangling = 0;
    for (const int count : creases) {
        on += count > 0 ? 1 : 0;
        dangling += count == 1 ? 1 : 0;
    }
    const bool clear = static_cast<double>(dangling) <= kMostDangling * static_cast<double>(on) &&
                       length_m * skin_m <= kMostCreases * area_m2(s);
    return {.crease_deg = clear ? kCreaseDeg : 180.0, .tip_deg = kTipDeg};
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

SizeAt shape_size(const Surface& skin, double edge_m, double radii_per_edge,
                  const RemeshOptions& keep) {
    double ignored = 0.0;
    const auto creases = count_creases(skin, keep.crease_deg, ignored);
    const Surface smooth = smoothed(skin, creases);
    std::vector<double> size = thickness_m(smooth, edge_m / kThicknessPerEdge);
    const auto radius = radius_m(smooth, creases, edge_m / radii_per_edge);
    for (std::size_t v = 0; v < size.size(); ++v) {
        const double thin = std::max(kThicknessPerEdge * size[v], kThinShare * edge_m);
        const double curved = std::max(radii_per_edge * radius[v], kCurvedShare * edge_m);
        size[v] = std::min({thin, curved, edge_m});
    }
    return graded_size(skin, std::move(size));
}

double nodes_for(const Surface& skin, double volume_m3, const SizeAt& size) {
    double boundary = 0.0, area = 0.0, mean_m = 0.0;
    for (const auto& t : skin.triangles) {
        const glm::dvec3 a = skin.point_m[t[0]], b = skin.point_m[t[1]], c = skin.point_m[t[2]];
        const double m2 = 0.5 * glm::length(glm::cross(b - a, c - a));
        const double h = size((a + b + c) / 3.0);
        boundary += m2 / (0.5 * std::sqrt(3.0) * h * h);
        area += m2;
        mean_m += h * m2;
    }
    mean_m /= area;
    return boundary + nodes_for_edge(volume_m3, area, mean_m) -
           area / (0.5 * std::sqrt(3.0) * mean_m * mean_m);
}

} // namespace bake
