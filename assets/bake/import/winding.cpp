#include "assets/bake/import/winding.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bake {
namespace {

constexpr double kFar = 2.3; // distance over radius from which a dipole stands for a node

/// Solid angle of a triangle over 4 pi (Van Oosterom & Strackee 1983).
double share_of_sphere(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double over = glm::dot(a, glm::cross(b, c));
    const double under =
        la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    return std::atan2(over, under) / (2.0 * std::numbers::pi);
}

double share_of_sphere(const Surface& s, std::size_t t, const glm::dvec3& p) {
    const auto& c = s.triangles[t];
    return share_of_sphere(s.point_m[c[0]] - p, s.point_m[c[1]] - p, s.point_m[c[2]] - p);
}

} // namespace

double winding_number(const Surface& s, const glm::dvec3& p) {
    double sum = 0.0;
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        sum += share_of_sphere(s, t, p);
    }
    return sum;
}

FastWinding::FastWinding(const Surface& s)
    : surface_(s), tree_(triangle_boxes(s), 8), dipole_(tree_.nodes().size()) {
    for (std::size_t n = 0; n < dipole_.size(); ++n) {
        const auto& node = tree_.nodes()[n];
        Dipole& dipole = dipole_[n];
        double weight = 0.0;
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const auto& c = s.triangles[tree_.items()[i]];
            const glm::dvec3 a = s.point_m[c[0]], b = s.point_m[c[1]], d = s.point_m[c[2]];
            const glm::dvec3 area = 0.5 * glm::cross(b - a, d - a);
            dipole.area_m2 += area;
            dipole.centre_m += glm::length(area) * (a + b + d) / 3.0;
            weight += glm::length(area);
        }
        dipole.centre_m = weight > 0.0 ? dipole.centre_m / weight : node.box.low;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 q{corner & 1 ? node.box.high.x : node.box.low.x,
                               corner & 2 ? node.box.high.y : node.box.low.y,
                               corner & 4 ? node.box.high.z : node.box.low.z};
            dipole.radius_m = std::max(dipole.radius_m, glm::length(q - dipole.centre_m));
        }
    }
}

double FastWinding::operator()(const glm::dvec3& p) const {
    double sum = 0.0;
    std::int32_t stack[64];
    int depth = 0;
    if (!dipole_.empty()) {
        stack[depth++] = 0;
    }
    while (depth > 0) {
        const auto n = static_cast<std::size_t>(stack[--depth]);
        const auto& node = tree_.nodes()[n];
        const Dipole& dipole = dipole_[n];
        const glm::dvec3 r = dipole.centre_m - p;
        const double distance_m = glm::length(r);
        if (distance_m > kFar * dipole.radius_m) {
            sum += glm::dot(r, dipole.area_m2) /
                   (4.0 * std::numbers::pi * distance_m * distance_m * distance_m);
        } else if (node.left < 0) {
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                sum += share_of_sphere(surface_, tree_.items()[i], p);
            }
        } else {
            stack[depth++] = node.right;
            stack[depth++] = node.left;
        }
    }
    return sum;
}

} // namespace bake
