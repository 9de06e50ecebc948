#include "assets/bake/import/crossing.h"

#include "assets/bake/import/box_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#define TETLIBRARY
#include <tetgen.h>

namespace bake {
namespace {

using Corners = std::array<glm::dvec3, 3>;

/// Sign of the volume of (a, b, c, d), exact.
int side(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    static const bool ready = [] {
        exactinit(0, 0, 0, 1.0, 1.0, 1.0);
        return true;
    }();
    glm::dvec3 p[4]{a, b, c, d};
    const double v = ready ? orient3d(&p[0].x, &p[1].x, &p[2].x, &p[3].x) : 0.0;
    return v > 0.0 ? 1 : v < 0.0 ? -1 : 0;
}

/// Point off the plane of a triangle, for orientation tests within that plane.
glm::dvec3 above(const Corners& t) {
    const glm::dvec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
    int axis = 0;
    for (int d = 1; d < 3; ++d) {
        axis = std::abs(n[d]) > std::abs(n[axis]) ? d : axis;
    }
    glm::dvec3 p = t[0];
    p[axis] += glm::length(t[1] - t[0]) + glm::length(t[2] - t[0]);
    return p;
}

bool segments_meet_in_plane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                            const glm::dvec3& d, const glm::dvec3& up) {
    const int abc = side(a, b, c, up), abd = side(a, b, d, up);
    const int cda = side(c, d, a, up), cdb = side(c, d, b, up);
    if (abc == 0 && abd == 0) { // on one line: their boxes decide
        Box ab, cd;
        ab.add(a), ab.add(b), cd.add(c), cd.add(d);
        return ab.meets(cd);
    }
    return abc * abd <= 0 && cda * cdb <= 0;
}

bool in_triangle_in_plane(const glm::dvec3& p, const Corners& t, const glm::dvec3& up) {
    const int a = side(t[0], t[1], p, up), b = side(t[1], t[2], p, up), c = side(t[2], t[0], p, up);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// Does the segment p q meet the triangle, its rim included?
bool meets(const glm::dvec3& p, const glm::dvec3& q, const Corners& t) {
    const int sp = side(t[0], t[1], t[2], p), sq = side(t[0], t[1], t[2], q);
    if (sp * sq > 0) {
        return false;
    }
    if (sp == 0 && sq == 0) {
        const glm::dvec3 up = above(t);
        return in_triangle_in_plane(p, t, up) || in_triangle_in_plane(q, t, up) ||
               segments_meet_in_plane(p, q, t[0], t[1], up) ||
               segments_meet_in_plane(p, q, t[1], t[2], up) ||
               segments_meet_in_plane(p, q, t[2], t[0], up);
    }
    const int a = side(p, q, t[0], t[1]), b = side(p, q, t[1], t[2]), c = side(p, q, t[2], t[0]);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

struct Pair {
    const Surface& s;
    tissue::Triangle a, b;

    [[nodiscard]] Corners corners(const tissue::Triangle& t) const {
        return {s.point_m[t[0]], s.point_m[t[1]], s.point_m[t[2]]};
    }
    /// Corners of `t` with those it shares with `other` first.
    static tissue::Triangle shared_first(tissue::Triangle t, const tissue::Triangle& other) {
        std::stable_partition(t.begin(), t.end(), [&](std::uint32_t v) {
            return std::find(other.begin(), other.end(), v) != other.end();
        });
        return t;
    }
    static int shared(const tissue::Triangle& a, const tissue::Triangle& b) {
        int count = 0;
        for (const auto v : a) {
            count += std::find(b.begin(), b.end(), v) != b.end() ? 1 : 0;
        }
        return count;
    }

    [[nodiscard]] bool any_edge_meets() const {
        const Corners ca = corners(a), cb = corners(b);
        for (std::size_t k = 0; k < 3; ++k) {
            if (meets(ca[k], ca[(k + 1) % 3], cb) || meets(cb[k], cb[(k + 1) % 3], ca)) {
                return true;
            }
        }
        return false;
    }

    /// The edges opposite the shared corner.
    [[nodiscard]] bool meets_beyond_corner() const {
        const Corners p = corners(shared_first(a, b)), q = corners(shared_first(b, a));
        return meets(p[1], p[2], q) || meets(q[1], q[2], p);
    }

    /// In one plane, with both free corners on one side of the shared edge.
    [[nodiscard]] bool folded() const {
        const Corners p = corners(shared_first(a, b)), q = corners(shared_first(b, a));
        if (side(p[0], p[1], p[2], q[2]) != 0) {
            return false;
        }
        const glm::dvec3 up = above(p);
        return side(p[0], p[1], p[2], up) * side(p[0], p[1], q[2], up) >= 0;
    }

    [[nodiscard]] bool cross() const {
        switch (shared(a, b)) {
        case 0:
            return any_edge_meets();
        case 1:
            return meets_beyond_corner();
        case 2:
            return folded();
        default:
            return true; // the same triangle twice
        }
    }
};

} // namespace

std::vector<Crossing> find_crossings(const Surface& s, std::size_t most) {
    const auto boxes = triangle_boxes(s);
    const BoxTree tree(boxes);
    std::vector<Crossing> found;
    std::vector<std::uint32_t> near;
    for (std::uint32_t t = 0; t < s.triangles.size() && found.size() < most; ++t) {
        near.clear();
        tree.visit(boxes[t], [&](std::uint32_t other) {
            if (other > t) {
                near.push_back(other);
            }
        });
        std::sort(near.begin(), near.end());
        for (const auto other : near) {
            if (Pair{s, s.triangles[t], s.triangles[other]}.cross() && found.size() < most) {
                Box both;
                both.low = glm::max(boxes[t].low, boxes[other].low);
                both.high = glm::min(boxes[t].high, boxes[other].high);
                found.push_back({t, other, 0.5 * (both.low + both.high)});
            }
        }
    }
    return found;
}

std::string describe(const std::vector<Crossing>& crossings, double apart_m, const Notes& notes) {
    struct Place {
        glm::dvec3 first_m;
        std::size_t count;
    };
    std::vector<Place> places;
    std::set<std::uint32_t> triangles;
    for (const auto& c : crossings) {
        triangles.insert(c.a);
        triangles.insert(c.b);
        const auto at = std::find_if(places.begin(), places.end(), [&](const Place& p) {
            return glm::length(p.first_m - c.at_m) < apart_m;
        });
        if (at == places.end()) {
            places.push_back({c.at_m, 1});
        } else {
            ++at->count;
        }
    }
    if (places.empty()) {
        return "";
    }
    std::stable_sort(places.begin(), places.end(),
                     [](const Place& a, const Place& b) { return a.count > b.count; });
    std::string text = fmt::format("{} triangles cross or touch others in {} {}", triangles.size(),
                                   places.size(), places.size() == 1 ? "place" : "places");
    for (std::size_t i = 0; i < std::min<std::size_t>(places.size(), 4); ++i) {
        text += (i == 0 ? ": " : ", ") + notes.place(places[i].first_m);
    }
    return text + (places.size() > 4 ? ", ..." : "");
}

} // namespace bake
