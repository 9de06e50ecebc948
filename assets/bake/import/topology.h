// assets/bake/import/topology.h
// Which triangle lies across each edge, for triangles of any kind: OpenMesh holds manifolds only,
// and what is not one must be found and mended first. Called by clean and by the hole filler.
//
// Half edge 3 t + k runs from corner k of triangle t to its next corner.
#pragma once

#include "assets/bake/surface.h"

#include <optional>

namespace bake {

inline std::uint32_t from_point(const Surface& s, std::size_t half) {
    return s.triangles[half / 3][half % 3];
}
inline std::uint32_t to_point(const Surface& s, std::size_t half) {
    return s.triangles[half / 3][(half % 3 + 1) % 3];
}

struct Topology {
    std::vector<std::int32_t> twin;            // of every half edge, -1: none
    std::size_t open_edges = 0;                // without a twin
    std::size_t shared_edges = 0;              // of more than two triangles, paired around the edge
    std::size_t turned = 0;                    // triangles that were turned over
    std::optional<std::uint32_t> one_sided_at; // a triangle where orientation contradicts itself
};

/// Turns triangles over so that neighbours agree (as few as possible in each piece), pairs the
/// triangles at every edge, and gives each fan of triangles its own point, so that the result is a
/// manifold, perhaps open, perhaps of many pieces. Triangles must have three different corners.
Topology make_manifold(Surface& surface);

/// Connected pieces: number of the piece of every triangle, from 0, by first triangle.
std::vector<std::uint32_t> pieces(const Topology& topology, std::size_t& count);

/// Splits a surface: triangle t goes to part `part[piece[t]]`, or nowhere if that is negative.
std::vector<Surface> split(const Surface& surface, const std::vector<std::uint32_t>& piece,
                           const std::vector<std::int32_t>& part, std::size_t parts);

/// One surface of several, in their order.
Surface joined(const std::vector<const Surface*>& parts);

} // namespace bake
