#include "assets/bake/nearest.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bake {
namespace {

constexpr int kMaxCellsPerAxis = 64;

struct Box {
    glm::dvec3 low{std::numeric_limits<double>::max()};
    glm::dvec3 high{std::numeric_limits<double>::lowest()};
    void add(const glm::dvec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
};

} // namespace

glm::dvec3 nearest_weights(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                           const glm::dvec3& c) {
    const glm::dvec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0) {
        return {1.0, 0.0, 0.0};
    }
    const glm::dvec3 bp = p - b;
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0.0 && d4 <= d3) {
        return {0.0, 1.0, 0.0};
    }
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        const double t = d1 / (d1 - d3);
        return {1.0 - t, t, 0.0};
    }
    const glm::dvec3 cp = p - c;
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0.0 && d5 <= d6) {
        return {0.0, 0.0, 1.0};
    }
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        const double t = d2 / (d2 - d6);
        return {1.0 - t, 0.0, t};
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0.0, 1.0 - t, t};
    }
    const double sum = va + vb + vc;
    return {va / sum, vb / sum, vc / sum};
}

NearestOnSurface::NearestOnSurface(const Surface& surface) : surface_(surface) {
    Box box;
    for (const auto& p : surface.point_m) {
        box.add(p);
    }
    const glm::dvec3 size = box.high - box.low;
    const double mean_edge_m =
        std::sqrt(2.0 * area_m2(surface) /
                  static_cast<double>(std::max<std::size_t>(surface.triangles.size(), 1)));
    const double longest_m = std::max({size.x, size.y, size.z, 1e-9});
    cell_m_ = std::max(mean_edge_m, longest_m / kMaxCellsPerAxis);
    low_m_ = box.low;
    for (int d = 0; d < 3; ++d) {
        count_[d] = static_cast<int>(size[d] / cell_m_) + 1;
    }

    // each triangle into all cells its box meets
    std::vector<std::vector<std::uint32_t>> cell(
        static_cast<std::size_t>(count_[0] * count_[1] * count_[2]));
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
        Box b;
        for (const auto v : surface.triangles[t]) {
            b.add(surface.point_m[v]);
        }
        const auto low = cell_of(b.low), high = cell_of(b.high);
        for (int k = low[2]; k <= high[2]; ++k) {
            for (int j = low[1]; j <= high[1]; ++j) {
                for (int i = low[0]; i <= high[0]; ++i) {
                    cell[static_cast<std::size_t>((k * count_[1] + j) * count_[0] + i)].push_back(
                        t);
                }
            }
        }
    }
    start_.push_back(0);
    for (const auto& list : cell) {
        triangle_.insert(triangle_.end(), list.begin(), list.end());
        start_.push_back(static_cast<std::uint32_t>(triangle_.size()));
    }
}

std::array<int, 3> NearestOnSurface::cell_of(const glm::dvec3& p) const {
    std::array<int, 3> at{};
    for (int d = 0; d < 3; ++d) {
        const double x = std::floor((p[d] - low_m_[d]) / cell_m_);
        at[d] = static_cast<int>(std::clamp(x, 0.0, static_cast<double>(count_[d] - 1)));
    }
    return at;
}

void NearestOnSurface::look_into(std::size_t cell, const glm::dvec3& p, NearestPoint& best) const {
    for (std::uint32_t i = start_[cell]; i < start_[cell + 1]; ++i) {
        const auto& t = surface_.triangles[triangle_[i]];
        const auto& x = surface_.point_m;
        const glm::dvec3 w = nearest_weights(p, x[t[0]], x[t[1]], x[t[2]]);
        const glm::dvec3 q = w.x * x[t[0]] + w.y * x[t[1]] + w.z * x[t[2]];
        const double distance = glm::length(p - q);
        if (distance < best.distance_m ||
            (distance == best.distance_m && triangle_[i] < best.triangle)) {
            best = {triangle_[i], w, q, distance};
        }
    }
}

NearestPoint NearestOnSurface::operator()(const glm::dvec3& p) const {
    NearestPoint best;
    best.distance_m = std::numeric_limits<double>::max();
    const auto centre = cell_of(p);
    // distance from p to the slab of cells `index` along one axis
    const auto gap_m = [&](int axis, int index) {
        const double low = low_m_[axis] + index * cell_m_;
        return std::max({low - p[axis], p[axis] - (low + cell_m_), 0.0});
    };
    // shells of cells around the cell of p, or around the nearest cell if p is outside the grid:
    // every cell of shell `ring` is at least (ring - 1) cells away
    const int last = std::max({count_[0], count_[1], count_[2]});
    for (int ring = 0; ring <= last && best.distance_m >= (ring - 1) * cell_m_; ++ring) {
        for (int z = std::max(centre[2] - ring, 0); z <= std::min(centre[2] + ring, count_[2] - 1);
             ++z) {
            for (int y = std::max(centre[1] - ring, 0);
                 y <= std::min(centre[1] + ring, count_[1] - 1); ++y) {
                const double gap_yz_m = std::hypot(gap_m(1, y), gap_m(2, z));
                if (gap_yz_m > best.distance_m) {
                    continue;
                }
                const bool side =
                    std::abs(z - centre[2]) == ring || std::abs(y - centre[1]) == ring;
                for (int i = -ring; i <= ring; i += side ? 1 : std::max(2 * ring, 1)) {
                    const int x = centre[0] + i;
                    if (x >= 0 && x < count_[0] &&
                        std::hypot(gap_m(0, x), gap_yz_m) <= best.distance_m) {
                        look_into(static_cast<std::size_t>((z * count_[1] + y) * count_[0] + x), p,
                                  best);
                    }
                }
            }
        }
    }
    return best;
}

double sampled_hausdorff_m(const Surface& from, const NearestOnSurface& to) {
    double worst_m = 0.0;
    const auto sample = [&](const glm::dvec3& p) { worst_m = std::max(worst_m, to(p).distance_m); };
    for (const auto& t : from.triangles) {
        const glm::dvec3 a = from.point_m[t[0]], b = from.point_m[t[1]], c = from.point_m[t[2]];
        for (const auto& p : {a, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (a + b + c) / 3.0}) {
            sample(p);
        }
    }
    return worst_m;
}

} // namespace bake
