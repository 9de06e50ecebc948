// haptics/contact/proxy_method.h
// What the classical contact methods and ours have in common when a ball (a tool's tip) feels a
// triangle mesh: one tick in, one force out. One method per file, one signature:
//   void step_NAME(const CollisionIndex&, const MeshView&, const ProxyInput&, ProxyState&)
//   noexcept;
// A mesh that moved since the last tick says so by `before_m`; the index was refitted to it. The
// force is a spring between what the method lets the ball do and where the device is; friction
// acts where the method knows any. 1 kHz: nothing is allocated, thrown or waited for. Input that
// is not finite gives no force and leaves the state as it was.
#pragma once

#include "haptics/collision/wide_tree.h"

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

namespace haptics {

struct ProxyInput {
    glm::dvec3 device_m{0.0}; // where the ball would be if nothing were in the way
    double radius_m = 0.0;    // 0: a point
    double stiffness_npm = 500.0;
    double static_friction = 0.0, dynamic_friction = 0.0; // Coulomb coefficients
    /// Unit, one for each vertex of the mesh as it is now (vertex_normals.h), for the method that
    /// shades forces: the virtual proxy. Empty: none does.
    std::span<const glm::dvec3> vertex_normal{};
};

/// A place on the mesh that the ball leans on.
struct ProxyContact {
    std::uint32_t triangle = kNoSurface;
    glm::dvec3 weight{0.0};
    glm::dvec3 normal{0.0}; // unit, from the surface to the ball
};

inline constexpr int kMostProxyContacts = 8;

struct ProxyState {
    bool started = false; // false: the next tick sets the ball where the device is
    bool touching = false;
    bool sliding = false; // touching and beyond static friction
    glm::dvec3 proxy_m{0.0};
    glm::dvec3 force_n{0.0}; // on the device
    int contacts = 0;
    std::array<ProxyContact, kMostProxyContacts> contact{};
    std::uint32_t witness = kNoSurface; // the triangle nearest last time: where to look first
    // of step_safe_proxy: how far it came in the last tick, how far off a surface it rests, where
    // the device was, what is around
    double step_m = 0.0, hover_m = 0.0;
    glm::dvec3 device_m{0.0};
    WideRing ring{};
};

} // namespace haptics
