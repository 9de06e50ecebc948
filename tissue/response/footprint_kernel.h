// tissue/response/footprint_kernel.h
// Where the kernel of one contact lies on a body: its radius and its sample points. Shared by the
// rows (footprint.cpp) and the mesh term (mesh_term.cpp), which must use the same points. Bake
// time, any thread.
#pragma once

#include "tissue/response/boundary_tree.h"
#include "tissue/response/footprint.h"

#include <glm/mat3x3.hpp>

namespace tissue {

/// A tangent-plane point that found the body, and its share of the kernel.
struct KernelSample {
    BoundaryPoint at;
    double share;
};

/// With 3 rings a fine skin over coarse tets (h a third of r) feels 36 single points: 7 % too soft.
inline constexpr int kKernelRings = 5;

/// Points around `centre_m` in the plane across `normal` (unit), 6, 12, 18 .. on the rings, carried
/// along the normal onto the boundary where it faces the same way. Points off the body are left
/// out; the shares of the rest sum to 1. If none is left: the nearest boundary point.
std::vector<KernelSample> kernel_samples(const BoundaryTree& tree, const glm::dvec3& centre_m,
                                         const glm::dvec3& normal, double radius_m, double reach_m,
                                         int rings = kKernelRings);

/// The boundary below or above a place: along the normal where it faces the same way, within
/// `reach_m`; else the nearest.
BoundaryPoint point_below(const BoundaryTree& tree, const glm::dvec3& place_m,
                          const glm::dvec3& normal, double reach_m);

/// r = max(1.3175 a, min(c h, max(s, h/2))), s: distance in the tangent plane at which the body
/// ends or has turned away. `size_m` is h here.
double kernel_radius_m(const BoundaryTree& tree, const glm::dvec3& centre_m,
                       const glm::dvec3& normal, double size_m, const FootprintOptions& options);

/// How far along the normal a sample may lie from the tangent plane.
double kernel_reach_m(double size_m, const FootprintOptions& options);

/// Two unit vectors across a unit normal, and the normal: columns.
glm::dmat3 tangent_frame(const glm::dvec3& normal);

/// Area-weighted unit normals of the nodes of a surface; (0,0,0) where it has no area.
std::vector<glm::dvec3> vertex_normals(std::span<const glm::dvec3> position_m,
                                       std::span<const Triangle> triangles);

} // namespace tissue
