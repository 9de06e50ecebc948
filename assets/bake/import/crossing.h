// assets/bake/import/crossing.h
// Triangles of a surface that cross or touch each other without being neighbours, by exact
// orientation tests (Shewchuk's predicates, as TetGen carries them). Called by import on what was
// given, and on every surface before TetGen sees it.
#pragma once

#include "assets/bake/import/notes.h"
#include "assets/bake/surface.h"

namespace bake {

struct Crossing {
    std::uint32_t a = 0, b = 0; // triangles, a < b
    glm::dvec3 at_m{0.0};       // between them
};

/// In order of a, then b; at most `most`. Triangles that share an edge cross if they are folded
/// onto each other; triangles that share a corner if they meet elsewhere too.
std::vector<Crossing> find_crossings(const Surface& surface, std::size_t most);

/// "12 triangles cross others in 2 places: (..) mm, (..) mm"; empty if none do. At most four places
/// are named, the one with most triangles first.
std::string describe(const std::vector<Crossing>& crossings, double apart_m, const Notes& notes);

} // namespace bake
