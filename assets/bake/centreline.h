// assets/bake/centreline.h
// The line through the middle of a tube: centripetal Catmull-Rom through the recipe's points, and
// frames along it that turn as little as possible. Called by shape_tube.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace bake {

/// A place of the line with its right-handed frame: side x up = along.
struct Station {
    glm::dvec3 place_mm{0.0}, along{0.0}, side{0.0}, up{0.0};
    double share = 0.0; // of the line's length before it
};

/// `count` >= 2 stations at equal distances, the first and the last at the ends. At least two
/// points, no two in a row at one place.
std::vector<Station> stations(std::span<const glm::dvec3> point_mm, int count);

double line_length_mm(std::span<const glm::dvec3> point_mm);

/// Radius of the line's tightest bend; infinite if it is straight.
double tightest_bend_mm(std::span<const glm::dvec3> point_mm);

/// Smallest distance of two places of the line with more than `apart_mm` of it between them;
/// infinite if it is shorter than that.
double nearest_return_mm(std::span<const glm::dvec3> point_mm, double apart_mm);

} // namespace bake
