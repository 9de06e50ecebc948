#include "assets/bake/import/weld.h"

#include "assets/bake/import/box_tree.h"
#include "assets/bake/import/topology.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>

namespace bake {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

std::uint64_t mix(const glm::dvec3& p) {
    std::uint64_t hash = 0;
    for (int d = 0; d < 3; ++d) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(p[d])) * 0x9E3779B97F4A7C15ULL;
        hash ^= hash >> 29;
    }
    return hash;
}

struct Keyed {
    tissue::Triangle sorted{};
    std::uint32_t triangle = 0;
    bool even = true; // same way round as the sorted corners
};

std::vector<Keyed> by_corners(const Surface& s) {
    std::vector<Keyed> keyed(s.triangles.size());
    for (std::uint32_t t = 0; t < keyed.size(); ++t) {
        tissue::Triangle c = s.triangles[t];
        const int inversions = (c[0] > c[1]) + (c[0] > c[2]) + (c[1] > c[2]);
        const bool even = inversions % 2 == 0;
        std::sort(c.begin(), c.end());
        keyed[t] = {c, t, even};
    }
    std::sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) {
        return a.sorted != b.sorted ? a.sorted < b.sorted : a.triangle < b.triangle;
    });
    return keyed;
}

void erase_marked(Surface& s, const std::vector<char>& gone) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        if (!gone[t]) {
            s.triangles[kept++] = s.triangles[t];
        }
    }
    s.triangles.resize(kept);
}

/// Half edges whose edge has no other triangle.
std::vector<std::uint32_t> open_halves(const Surface& s) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> uses(3 * s.triangles.size());
    for (std::size_t h = 0; h < uses.size(); ++h) {
        const std::uint64_t a = from_point(s, h), b = to_point(s, h);
        uses[h] = {std::min(a, b) << 32 | std::max(a, b), static_cast<std::uint32_t>(h)};
    }
    std::sort(uses.begin(), uses.end());
    std::vector<std::uint32_t> open;
    for (std::size_t i = 0; i < uses.size(); ++i) {
        const bool before = i > 0 && uses[i - 1].first == uses[i].first;
        const bool after = i + 1 < uses.size() && uses[i + 1].first == uses[i].first;
        if (!before && !after) {
            open.push_back(uses[i].second);
        }
    }
    std::sort(open.begin(), open.end());
    return open;
}

std::vector<std::uint32_t> points_of(const Surface& s, const std::vector<std::uint32_t>& halves) {
    std::vector<std::uint32_t> points;
    for (const auto h : halves) {
        points.push_back(from_point(s, h));
        points.push_back(to_point(s, h));
    }
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
}

BoxTree point_tree(const Surface& s, const std::vector<std::uint32_t>& points, double reach_m) {
    std::vector<Box> boxes(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        boxes[i].add(s.point_m[points[i]] - reach_m);
        boxes[i].add(s.point_m[points[i]] + reach_m);
    }
    return BoxTree(boxes);
}

std::size_t weld_near(Surface& s, double reach_m) {
    const auto points = points_of(s, open_halves(s));
    const BoxTree tree = point_tree(s, points, reach_m);
    std::vector<std::uint32_t> to(s.point_m.size());
    std::iota(to.begin(), to.end(), 0u);
    std::size_t welded = 0;
    for (const auto p : points) {
        Box at;
        at.add(s.point_m[p]);
        tree.visit(at, [&](std::uint32_t item) {
            const std::uint32_t q = points[item];
            if (q < p && to[q] == q && to[p] == p &&
                glm::length(s.point_m[p] - s.point_m[q]) <= reach_m) {
                to[p] = q;
                ++welded;
            }
        });
    }
    for (auto& t : s.triangles) {
        for (auto& v : t) {
            v = to[v];
        }
    }
    return welded;
}

/// Points on the open edge of `half`, in order along it.
std::vector<std::uint32_t> points_on(const Surface& s, std::size_t half, const BoxTree& tree,
                                     const std::vector<std::uint32_t>& points, double reach_m) {
    const std::uint32_t from = from_point(s, half), to = to_point(s, half);
    const glm::dvec3 a = s.point_m[from], d = s.point_m[to] - a;
    const double length2 = glm::dot(d, d);
    Box box;
    box.add(a);
    box.add(a + d);
    std::vector<std::pair<double, std::uint32_t>> on;
    tree.visit(box, [&](std::uint32_t item) {
        const std::uint32_t p = points[item];
        const double share = glm::dot(s.point_m[p] - a, d) / length2;
        const double away_m = glm::length(s.point_m[p] - (a + share * d));
        const double slack = reach_m / std::sqrt(length2);
        if (p != from && p != to && share > slack && share < 1.0 - slack && away_m <= reach_m) {
            on.emplace_back(share, p);
        }
    });
    std::sort(on.begin(), on.end());
    std::vector<std::uint32_t> ordered;
    for (const auto& [share, p] : on) {
        ordered.push_back(p);
    }
    return ordered;
}

