// tasks/score/ideal_path.h
// The shortest way a tool tip could have gone. Called by finish(); any thread, no state.
#pragma once

#include <glm/vec3.hpp>
#include <span>

namespace tasks {

/// Length of the shortest path from `start_m` that touches the balls of `radius_m` about the
/// centres in order, m. Version 1: straight through whatever lies between (no obstacles).
/// A convex problem (sum of distances, one ball per corner), solved corner by corner.
double shortest_tour_m(const glm::dvec3& start_m, std::span<const glm::dvec3> centre_m,
                       double radius_m);

} // namespace tasks
