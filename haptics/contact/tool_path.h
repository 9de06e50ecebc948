// haptics/contact/tool_path.h
// The second part of a tick of safe_tools.h: a tool's tip goes to where the device pulls it, in
// straight steps on which neither tip nor shaft meets anything. Real-time safe.
#pragma once

#include "haptics/contact/tool_parts.h"

namespace haptics {

/// Where the tip is pushed by another tool: it is to be in front of these as well, if it can.
struct ToolYields {
    static constexpr int kRoom = 8;
    int count = 0;
    std::array<Plane, kRoom> plane;
    std::array<ToolTouch, kRoom> from;
};

/// As far as a tick allows: `most_m`.
void approach(const CollisionIndex& index, const MeshView& mesh, const OtherTools& others,
              const ToolYields& yields, const ToolInput& in, double most_m,
              ToolState& state) noexcept;

} // namespace haptics