std::size_t split_junctions(Surface& s, double reach_m) {
    const auto open = open_halves(s);
    const auto points = points_of(s, open);
    const BoxTree tree = point_tree(s, points, reach_m);
    std::size_t split = 0;
    std::vector<char> gone(s.triangles.size(), 0);
    std::vector<tissue::Triangle> added;
    for (const auto h : open) {
        const std::size_t t = h / 3;
        const auto on = points_on(s, h, tree, points, reach_m);
        if (on.empty() || gone[t]) { // one edge of a triangle at a time
            continue;
        }
        gone[t] = 1;
        ++split;
        const std::uint32_t opposite = s.triangles[t][(h % 3 + 2) % 3];
        std::uint32_t from = from_point(s, h);
        for (const auto p : on) {
            added.push_back({from, p, opposite});
            from = p;
        }
        added.push_back({from, to_point(s, h), opposite});
    }
    erase_marked(s, gone);
    s.triangles.insert(s.triangles.end(), added.begin(), added.end());
    return split;
}

} // namespace

Surface weld_equal(const Soup& soup, double unit_m) {
    Surface s;
    std::vector<std::uint32_t> slot(std::bit_ceil(2 * soup.point.size() + 16), kNone);
    std::vector<std::uint32_t> to(soup.point.size());
    for (std::size_t i = 0; i < soup.point.size(); ++i) {
        const glm::dvec3 p = unit_m * soup.point[i] + 0.0; // no negative zero
        std::size_t at = mix(p) & (slot.size() - 1);
        while (slot[at] != kNone && s.point_m[slot[at]] != p) {
            at = (at + 1) & (slot.size() - 1);
        }
        if (slot[at] == kNone) {
            slot[at] = static_cast<std::uint32_t>(s.point_m.size());
            s.point_m.push_back(p);
        }
        to[i] = slot[at];
    }
    for (const auto& t : soup.triangles) {
        s.triangles.push_back({to[t[0]], to[t[1]], to[t[2]]});
    }
    return s;
}

void drop_useless(Surface& s, Notes& notes) {
    std::vector<char> gone(s.triangles.size(), 0);
    std::size_t flat = 0;
    glm::dvec3 flat_at{0.0};
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        const auto& c = s.triangles[t];
        const glm::dvec3 a = s.point_m[c[0]];
        if (glm::length(glm::cross(s.point_m[c[1]] - a, s.point_m[c[2]] - a)) == 0.0) {
            gone[t] = 1;
            flat_at = flat++ == 0 ? a : flat_at;
        }
    }
    if (flat > 0) {
        notes.repairs.push_back(fmt::format("{} triangles without area dropped, the first at {}",
                                            flat, notes.place(flat_at)));
        erase_marked(s, gone);
    }

    const auto keyed = by_corners(s);
    gone.assign(s.triangles.size(), 0);
    std::size_t same = 0, opposite = 0;
    std::vector<std::uint32_t> second_sides;
    std::uint32_t first_double = kNone;
    for (std::size_t first = 0, last = 0; first < keyed.size(); first = last) {
        std::uint32_t kept[2]{kNone, kNone}; // one each way round
        for (; last < keyed.size() && keyed[last].sorted == keyed[first].sorted; ++last) {
            std::uint32_t& mine = kept[keyed[last].even ? 1 : 0];
            if (mine == kNone) {
                mine = keyed[last].triangle;
            } else {
                gone[keyed[last].triangle] = 1;
                ++same;
                first_double = std::min(first_double, keyed[last].triangle);
            }
        }
        if (kept[0] != kNone && kept[1] != kNone) {
            ++opposite;
            second_sides.push_back(std::max(kept[0], kept[1]));
        }
    }
    if (same > 0) {
        const auto corner = s.triangles[first_double][0];
        notes.repairs.push_back(fmt::format("{} double triangles dropped, the first at {}", same,
                                            notes.place(s.point_m[corner])));
    }
    // a wall between two bodies has two sides by right; a surface that is nothing else has not
    if (4 * opposite > s.triangles.size() - same) {
        for (const auto t : second_sides) {
            gone[t] = 1;
        }
        notes.repairs.push_back(
            fmt::format("{} triangles are there from both sides, one side dropped", opposite));
    }
    erase_marked(s, gone);
}

void close_seams(Surface& s, Notes& notes) {
    const Box box = box_of(s);
    const double reach_m = kWeldShare * glm::length(box.high - box.low);
    if (open_halves(s).empty()) {
        return;
    }
    const std::size_t welded = weld_near(s, reach_m);
    if (welded > 0) {
        notes.repairs.push_back(
            fmt::format("{} points on open edges welded to others nearer than {}", welded,
                        notes.length(reach_m)));
        drop_useless(s, notes);
    }
    std::size_t split = 0;
    for (int round = 0; round < 8; ++round) { // a triangle may have such points on three edges
        const std::size_t now = split_junctions(s, reach_m);
        split += now;
        if (now == 0) {
            break;
        }
    }
    if (split > 0) {
        notes.repairs.push_back(
            fmt::format("{} edges split where another's corner lies on them (T-junctions)", split));
        drop_useless(s, notes);
    }
}

} // namespace bake
