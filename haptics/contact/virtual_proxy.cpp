#include "haptics/contact/virtual_proxy.h"

#include "haptics/contact/plane_qp.h"
#include "haptics/contact/proxy_parts.h"

namespace haptics {
namespace {

using glm::dvec3;

struct TouchPlanes {
    std::array<Plane, kMostProxyContacts> plane{};
    int planes = 0;
};

/// The planes that the surface has around the proxy, in configuration space: tangent to a ball of
/// the proxy's radius about each nearest point. Told in the state as well.
TouchPlanes planes_about(const CollisionIndex& index, const MeshView& mesh, double radius_m,
                         double hover_m, ProxyState& state) noexcept {
    std::array<SurfaceHit, 4 * kMostProxyContacts> found;
    const std::size_t all = contacts_within(index, mesh, state.proxy_m, radius_m + 2.0 * hover_m,
                                            std::span<SurfaceHit>(found));
    TouchPlanes out;
    for (std::size_t i = 0; i < std::min(all, found.size()); ++i) {
        if (!(found[i].distance_m > 0.0))
            continue; // the centre is in the surface: no side to be pushed to
        // triangles that share the nearest point are one contact
        const dvec3 n = (state.proxy_m - found[i].place_m) / found[i].distance_m;
        const auto same = [&](const Plane& p) {
            return radius_m * glm::length(p.normal - n) <= hover_m;
        };
        const auto end = out.plane.begin() + out.planes;
        if (out.planes == kMostProxyContacts || std::any_of(out.plane.begin(), end, same))
            continue;
        out.plane[out.planes] = {n, glm::dot(n, found[i].place_m) + radius_m + hover_m};
        state.contact[out.planes++] = {found[i].triangle, found[i].weight, n};
    }
    state.contacts = out.planes;
    if (out.planes > 0)
        state.witness = state.contact[0].triangle;
    return out;
}

/// What friction leaves of the way to a subgoal: the way along the surface is the tangential
/// force, from the device to the subgoal the normal one, both over k. The larger coefficient is
/// for a proxy that did not slide in the last tick and has not begun to in this one.
dvec3 with_friction(const ProxyInput& in, const dvec3& subgoal_m, bool slid,
                    ProxyState& state) noexcept {
    const dvec3 normal_m = subgoal_m - in.device_m, way_m = subgoal_m - state.proxy_m;
    const double push_m = glm::length(normal_m);
    if (!(push_m > 0.0) || !(in.static_friction > 0.0 || in.dynamic_friction > 0.0))
        return subgoal_m;
    const dvec3 n = normal_m / push_m;
    const dvec3 out_m = glm::dot(way_m, n) * n, along_m = way_m - out_m;
    const double along = glm::length(along_m), left = in.dynamic_friction * push_m;
    const double grip = slid || state.sliding ? left : std::max(in.static_friction * push_m, left);
    if (along <= grip)
        return state.proxy_m + out_m;
    state.sliding = true;
    return state.proxy_m + out_m + (1.0 - left / along) * along_m;
}

/// One straight step towards a subgoal, as far as nothing is in the way. False: the way was free.
bool move(const CollisionIndex& index, const MeshView& mesh, double radius_m,
          const dvec3& subgoal_m, ProxyState& state) noexcept {
    const SweepHit hit = sweep_sphere(index, mesh, state.proxy_m, subgoal_m, radius_m);
    state.proxy_m = hit.hit() ? state.proxy_m + hit.time * (subgoal_m - state.proxy_m) : subgoal_m;
    return hit.hit();
}

} // namespace

void step_virtual_proxy(const CollisionIndex& index, const MeshView& still, const ProxyInput& in,
                        ProxyState& state) noexcept {
    state.force_n = dvec3{0.0};
    if (!finite(in) || !(in.radius_m > 0.0))
        return;
    if (!state.started)
        state = {.started = true, .proxy_m = in.device_m};
    const MeshView mesh{still.vertex_m, still.triangle, {}}; // as it is now
    const double hover_m = hover_gap_m(state.proxy_m, in.radius_m);

    const bool slid = state.sliding;
    state.sliding = false;
    bool told = false; // the contacts are those of where the proxy is
    for (int subgoal = 0; subgoal < kMostSubgoals; ++subgoal) {
        const TouchPlanes touch = planes_about(index, mesh, in.radius_m, hover_m, state);
        told = true;
        const PlaneSolution nearest =
            nearest_in_planes(std::span(touch.plane).first(touch.planes), in.device_m);
        if (!nearest.feasible)
            break; // held from all sides: it stays
        const bool held = nearest.actives > 0;
        const dvec3 subgoal_m =
            held ? with_friction(in, nearest.place_m, slid, state) : nearest.place_m;
        if (held && glm::length(subgoal_m - state.proxy_m) <= hover_m)
            break;
        told = false;
        if (!move(index, mesh, in.radius_m, subgoal_m, state) && !held)
            break; // at the device
    }
    // What held it back last does not matter: round an edge it goes in turns along a plane and,
    // as none is near there, straight at the device, and the last subgoal may be of either kind.
    state.touching = state.proxy_m != in.device_m;
    if (!state.touching)
        state.contacts = 0;
    else if (!told)
        planes_about(index, mesh, in.radius_m, hover_m, state);
    state.sliding = state.sliding && state.touching;
    state.force_n = in.stiffness_npm * (state.proxy_m - in.device_m);
}

} // namespace haptics
