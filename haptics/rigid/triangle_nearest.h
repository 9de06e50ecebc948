// haptics/rigid/triangle_nearest.h
// The point of a triangle nearest to a place (Ericson 2005, Real-Time Collision Detection, 5.1.5:
// by the regions of its corners, edges and inside). Load time.
#pragma once

#include <glm/vec3.hpp>

namespace haptics {

glm::dvec3 nearest_on_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                               const glm::dvec3& place) noexcept;

} // namespace haptics
