// tasks/score/ideal_path.h
// Ways a tool tip could have gone: the shortest, and the careful. Called by finish(); any thread,
// no state.
#pragma once

#include <glm/vec3.hpp>
#include <span>

namespace tasks {

/// Length of the shortest path from `start_m` that touches the balls of `radius_m` about the
/// centres in order, m. Version 1: straight through whatever lies between (no obstacles).
/// A convex problem (sum of distances, one ball per corner), solved corner by corner.
double shortest_tour_m(const glm::dvec3& start_m, std::span<const glm::dvec3> centre_m,
                       double radius_m);

/// Length of the careful way through the port, m: to each place in order by retracting along the
/// shaft, swinging about the port, inserting along the shaft (goal-directed movements are a
/// retraction and a search: Chmarra et al. 2006, 2008). It swings at the depth of `start_m`, which
/// is clear of the tissue, or at that of a place that lies less deep; a place is reached
/// `radius_m` before its centre.
double retraction_tour_m(const glm::dvec3& fulcrum_m, const glm::dvec3& start_m,
                         std::span<const glm::dvec3> place_m, double radius_m);

} // namespace tasks
