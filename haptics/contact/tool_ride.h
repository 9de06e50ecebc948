// haptics/contact/tool_ride.h
// The first part of a tick of safe_tools.h: a tool rides along with a mesh that moves under its
// tip and shaft, and no triangle passes it. Real-time safe.
#pragma once

#include "haptics/contact/tool_parts.h"

namespace haptics {

/// Moves the tip as the mesh goes from `before_m` to `vertex_m`: with the surface points that tip
/// and shaft leaned on, and out of the way of what comes at them; the other tools stand still. If
/// all closes in on it, it goes where it is least in the way.
void ride_along(const CollisionIndex& index, const MeshView& mesh, const OtherTools& others,
                ToolState& state) noexcept;

} // namespace haptics
