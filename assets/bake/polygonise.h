// assets/bake/polygonise.h
// An implicit body to a triangle surface: marching tetrahedra, six per cell around the main
// diagonal (Doi & Koide 1991), so that there is no ambiguous case and the result is closed and
// manifold. Called by bake for procedural organs.
#pragma once

#include "assets/bake/surface.h"

namespace bake {

/// Roughly the signed distance to the body in metres, negative inside.
using Field = std::function<double(const glm::dvec3&)>;

/// The zero surface of `field` in the box; throws std::invalid_argument if the body touches the
/// box or is not there.
Surface polygonise(const Field& field, const glm::dvec3& low_m, const glm::dvec3& high_m,
                   double cell_m);

} // namespace bake
