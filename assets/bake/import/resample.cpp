#include "assets/bake/import/resample.h"

#include "assets/bake/import/winding.h"
#include "assets/bake/nearest.h"
#include "assets/bake/polygonise.h"

#include <algorithm>
#include <cmath>

namespace bake {
namespace {

constexpr double kMostCells = 2e6;
constexpr double kBand = 2.0; // cells from the surface where distance matters

} // namespace

void find_seen(const Surface& given, double cell_m, Resampled& result) {
    const FastWinding winding(given);
    double all_m2 = 0.0, hidden_m2 = 0.0;
    result.seen.point_m = given.point_m;
    for (const auto& t : given.triangles) {
        const glm::dvec3 a = given.point_m[t[0]], b = given.point_m[t[1]], c = given.point_m[t[2]];
        const glm::dvec3 n = glm::cross(b - a, c - a);
        const double twice = glm::length(n);
        if (twice == 0.0) {
            continue;
        }
        all_m2 += 0.5 * twice;
        const glm::dvec3 middle = (a + b + c) / 3.0, off = (0.5 * cell_m / twice) * n;
        const bool in = winding(middle - off) > 0.5, out = winding(middle + off) < 0.5;
        if (in && out) {
            result.seen.triangles.push_back(t);
        } else {
            hidden_m2 += 0.5 * twice;
        }
    }
    result.hidden_share = all_m2 > 0.0 ? hidden_m2 / all_m2 : 0.0;
}

Resampled resample(const Surface& given, double cell_m) {
    Box box = box_of(given);
    const glm::dvec3 size = box.high - box.low;
    const double cells = size.x / cell_m * (size.y / cell_m) * (size.z / cell_m);
    cell_m *= std::cbrt(std::max(1.0, cells / kMostCells));
    const glm::dvec3 rim{2.5 * cell_m};

    const FastWinding winding(given);
    const NearestOnSurface nearest(given);
    const BoxTree tree(triangle_boxes(given));
    const double reach_m = kBand * cell_m;
    const auto field = [&](const glm::dvec3& p) {
        const double w = winding(p) - 0.5;
        Box near;
        near.add(p - reach_m);
        near.add(p + reach_m);
        bool close = false;
        tree.visit(near, [&](std::uint32_t) { close = true; });
        double distance_m = close ? std::min(nearest(p).distance_m, reach_m) : reach_m;
        // over an open seam the winding number changes slowly and says where the surface would be
        distance_m = std::min(distance_m, 2.0 * std::abs(w) * reach_m);
        return w > 0.0 ? -distance_m : distance_m;
    };
    Resampled result;
    result.surface = polygonise(field, box.low - rim, box.high + rim, cell_m);
    find_seen(given, cell_m, result);
    return result;
}

} // namespace bake
