#include "haptics/contact/virtual_proxy.h"

#include "haptics/contact/plane_qp.h"
#include "haptics/contact/proxy_parts.h"

namespace haptics {
namespace {

using glm::dvec3;

struct TouchPlanes {
    std::array<Plane, kMostProxyContacts> plane;
    std::array<SurfaceHit, kMostProxyContacts> at;
    std::array<dvec3, kMostProxyContacts> shading; // unit; the plane's own: not shaded; 0: left out
    int planes = 0;
    bool shaded = false; // any of them

    std::span<const Plane> all() const noexcept { return std::span(plane).first(planes); }
};

/// The mean of the vertex normals by the weights of a place, on the side of n; n itself if there
/// is none, or if a ball could not tell the two apart.
dvec3 shading_normal(const MeshView& mesh, const ProxyInput& in, const SurfaceHit& at,
                     const dvec3& n, double alike) noexcept {
    const auto [a, b, c] = mesh.triangle[at.triangle];
    dvec3 mean = at.weight.x * in.vertex_normal[a] + at.weight.y * in.vertex_normal[b] +
                 at.weight.z * in.vertex_normal[c];
    const double length = glm::length(mean);
    if (!(length > 0.0))
        return n;
    mean /= glm::dot(mean, n) < 0.0 ? -length : length;
    return glm::length(mean - n) <= alike ? n : mean;
}

/// Is this the nearest point of a triangle that meets a nearer one there? Any place q of a triangle
/// whose nearest point is p, seen from the proxy, has |q|^2 >= |p|^2 + |q - p|^2.
bool belongs_to_nearer(const TouchPlanes& touch, const SurfaceHit& q, double hover_m) noexcept {
    const auto end = touch.at.begin() + touch.planes;
    return std::any_of(touch.at.begin(), end, [&](const SurfaceHit& p) {
        const double farther_m2 = q.distance_m * q.distance_m - p.distance_m * p.distance_m;
        return glm::length(q.place_m - p.place_m) <= hover_m + std::sqrt(std::max(0.0, farther_m2));
    });
}

/// The shading normal of plane `i`, for one more triangle that has it. Triangles that meet at their
/// nearest point have the same one, or there is a crease, which is not shaded; nor is what belongs
/// to a nearer triangle, it would be the shading from over the edge.
void shade(const MeshView& mesh, const ProxyInput& in, const SurfaceHit& at, const dvec3& n,
           double hover_m, int i, TouchPlanes& touch) noexcept {
    const double alike = hover_m / in.radius_m;
    const dvec3 normal = shading_normal(mesh, in, at, n, alike);
    dvec3& kept = touch.shading[i];
    if (i == touch.planes)
        kept = belongs_to_nearer(touch, at, hover_m) ? dvec3{0.0} : normal;
    else if (kept != dvec3{0.0} && !(glm::length(kept - normal) <= alike))
        kept = touch.plane[i].normal;
}

/// The planes that the surface has around the proxy, in configuration space: tangent to a ball of
/// the proxy's radius about each nearest point. Told in the state as well.
TouchPlanes planes_about(const CollisionIndex& index, const MeshView& mesh, const ProxyInput& in,
                         double hover_m, ProxyState& state) noexcept {
    std::array<SurfaceHit, 4 * kMostProxyContacts> found;
    const std::size_t all = contacts_within(index, mesh, state.proxy_m, in.radius_m + 2.0 * hover_m,
                                            std::span<SurfaceHit>(found));
    const bool shades =
        !in.vertex_normal.empty() && in.vertex_normal.size() >= mesh.vertex_m.size();
    TouchPlanes out;
    for (std::size_t i = 0; i < std::min(all, found.size()); ++i) {
        if (!(found[i].distance_m > 0.0))
            continue; // the centre is in the surface: no side to be pushed to
        // triangles that share the nearest point are one contact
        const dvec3 n = (state.proxy_m - found[i].place_m) / found[i].distance_m;
        int plane = 0;
        while (plane < out.planes &&
               !(in.radius_m * glm::length(out.plane[plane].normal - n) <= hover_m))
            ++plane;
        if (plane == kMostProxyContacts)
            continue;
        if (shades)
            shade(mesh, in, found[i], n, hover_m, plane, out);
        if (plane < out.planes)
            continue;
        out.plane[plane] = {n, glm::dot(n, found[i].place_m) + in.radius_m + hover_m};
        out.at[plane] = found[i];
        state.contact[out.planes++] = {found[i].triangle, found[i].weight, n};
    }
    for (int i = 0; shades && i < out.planes; ++i)
        out.shaded =
            out.shaded || (out.shading[i] != dvec3{0.0} && out.shading[i] != out.plane[i].normal);
    state.contacts = out.planes;
    if (out.planes > 0)
        state.witness = state.contact[0].triangle;
    return out;
}

/// Force shading, in two passes. First the device is put in front of planes that have the shading
/// normals and pass through the proxy; then what comes out is put in front of the planes that the
/// surface really has. If it is in front of them already it goes back to the nearest one, so that
/// shading neither lifts the proxy off nor lets it in. Where that leaves the proxy in place, the
/// force is along the shading normal: p - device = l s after the first pass, and the second one
/// adds nothing.
dvec3 shaded_subgoal(const TouchPlanes& touch, const dvec3& device_m, const dvec3& proxy_m,
                     const dvec3& unshaded_m) noexcept {
    std::array<Plane, kMostProxyContacts> shading;
    std::size_t shadings = 0;
    for (int i = 0; i < touch.planes; ++i) {
        const Plane& real = touch.plane[i];
        if (touch.shading[i] == dvec3{0.0})
            continue;
        const dvec3 on_m = proxy_m + (real.offset_m - glm::dot(real.normal, proxy_m)) * real.normal;
        shading[shadings++] = {touch.shading[i], glm::dot(touch.shading[i], on_m)};
    }
    const PlaneSolution first = nearest_in_planes(std::span(shading).first(shadings), device_m);
    if (!first.feasible || first.actives == 0)
        return unshaded_m;
    const PlaneSolution second = nearest_in_planes(touch.all(), first.place_m);
    if (!second.feasible)
        return unshaded_m;
    if (second.actives > 0)
        return second.place_m;
    const auto gap_m = [&](const Plane& p) {
        return glm::dot(p.normal, first.place_m) - p.offset_m;
    };
    const Plane nearest =
        *std::min_element(touch.all().begin(), touch.all().end(),
                          [&](const Plane& a, const Plane& b) { return gap_m(a) < gap_m(b); });
    return first.place_m - gap_m(nearest) * nearest.normal;
}

/// What friction leaves of the way to a subgoal: the way along the surface is the tangential
/// force, from the device to the subgoal the normal one, both over k. The larger coefficient is
/// for a proxy that did not slide in the last tick and has not begun to in this one. `unshaded_m`:
/// the subgoal on the surface as it is, which says what is along it.
dvec3 with_friction(const ProxyInput& in, const dvec3& unshaded_m, const dvec3& subgoal_m,
                    bool slid, ProxyState& state) noexcept {
    const dvec3 normal_m = unshaded_m - in.device_m, way_m = subgoal_m - state.proxy_m;
    const double push_m = glm::length(subgoal_m - in.device_m), deep_m = glm::length(normal_m);
    if (!(push_m > 0.0 && deep_m > 0.0) || !(in.static_friction > 0.0 || in.dynamic_friction > 0.0))
        return subgoal_m;
    const dvec3 n = normal_m / deep_m;
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
        const TouchPlanes touch = planes_about(index, mesh, in, hover_m, state);
        told = true;
        const PlaneSolution nearest = nearest_in_planes(touch.all(), in.device_m);
        if (!nearest.feasible)
            break; // held from all sides: it stays
        const bool held = nearest.actives > 0;
        dvec3 subgoal_m = nearest.place_m;
        if (held && touch.shaded)
            subgoal_m = shaded_subgoal(touch, in.device_m, state.proxy_m, nearest.place_m);
        if (held)
            subgoal_m = with_friction(in, nearest.place_m, subgoal_m, slid, state);
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
        planes_about(index, mesh, in, hover_m, state);
    state.sliding = state.sliding && state.touching;
    state.force_n = in.stiffness_npm * (state.proxy_m - in.device_m);
}

} // namespace haptics
