#include "assets/bake/import/holes.h"

#include <algorithm>
#include <limits>

namespace bake {
namespace {

constexpr std::size_t kLongestRim = 200; // the table is quadratic, the work cubic

double triangle_area(const Surface& s, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const glm::dvec3 p = s.point_m[a];
    return 0.5 * glm::length(glm::cross(s.point_m[b] - p, s.point_m[c] - p));
}

/// cost(i, k): least area of the polygon rim[i..k].
void least_patch(const Surface& s, Hole& hole) {
    const std::size_t n = hole.rim.size();
    std::vector<double> cost(n * n, 0.0);
    std::vector<std::size_t> middle(n * n, 0);
    for (std::size_t span = 2; span < n; ++span) {
        for (std::size_t i = 0; i + span < n; ++i) {
            const std::size_t k = i + span;
            double best = std::numeric_limits<double>::max();
            for (std::size_t j = i + 1; j < k; ++j) {
                const double c = cost[i * n + j] + cost[j * n + k] +
                                 triangle_area(s, hole.rim[i], hole.rim[j], hole.rim[k]);
                if (c < best) {
                    best = c;
                    middle[i * n + k] = j;
                }
            }
            cost[i * n + k] = best;
        }
    }
    hole.area_m2 = cost[n - 1];
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, n - 1}};
    while (!open.empty()) {
        const auto [i, k] = open.back();
        open.pop_back();
        if (k < i + 2) {
            continue;
        }
        const std::size_t j = middle[i * n + k];
        hole.patch.push_back({hole.rim[i], hole.rim[j], hole.rim[k]});
        open.emplace_back(i, j);
        open.emplace_back(j, k);
    }
}

/// Area of a cone over the rim, as an estimate where the best patch is too dear to find.
void cone_area(const Surface& s, Hole& hole) {
    for (std::size_t i = 0; i < hole.rim.size(); ++i) {
        const glm::dvec3 a = s.point_m[hole.rim[i]] - hole.centre_m;
        const glm::dvec3 b = s.point_m[hole.rim[(i + 1) % hole.rim.size()]] - hole.centre_m;
        hole.area_m2 += 0.5 * glm::length(glm::cross(a, b));
    }
}

} // namespace

std::vector<Hole> find_holes(const Surface& s, const Topology& topology) {
    // the open half edge that begins at each point: one at most, because fans have their own points
    std::vector<std::int64_t> open_from(s.point_m.size(), -1);
    for (std::size_t h = 0; h < topology.twin.size(); ++h) {
        if (topology.twin[h] < 0) {
            open_from[from_point(s, h)] = static_cast<std::int64_t>(h);
        }
    }
    std::vector<Hole> holes;
    for (std::size_t start = 0; start < topology.twin.size(); ++start) {
        if (topology.twin[start] >= 0 || open_from[from_point(s, start)] < 0) {
            continue;
        }
        Hole hole;
        hole.triangle = static_cast<std::uint32_t>(start / 3);
        std::uint32_t at = from_point(s, start);
        while (open_from[at] >= 0) {
            hole.rim.push_back(at);
            hole.centre_m += s.point_m[at];
            const auto half = static_cast<std::size_t>(open_from[at]);
            open_from[at] = -1;
            const std::uint32_t next = to_point(s, half);
            hole.length_m += glm::length(s.point_m[next] - s.point_m[at]);
            at = next;
        }
        hole.centre_m /= static_cast<double>(hole.rim.size());
        std::reverse(hole.rim.begin(), hole.rim.end()); // the patch runs against the rim's edges
        if (hole.rim.size() >= 3 && hole.rim.size() <= kLongestRim) {
            least_patch(s, hole);
        } else {
            cone_area(s, hole);
        }
        holes.push_back(std::move(hole));
    }
    std::stable_sort(holes.begin(), holes.end(),
                     [](const Hole& a, const Hole& b) { return a.area_m2 > b.area_m2; });
    return holes;
}

} // namespace bake
