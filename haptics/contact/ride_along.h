// haptics/contact/ride_along.h
// A ball rides along with a mesh that moves under it and is never passed by a triangle. The first
// part of a tick of safe_proxy.h. Real-time safe.
#pragma once

#include "haptics/collision/index.h"
#include "haptics/contact/proxy_method.h"

namespace haptics {

/// Moves the proxy, and how far it is from the device, as the mesh goes from `before_m` to
/// `vertex_m`: with the surface points it leaned on, and out of the way of what comes at it. If the
/// mesh closes on it from all sides it goes where it is least in the way.
void ride_along(const CollisionIndex& index, const MeshView& mesh, const ProxyInput& in,
                ProxyState& state) noexcept;

} // namespace haptics
