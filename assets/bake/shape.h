// assets/bake/shape.h
// The shapes a recipe can describe, as numbers. Millimetres and degrees as the recipe writes them;
// everything that leaves a shape is in metres. World frame: x to the patient's left, y cranial,
// z ventral, towards the camera.
#pragma once

#include "assets/bake/polygonise.h"
#include "assets/bake/surface.h"

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>

namespace bake {

/// Turns about x, then y, then z.
glm::dmat3 turn(const glm::dvec3& tilt_deg);

struct Ellipsoid {
    glm::dvec3 centre_mm{0.0};
    glm::dvec3 radius_mm{1.0};
    glm::dvec3 tilt_deg{0.0}; // turned about x, then y, then z
    double blend_mm = 0.0;    // rounding where it is joined (lobe) or cut out (hollow)
};

/// Ellipsoids joined in order, then others cut out in order, then gentle seeded noise.
struct LobedShape {
    std::vector<Ellipsoid> lobes, hollows;
    double noise_mm = 0.0, noise_wavelength_mm = 30.0;
    std::uint64_t seed = 1;
};
Field lobed_field(const LobedShape& shape);
/// A box around all lobes, with room for the noise.
std::array<glm::dvec3, 2> lobed_bounds_m(const LobedShape& shape);

/// The inner side of an insufflated abdomen: part of an ellipsoid, open towards +z, normals
/// inwards.
struct VaultShape {
    glm::dvec3 centre_mm{0.0};
    glm::dvec3 radius_mm{1.0};
    double opening_deg = 90.0; // from the pole at -z to the rim
    double noise_mm = 0.0, noise_wavelength_mm = 60.0;
    std::uint64_t seed = 1;
};
Surface vault_surface(const VaultShape& shape, double edge_m);

/// Closed surface of the box [0, size], even squares of two triangles.
Surface box_surface(const glm::dvec3& size_m, double edge_m);
/// Its top face (z = size.z) alone: an open surface.
Surface box_top(const glm::dvec3& size_m, double edge_m);

/// Smooth noise in [-1, 1] with about this wavelength; the same seed gives the same noise.
double smooth_noise(const glm::dvec3& p_mm, double wavelength_mm, std::uint64_t seed);

} // namespace bake
