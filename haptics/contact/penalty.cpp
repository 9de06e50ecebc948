#include "haptics/contact/penalty.h"

#include "haptics/contact/proxy_parts.h"

namespace haptics {
namespace {

using glm::dvec3;

constexpr double kEverywhere_m = 1e6; // inside something large the nearest face may be far
constexpr std::size_t kMostFaces = 32;

struct NearestFace {
    SurfaceHit hit;
    dvec3 normal{0.0};
    double height_m = 0.0; // of the ball's centre over the face's plane
};

/// Among the faces that share the nearest point, the one whose plane is furthest away: at a ridge
/// its side is the right one.
NearestFace nearest_face(const CollisionIndex& index, const MeshView& mesh, const dvec3& place_m,
                         const SurfaceHit& nearest) noexcept {
    std::array<SurfaceHit, kMostFaces> found;
    const double reach_m = nearest.distance_m * (1.0 + 1e-9);
    const std::size_t all =
        contacts_within(index, mesh, place_m, reach_m, std::span<SurfaceHit>(found));
    NearestFace best{nearest, facing(mesh.corners(nearest.triangle)), 0.0};
    best.height_m = glm::dot(best.normal, place_m - nearest.place_m);
    for (std::size_t i = 0; i < std::min(all, kMostFaces); ++i) {
        const dvec3 n = facing(mesh.corners(found[i].triangle));
        const double height_m = glm::dot(n, place_m - found[i].place_m);
        if (std::abs(height_m) > std::abs(best.height_m) * (1.0 + 1e-9))
            best = {found[i], n, height_m};
    }
    return best;
}

} // namespace

void step_penalty(const CollisionIndex& index, const MeshView& mesh, const ProxyInput& in,
                  ProxyState& state) noexcept {
    state.force_n = dvec3{0.0};
    if (!finite(in))
        return;
    state = {.started = true, .proxy_m = in.device_m};
    const SurfaceHit nearest = closest_within(index, mesh, in.device_m, kEverywhere_m);
    if (!nearest.hit())
        return;
    const NearestFace face = nearest_face(index, mesh, in.device_m, nearest);
    state.witness = face.hit.triangle;
    const double signed_m = face.height_m < 0.0 ? -face.hit.distance_m : face.hit.distance_m;
    const double depth_m = in.radius_m - signed_m;
    if (!(depth_m > 0.0))
        return;
    const dvec3 normal =
        face.hit.distance_m > 0.0 ? (in.device_m - face.hit.place_m) / signed_m : face.normal;
    state.touching = true;
    state.force_n = in.stiffness_npm * depth_m * normal;
    state.proxy_m = in.device_m + depth_m * normal;
    state.contacts = 1;
    state.contact[0] = {face.hit.triangle, face.hit.weight, normal};
}

} // namespace haptics
