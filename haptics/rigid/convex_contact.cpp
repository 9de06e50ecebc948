#include "haptics/rigid/convex_contact.h"

#include "haptics/rigid/penetration.h"
#include "haptics/rigid/separation.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace haptics {
namespace {

using glm::dvec3;

constexpr double kSteepest = 1e-3; // cosine
constexpr double kMostDrop = 0.2;  // of the way out, per tick
constexpr std::size_t kMostCorners = 2 * kMostAround;

constexpr std::uint32_t kMostFaces = 64;
using FaceList = Bounded<std::uint32_t, kMostFaces>;

bool any_inner(const ConvexHull& hull) noexcept {
    return std::find(hull.inner.begin(), hull.inner.end(), 1) != hull.inner.end();
}

// Along a direction: faces looking that way that reach to within `depth_m` of the extreme vertex.
FaceList facing(const ConvexHull& hull, const dvec3& way, double depth_m) noexcept {
    const std::uint32_t extreme = farthest_vertex(hull, way, 0);
    const double least_m = glm::dot(way, hull.vertex_m[extreme]) - depth_m;
    FaceList list;
    const auto take_round = [&](std::uint32_t v) {
        for (const std::uint32_t f : hull.faces_round(v))
            if (glm::dot(hull.normal[f], way) > kSteepest &&
                std::find(list.begin(), list.end(), f) == list.end())
                list.add(f);
    };
    take_round(extreme);
    for (std::uint32_t i = 0; i < list.count; ++i)
        for (const std::uint32_t v : hull.corners(list.item[i]))
            if (glm::dot(way, hull.vertex_m[v]) > least_m)
                take_round(v);
    return list;
}

struct Polygon {
    std::array<dvec3, kMostCorners> corner;
    std::size_t count = 0;
};

// Keeps what lies on the inner side of a plane through `at`.
void cut(Polygon& polygon, const dvec3& at, const dvec3& inward) noexcept {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.count && kept.count + 1 < kMostCorners; ++i) {
        const dvec3& from = polygon.corner[i];
        const dvec3& to = polygon.corner[i + 1 == polygon.count ? 0 : i + 1];
        const double p = glm::dot(from - at, inward), q = glm::dot(to - at, inward);
        if (p >= 0.0)
            kept.corner[kept.count++] = from;
        if ((p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0))
            kept.corner[kept.count++] = from + (to - from) * (p / (p - q));
    }
    polygon.count = kept.count;
    std::copy_n(kept.corner.begin(), kept.count, polygon.corner.begin());
}

// Face f of a above face g of b, along n, in a's frame.
ContactPatch between(const ConvexHull& a, std::uint32_t f, const ConvexHull& b, std::uint32_t g,
                     const RigidPose& b_in_a, const dvec3& n) noexcept {
    Polygon shadow; // of the face of a, in the plane across n through its first corner
    const dvec3 level = a.vertex_m[a.corners(f)[0]];
    for (const std::uint32_t v : a.corners(f))
        shadow.corner[shadow.count++] = a.vertex_m[v] - glm::dot(a.vertex_m[v] - level, n) * n;
    const auto side = b.corners(g);
    dvec3 from = to_world(b_in_a, b.vertex_m[side.back()]);
    const dvec3 on_b = from;
    for (std::size_t i = 0; i < side.size() && shadow.count > 2; ++i) {
        const dvec3 to = to_world(b_in_a, b.vertex_m[side[i]]);
        cut(shadow, from, glm::cross(to - from, n));
        from = to;
    }
    if (shadow.count < 3)
        return {};
    const dvec3 up_a = a.normal[f] / glm::dot(a.normal[f], n);
    const dvec3 normal_b = b_in_a.rotation * b.normal[g];
    const dvec3 up_b = normal_b / glm::dot(normal_b, n);
    // heights of the two faces above the plane, at its point x: up . (on face - x)
    const dvec3 x = shadow.corner[0];
    const double depth_m = glm::dot(up_a, level - x) - glm::dot(up_b, on_b - x);
    ContactPatch patch =
        part_in_contact({shadow.corner.data(), shadow.count}, n, depth_m, up_b - up_a);
    patch.middle_m += glm::dot(up_a, level - patch.middle_m) * n;
    return patch;
}

// A circle round each face, seen along n: most pairs of faces are nowhere near each other.
struct Circle {
    dvec3 middle_m{0.0};
    double radius_m = 0.0;
};

