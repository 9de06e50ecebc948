// tests/tissue/organ_bytes.h
// A small organ to write, and the means to change what was written: the hash at the end, and what
// a reader says. Used by the tests of the organ file.
#pragma once

#include "tissue/mesh/baked_organ.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace organ_bytes {

inline constexpr std::size_t kHashSize = 8;
// of an organ without a line: four counts and the bed
inline constexpr std::size_t kLineSize = 4 * 8 + 8;
// of four vertices: a count and six numbers for each
inline constexpr std::size_t kLeanSize = 8 + 4 * 6 * 8;

// One tetrahedron with its four faces as skin, rows of one or two nodes.
inline tissue::BakedOrgan small_organ() {
    tissue::BakedOrgan o;
    o.name = "probe";
    o.mesh.rest_m = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}};
    o.mesh.tets = {{0, 1, 2, 3}};
    o.anchored = {1, 0, 1, 1};
    o.bed = {{0, {0.1, 0.2, 0.3, 0.4}, 0.5}, {0, {0.7, 0.1, 0.1, 0.1}, 0.25}};
    o.surface.rest_m = o.mesh.rest_m;
    o.surface.triangles = tissue::boundary_triangles(o.mesh);
    o.surface.neighbours = tissue::triangle_neighbours(o.surface.triangles);
    o.surface.row_start = {0, 1, 3, 4, 5};
    o.surface.row_node = {0, 1, 2, 2, 3};
    o.surface.row_weight = {1.0, 0.25, 0.75, 1.0, 1.0};
    o.surface.offset_m = {{0, 0, 1e-3}, {0, 1e-3, 0}, {1e-3, 0, 0}, {-1e-3, 0, 0}};
    o.surface.frame_node = {{0, 1, 2}, {1, 2, 3}, {2, 3, 0}, {3, 0, 1}};
    o.surface.footprint_radius_m = {4e-3, 5e-3, 6e-3, 7e-3};
    o.surface.thickness_m = {1e-2, 2e-2, 3e-2, 4e-2};
    o.surface.mesh_term_n_m = {1, 2, 3, 4};
    o.surface.mesh_term_t_m = {5, 6, 7, 8};
    o.surface.mesh_lean_m = {
        {.1, .2, .3, .4, .5, .6}, {}, {-.1, 0, .1, 0, 0, 0}, {0, 0, 0, 1, 2, 3}};
    o.material.young_pa = 1234.5;
    o.material.source = "made up";
    o.recipe_hash = 0x0123456789ABCDEFULL;
    return o;
}

// FNV-1a, 64 bit (Fowler, Noll & Vo 1991), written a second time.
inline std::uint64_t fnv(std::span<const std::byte> bytes) {
    std::uint64_t hash = 14695981039346656037ULL;
    for (const auto b : bytes) {
        hash ^= std::to_integer<std::uint64_t>(b);
        hash *= 1099511628211ULL;
    }
    return hash;
}

inline void sign(std::vector<std::byte>& bytes) {
    const std::uint64_t hash = fnv(std::span(bytes).first(bytes.size() - kHashSize));
    for (std::size_t i = 0; i < kHashSize; ++i) {
        bytes[bytes.size() - kHashSize + i] = static_cast<std::byte>(hash >> (8 * i) & 0xFF);
    }
}

inline std::string refusal(const std::vector<std::byte>& bytes) {
    try {
        tissue::read_organ(bytes);
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
    return "";
}

} // namespace organ_bytes
