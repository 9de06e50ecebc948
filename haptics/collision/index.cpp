#include "haptics/collision/index.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace haptics {
namespace {

void check(const MeshView& mesh) {
    const auto refuse = [](const std::string& what) {
        throw std::invalid_argument("collision mesh: " + what);
    };
    for (std::size_t v = 0; v < mesh.vertex_m.size(); ++v)
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(mesh.vertex_m[v][axis]))
                refuse("vertex " + std::to_string(v) + " is not finite");
    for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
        for (const std::uint32_t v : mesh.triangle[t])
            if (v >= mesh.vertex_m.size())
                refuse("triangle " + std::to_string(t) + " names vertex " + std::to_string(v) +
                       " of " + std::to_string(mesh.vertex_m.size()));
}

bool nearer(const SurfaceHit& a, const SurfaceHit& b) noexcept {
    return a.distance_m != b.distance_m ? a.distance_m < b.distance_m : a.triangle < b.triangle;
}

} // namespace

CollisionIndex make_index(std::string_view name, const MeshView& mesh) {
    check(mesh);
    if (name == "brute-force")
        return make_brute_force(mesh);
    if (name == "hash-grid")
        return make_hash_grid(mesh);
    if (name == "obb-tree")
        return make_obb_tree(mesh);
    if (name == "hybrid")
        return make_hybrid(mesh);
    if (name == "ours")
        return make_wide_tree(mesh);
    std::string known;
    for (const std::string_view k : kCollisionNames)
        known += (known.empty() ? "" : ", ") + std::string(k);
    throw std::invalid_argument("collision method '" + std::string(name) +
                                "' is not one of: " + known);
}

void refit(CollisionIndex& index, const MeshView& mesh) noexcept {
    std::visit([&](auto& method) { refit(method, mesh); }, index);
}

SurfaceHit closest_within(const CollisionIndex& index, const MeshView& mesh,
                          const glm::dvec3& place_m, double radius_m) noexcept {
    return std::visit(
        [&](const auto& method) { return closest_within(method, mesh, place_m, radius_m); }, index);
}

SurfaceHit cast_segment(const CollisionIndex& index, const MeshView& mesh, const glm::dvec3& from_m,
                        const glm::dvec3& to_m) noexcept {
    return std::visit([&](const auto& method) { return cast_segment(method, mesh, from_m, to_m); },
                      index);
}

SweepHit sweep_sphere(const CollisionIndex& index, const MeshView& mesh, const glm::dvec3& from_m,
                      const glm::dvec3& to_m, double radius_m) noexcept {
    return std::visit(
        [&](const auto& method) { return sweep_sphere(method, mesh, from_m, to_m, radius_m); },
        index);
}

SweepHit sweep_shaft(const CollisionIndex& index, const MeshView& mesh,
                     const MovingSegment& segment, double radius_m) noexcept {
    return std::visit(
        [&](const auto& method) { return sweep_shaft(method, mesh, segment, radius_m); }, index);
}

std::size_t contacts_within(const CollisionIndex& index, const MeshView& mesh,
                            const glm::dvec3& place_m, double margin_m,
                            std::span<SurfaceHit> found) noexcept {
    std::size_t kept = 0, all = 0;
    const auto keep = [&](const SurfaceHit& hit) {
        for (std::size_t i = 0; i < kept; ++i)
            if (found[i].triangle == hit.triangle)
                return; // a method may visit a triangle twice
        ++all;
        if (kept == found.size()) {
            if (kept == 0 || !nearer(hit, found[kept - 1]))
                return;
            --kept;
        }
        std::size_t at = kept++;
        for (; at > 0 && nearer(hit, found[at - 1]); --at)
            found[at] = found[at - 1];
        found[at] = hit;
    };
    std::visit([&](const auto& method) { contacts_within(method, mesh, place_m, margin_m, keep); },
               index);
    return all;
}

} // namespace haptics
