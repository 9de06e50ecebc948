// assets/bake/remesh.h
// Even, well-shaped triangles on a given shape: split long edges, collapse short ones, flip
// towards six neighbours, relax in the tangent plane, put back on the shape (Botsch & Kobbelt
// 2004), with a wanted edge length that may vary. Creases and corners stay.
#pragma once

#include "assets/bake/surface.h"

namespace bake {

struct RemeshOptions {
    int rounds = 12;
    double crease_deg = 180.0; // edges that bend by more are creases; 180: none
    double tip_deg = 0.0;      // points whose angles sum up to less are tips, and stay; 0: none
};

/// `shape` must be closed and manifold (check_surface); the result is too.
Surface remesh(const Surface& shape, const SizeAt& size, const RemeshOptions& options);

/// Collapses edges shorter than `edge_m` onto points that are there, as long as no triangle turns
/// by more than 60 degrees: far fewer triangles, quickly, from a scan that is finer than wanted.
Surface coarsen(const Surface& shape, double edge_m);

/// Wanted edge length: `edge_m`, but no longer than `radii` times the smallest radius of
/// curvature of `shape`, never below share * edge_m; grows by at most 0.5 per unit of distance.
SizeAt curvature_size(const Surface& shape, double edge_m, double radii, double share);

/// A size for every point of `shape`, made to grow by at most 0.5 per unit of distance along it,
/// and interpolated from the nearest place on it.
SizeAt graded_size(const Surface& shape, std::vector<double> size_m);

} // namespace bake
