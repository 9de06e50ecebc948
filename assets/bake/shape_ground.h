// assets/bake/shape_ground.h
// Ground with pits: rigid scenery for what lies on it and in it, open, seen from +z. Called by
// recipe and bake. Pits lie in a flat place, so that a sheet over them rests without a gap.
#pragma once

#include "assets/bake/surface.h"

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

namespace bake {

struct Pit {
    glm::dvec2 centre_mm{0.0}, radius_mm{1.0}; // of the rim, an ellipse
    double depth_mm = 0.0;
    double wall_mm = 1.0; // from the rim inwards to where the floor begins
};

struct GroundShape {
    glm::dvec3 centre_mm{0.0}; // z: of the flat place
    glm::dvec2 size_mm{1.0};
    double bowl_mm = 0.0; // how far the middles of the edges rise
    double flat_mm = 0.0; // no bowl and no noise up to here from a pit's rim
    double noise_mm = 0.0, noise_wavelength_mm = 60.0;
    std::uint64_t seed = 1;
    std::vector<Pit> pits; // where two meet, the deeper one counts
};

/// World z above (x, y).
double ground_height_mm(const GroundShape& shape, const glm::dvec2& place_mm);

/// Edges of edge_m in the plane, half of that abreast of pits, whose walls are steep.
Surface ground_surface(const GroundShape& shape, double edge_m);

/// Distance of p from the ellipse of half axes `radius` around the origin, negative inside.
double ellipse_distance(const glm::dvec2& p, const glm::dvec2& radius);

} // namespace bake
