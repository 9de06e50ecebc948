// sim/view/light.h
// The lamp at the endoscope's tip and the camera's exposure. Pure; render thread.
#pragma once

#include "sim/view/frame.h"

namespace view {

/// Softens the inverse square near the lamp: it is a ring, not a point.
inline constexpr double kLampSize2_m2 = 0.0015;

/// Light at `place_m`: cos^2 of the angle to the axis, over the distance squared; 1 on the axis at
/// 0.16 m. The shaders' lamp() is the same formula.
double lamp(const Camera& camera, const glm::dvec3& place_m);

/// The factor that makes what lies in the inner half of the picture as bright as at 0.16 m, 0.4 to
/// 2.5; 1 if nothing lies there. Looks at some of the vertices only.
double exposure(const ViewFrame& frame);

} // namespace view