std::array<Circle, kMostFaces> circles(const ConvexHull& hull, const FaceList& faces,
                                       const RigidPose& pose, const dvec3& n) noexcept {
    std::array<Circle, kMostFaces> list;
    for (std::uint32_t i = 0; i < faces.count; ++i) {
        const auto corner = hull.corners(faces.item[i]);
        dvec3 middle_m{0.0};
        for (const std::uint32_t v : corner)
            middle_m += hull.vertex_m[v] / static_cast<double>(corner.size());
        for (const std::uint32_t v : corner)
            list[i].radius_m = std::max(list[i].radius_m, glm::length(hull.vertex_m[v] - middle_m));
        middle_m = to_world(pose, middle_m);
        list[i].middle_m = middle_m - glm::dot(middle_m, n) * n;
    }
    return list;
}

dvec3 turned_towards(const dvec3& from, const dvec3& to) noexcept {
    const double c = glm::dot(from, to);
    dvec3 across = to - c * from;
    if (c > std::cos(kMostTurn_rad))
        return to;
    if (!(glm::dot(across, across) > 1e-20)) // opposite: any way round
        across = glm::cross(from, std::abs(from.x) < 0.7 ? dvec3{1, 0, 0} : dvec3{0, 1, 0});
    return std::cos(kMostTurn_rad) * from + std::sin(kMostTurn_rad) * glm::normalize(across);
}

double depth_along(const ConvexHull& a, const ConvexHull& b, const RigidPose& b_in_a,
                   const dvec3& n) noexcept {
    const dvec3 back = glm::transpose(b_in_a.rotation) * -n;
    return glm::dot(n, a.vertex_m[farthest_vertex(a, n, 0)] -
                           to_world(b_in_a, b.vertex_m[farthest_vertex(b, back, 0)]));
}

} // namespace

PairContact convex_contact(const ConvexHull& a, const ConvexHull& b, const RigidPose& b_in_a,
                           double margin_m, PairMemory& memory) noexcept {
    const bool known = memory.normal_a != dvec3{0.0};
    const dvec3 guess = known ? memory.normal_a : to_world(b_in_a, b.centre_m) - a.centre_m;
    if (!memory.overlapped || depth_along(a, b, b_in_a, guess) <= 0.0) {
        const Separation s = separation(a, b, b_in_a, guess, margin_m);
        if (s.apart) {
            // past an inner face the way here is not the way out
            memory.normal_a = any_inner(a) || any_inner(b) ? dvec3{0.0} : s.normal;
            memory.overlapped = false;
            memory.way_out_m = 0.0;
            return {.depth_m = -s.distance_m, .normal = s.normal};
        }
    }
    const Penetration p =
        known ? walk_penetration(a, b, b_in_a, memory.normal_a) : penetration(a, b, b_in_a);
    if (p.depth_m <= 0.0) {
        memory = {};
        return {.depth_m = p.depth_m, .normal = p.normal};
    }
    PairContact contact{.depth_m = p.depth_m, .normal = p.normal};
    double way_out_m = p.depth_m;
    if (known) {
        contact.normal = turned_towards(memory.normal_a, p.normal);
        contact.depth_m = depth_along(a, b, b_in_a, contact.normal);
        way_out_m = std::max(way_out_m, (1.0 - kMostDrop) * memory.way_out_m);
        contact.scale = std::min(1.0, way_out_m / contact.depth_m);
    }
    memory = {.normal_a = contact.normal, .way_out_m = way_out_m, .overlapped = true};
    return contact;
}

void overlap_patches(const ConvexHull& a, const ConvexHull& b, const RigidPose& a_in_world,
                     const RigidPose& b_in_a, const PairContact& contact,
                     PatchList& patches) noexcept {
    const dvec3& n = contact.normal;
    const FaceList upper = facing(a, n, contact.depth_m);
    const FaceList lower = facing(b, glm::transpose(b_in_a.rotation) * -n, contact.depth_m);
    const glm::dmat3& turn = a_in_world.rotation;
    const auto round_upper = circles(a, upper, {}, n), round_lower = circles(b, lower, b_in_a, n);
    for (std::uint32_t i = 0; i < upper.count; ++i) {
        for (std::uint32_t j = 0; j < lower.count; ++j) {
            const dvec3 way_m = round_upper[i].middle_m - round_lower[j].middle_m;
            const double reach_m = round_upper[i].radius_m + round_lower[j].radius_m;
            if (glm::dot(way_m, way_m) > reach_m * reach_m)
                continue;
            ContactPatch patch = between(a, upper.item[i], b, lower.item[j], b_in_a, n);
            if (!(patch.area_m2 > 0.0))
                continue;
            patch.middle_m = to_world(a_in_world, patch.middle_m);
            patch.normal = turn * n;
            patch.depth_m *= contact.scale;
            patch.slope = contact.scale * (turn * patch.slope);
            patch.spread_m4 = turn * patch.spread_m4 * glm::transpose(turn);
            patches.add(patch);
        }
    }
}

} // namespace haptics
