// haptics/collision/cell_walk.h
// Which occupied cells of a grid meet a reach, the nearer first: along thin segments cell by cell
// (Amanatides, Woo 1987, A Fast Voxel Traversal Algorithm), along thick ones layer by layer,
// around a point shell by shell. If that would be more cells than are occupied, all of those.
#pragma once

#include "haptics/collision/cell_table.h"
#include "haptics/collision/reach.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace haptics {

namespace cell_walk {

inline bool finite(const Reach& reach) noexcept {
    const glm::dvec3 sum = reach.from_m + reach.to_m;
    return std::isfinite(sum.x + sum.y + sum.z + reach.radius_m);
}

/// Roundings of the coordinates, by which a reach is made thicker.
inline double slack_m(double largest_m, const Reach& reach) noexcept {
    const glm::dvec3 far = glm::max(glm::abs(reach.from_m), glm::abs(reach.to_m));
    return 64.0 * std::numeric_limits<double>::epsilon() *
           std::max({largest_m, far.x, far.y, far.z});
}

inline std::int32_t along(const CellTable& t, int axis, double place_m) noexcept {
    return static_cast<std::int32_t>(
        std::clamp((place_m - t.low_m[axis]) / t.cell_m, 0.0, t.cells[axis] - 1.0));
}

/// Distance of a coordinate from a layer of cells; 0 inside.
inline double from_layer(const CellTable& t, int axis, std::int32_t at, double place_m) noexcept {
    const double low_m = t.low_m[axis] + at * t.cell_m;
    return std::max({low_m - place_m, place_m - low_m - t.cell_m, 0.0});
}

/// False: the reach, with `radius_m`, is all outside the grid.
inline bool range_of(const CellTable& t, const Reach& reach, double radius_m,
                     CellRange& out) noexcept {
    const glm::dvec3 low = glm::min(reach.from_m, reach.to_m) - radius_m;
    const glm::dvec3 high = glm::max(reach.from_m, reach.to_m) + radius_m;
    for (int k = 0; k < 3; ++k) {
        if (high[k] < t.low_m[k] || low[k] > t.low_m[k] + t.cells[k] * t.cell_m)
            return false;
        out.low[k] = along(t, k, low[k]);
        out.high[k] = along(t, k, high[k]);
    }
    return true;
}

template <class Visit>
void all_occupied(const CellTable& t, const Reach& reach, double slack, Visit& visit_cell) {
    CellRange r;
    for (std::uint32_t c = 0; c < t.occupied; ++c) {
        if (!range_of(t, reach, reach.radius_m + slack, r))
            return;
        const CellPlace p = place_of(t.cell[c].key);
        bool in = true;
        for (int k = 0; k < 3; ++k)
            in = in && p[k] >= r.low[k] && p[k] <= r.high[k];
        if (in)
            visit_cell(c);
    }
}

template <class Visit> void one(const CellTable& t, const CellPlace& p, Visit& visit_cell) {
    if (const std::uint32_t c = find_cell(t, p); c != t.occupied)
        visit_cell(c);
}

/// A segment thinner than the things are fattened by; roundings have the other half of that.
template <class Visit> void thin(const CellTable& t, const Reach& reach, Visit& visit_cell) {
    const glm::dvec3 d = reach.to_m - reach.from_m;
    const int longest = std::abs(d.x) >= std::abs(d.y) && std::abs(d.x) >= std::abs(d.z) ? 0
                        : std::abs(d.y) >= std::abs(d.z)                                 ? 1
                                                                                         : 2;
    double enter = 0.0, leave = 1.0; // of the grid
    for (int k = 0; k < 3; ++k) {
        if (d[k] == 0.0)
            continue;
        const double a = (t.low_m[k] - reach.from_m[k]) / d[k];
        const double b = (t.low_m[k] + t.cells[k] * t.cell_m - reach.from_m[k]) / d[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    if (enter > leave)
        return;
    CellPlace at{}, step{};
    std::array<double, 3> next{}, stride{}; // where along the segment the next cell begins
    for (int k = 0; k < 3; ++k) {
        at[k] = along(t, k, reach.from_m[k] + enter * d[k]);
        step[k] = d[k] > 0.0 ? 1 : -1;
        const double wall = t.low_m[k] + (at[k] + (d[k] > 0.0)) * t.cell_m;
        constexpr double kNever = std::numeric_limits<double>::infinity();
        next[k] = d[k] != 0.0 ? (wall - reach.from_m[k]) / d[k] : kNever;
        stride[k] = d[k] != 0.0 ? t.cell_m / std::abs(d[k]) : kNever;
    }
    for (;;) {
        one(t, at, visit_cell);
        const int k = next[0] <= next[1] && next[0] <= next[2] ? 0 : next[1] <= next[2] ? 1 : 2;
        // what the segment was shortened to
        const double end =
            d[longest] != 0.0 ? (reach.to_m[longest] - reach.from_m[longest]) / d[longest] : 0.0;
        if (!(next[k] <= std::min(leave, end)))
            return;
        at[k] += step[k];
        if (at[k] < 0 || at[k] >= t.cells[k])
            return;
        next[k] += stride[k];
    }
}

/// Around a point, the cells at a distance of 0, 1, 2 ... cells, until the reach ends before them.
template <class Visit>
void shells(const CellTable& t, const Reach& reach, double slack, Visit& visit_cell) {
    const glm::dvec3& p = reach.from_m;
    CellPlace middle;
    double wall_m = t.cell_m; // from the point of the grid nearest to p to the walls of its cell
    std::int32_t last = 0;
    for (int k = 0; k < 3; ++k) {
        middle[k] = along(t, k, p[k]);
        const double in = std::clamp(p[k] - t.low_m[k] - middle[k] * t.cell_m, 0.0, t.cell_m);
        wall_m = std::min({wall_m, in, t.cell_m - in});
        last = std::max({last, middle[k], t.cells[k] - 1 - middle[k]});
    }
    std::uint64_t seen = 0;
    for (std::int32_t s = 0; s <= last; ++s) {
        if (s > 0 && (s - 1) * t.cell_m + wall_m > reach.radius_m + slack)
            return;
        CellRange r;
        if (!range_of(t, reach, reach.radius_m + slack, r))
            return;
        if (seen > t.occupied)
            return all_occupied(t, reach, slack, visit_cell);
        for (int k = 0; k < 3; ++k) {
            r.low[k] = std::max(r.low[k], middle[k] - s);
            r.high[k] = std::min(r.high[k], middle[k] + s);
        }
        CellPlace c;
        for (c[2] = r.low[2]; c[2] <= r.high[2]; ++c[2]) {
            const double z = from_layer(t, 2, c[2], p.z);
            for (c[1] = r.low[1]; c[1] <= r.high[1]; ++c[1]) {
                const double y = from_layer(t, 1, c[1], p.y), yz2 = y * y + z * z;
                ++seen;
                const bool whole =
                    std::abs(c[2] - middle[2]) == s || std::abs(c[1] - middle[1]) == s;
                for (c[0] = whole ? r.low[0] : middle[0] - s; c[0] <= r.high[0];
                     c[0] += whole || s == 0 ? 1 : 2 * s) {
                    const double x = from_layer(t, 0, c[0], p.x), far = reach.radius_m + slack;
                    if (c[0] < r.low[0] || x * x + yz2 > far * far)
                        continue;
                    ++seen;
                    one(t, c, visit_cell);
                }
            }
        }
    }
}

/// A thick segment: layers across its longest axis, of each the rectangle that it may meet.
template <class Visit>
void layers(const CellTable& t, const Reach& reach, double slack, int axis, Visit& visit_cell) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const bool up = reach.to_m[axis] >= reach.from_m[axis];
    CellRange r;
    if (!range_of(t, reach, reach.radius_m + slack, r))
        return;
    std::uint64_t seen = 0;
    for (std::int32_t at = up ? r.low[axis] : r.high[axis]; at >= r.low[axis] && at <= r.high[axis];
         at += up ? 1 : -1) {
        const double thick = reach.radius_m + slack;
        const glm::dvec3 d = reach.to_m - reach.from_m;
        const double low_m = t.low_m[axis] + at * t.cell_m - thick - reach.from_m[axis],
                     high_m = low_m + t.cell_m + 2.0 * thick;
        const double a = d[axis] != 0.0 ? low_m / d[axis] : 0.0,
                     b = d[axis] != 0.0 ? high_m / d[axis] : 1.0;
        const double enter = std::max(std::min(a, b), 0.0), leave = std::min(std::max(a, b), 1.0);
        if (enter > 1.0)
            return; // shortened
        if (seen > t.occupied)
            return all_occupied(t, reach, slack, visit_cell);
        const glm::dvec3 p = reach.from_m + enter * d, q = reach.from_m + leave * d;
        CellPlace c{};
        c[axis] = at;
        const std::int32_t last_u = along(t, u, std::max(p[u], q[u]) + thick),
                           last_v = along(t, v, std::max(p[v], q[v]) + thick);
        for (c[u] = along(t, u, std::min(p[u], q[u]) - thick); c[u] <= last_u; ++c[u])
            for (c[v] = along(t, v, std::min(p[v], q[v]) - thick); c[v] <= last_v; ++c[v]) {
                ++seen;
                one(t, c, visit_cell);
            }
    }
}

} // namespace cell_walk

/// Calls visit_cell(number) for the occupied cells that the reach meets, some more than once.
template <class Visit> void walk_cells(const CellTable& t, const Reach& reach, Visit&& visit_cell) {
    if (t.occupied == 0 || !cell_walk::finite(reach))
        return;
    const double slack = cell_walk::slack_m(t.largest_m, reach);
    const glm::dvec3 d = glm::abs(reach.to_m - reach.from_m);
    if (reach.radius_m + slack <= 0.5 * t.fat_m) {
        if ((d.x + d.y + d.z) / t.cell_m > t.occupied)
            return cell_walk::all_occupied(t, reach, slack, visit_cell);
        return cell_walk::thin(t, reach, visit_cell);
    }
    if (d.x + d.y + d.z == 0.0)
        return cell_walk::shells(t, reach, slack, visit_cell);
    cell_walk::layers(t, reach, slack,
                      d.x >= d.y && d.x >= d.z ? 0
                      : d.y >= d.z             ? 1
                                               : 2,
                      visit_cell);
}

} // namespace haptics
