#include "haptics/contact/god_object.h"

#include "haptics/contact/proxy_parts.h"

#include <optional>

namespace haptics {
namespace {

using glm::dvec3;

struct Constraint {
    dvec3 normal{0.0}; // unit, to the god-object
    double offset_m = 0.0;
};

/// The place nearest to the device on all of the planes. Eq. 3 of the paper is a system of 4, 5 or
/// 6 equations
///   x - l_1 n_1 - .. = device,   n_i . x = offset_i;
/// putting the first into the others leaves  sum_j (n_i . n_j) l_j = offset_i - n_i . device,
/// one to three equations for the multipliers, by Cramer's rule. Nothing: the planes are parallel.
std::optional<dvec3> nearest_on_planes(const std::array<Constraint, 3>& plane, int planes,
                                       const dvec3& device_m) noexcept {
    const auto& [a, b, c] = plane;
    const auto wanted_m = [&](const Constraint& p) {
        return p.offset_m - glm::dot(p.normal, device_m);
    };
    if (planes == 1)
        return device_m + wanted_m(a) * a.normal;
    const dvec3 line = glm::cross(a.normal, b.normal);
    if (planes == 2) { // Gram determinant: |line|^2
        const double ab = glm::dot(a.normal, b.normal), determinant = glm::dot(line, line);
        if (!(determinant > 0.0))
            return std::nullopt;
        return device_m + (wanted_m(a) - ab * wanted_m(b)) / determinant * a.normal +
               (wanted_m(b) - ab * wanted_m(a)) / determinant * b.normal;
    }
    const double volume = glm::dot(line, c.normal);
    if (volume == 0.0)
        return std::nullopt;
    return device_m + (wanted_m(a) * glm::cross(b.normal, c.normal) +
                       wanted_m(b) * glm::cross(c.normal, a.normal) + wanted_m(c) * line) /
                          volume;
}

struct Held {
    std::array<Constraint, 3> plane{};
    int planes = 0;
};

/// The plane of a facet that is in the way, a hover towards the god-object.
Constraint plane_of(const MeshView& mesh, const SurfaceHit& hit, const dvec3& god_m,
                    double hover_m) noexcept {
    const TriangleCorners corner = mesh.corners(hit.triangle);
    const dvec3 n = facing(corner);
    const double side = glm::dot(n, god_m - corner[0]) < 0.0 ? -1.0 : 1.0;
    return {side * n, side * glm::dot(n, corner[0]) + hover_m};
}

bool is_held(const Held& held, const Constraint& plane, double hover_m) noexcept {
    for (int i = 0; i < held.planes; ++i)
        if (glm::dot(plane.normal, held.plane[i].normal) > 1.0 - 1e-12 &&
            std::abs(plane.offset_m - held.plane[i].offset_m) <= hover_m)
            return true;
    return false;
}

} // namespace

void step_god_object(const CollisionIndex& index, const MeshView& mesh, const ProxyInput& in,
                     ProxyState& state) noexcept {
    state.force_n = dvec3{0.0};
    if (!finite(in))
        return;
    if (!state.started)
        state = {.started = true, .proxy_m = in.device_m};

    // where to, what is in the way, where to then
    const double hover_m = hover_gap_m(state.proxy_m, glm::length(in.device_m - state.proxy_m));
    Held held;
    dvec3 god_m = state.proxy_m, goal_m = in.device_m;
    for (bool lifted = false;;) {
        const SurfaceHit hit = cast_segment(index, mesh, god_m, goal_m);
        if (!hit.hit()) {
            god_m = goal_m;
            break;
        }
        state.witness = hit.triangle;
        const Constraint plane = plane_of(mesh, hit, god_m, hover_m);
        if (is_held(held, plane, hover_m)) { // its own plane is in the way: it hovered too low
            if (lifted)
                break;
            god_m += std::max(0.0, plane.offset_m - glm::dot(plane.normal, god_m)) * plane.normal;
            lifted = true;
            continue;
        }
        if (held.planes == 3)
            break; // held from all sides: it stays
        state.contact[held.planes] = {hit.triangle, hit.weight, plane.normal};
        held.plane[held.planes++] = plane;
        const auto next_m = nearest_on_planes(held.plane, held.planes, in.device_m);
        if (!next_m)
            break;
        goal_m = *next_m;
    }

    state.proxy_m = god_m;
    state.contacts = held.planes;
    state.touching = held.planes > 0;
    state.force_n = state.touching ? in.stiffness_npm * (state.proxy_m - in.device_m) : dvec3{0.0};
}

} // namespace haptics
