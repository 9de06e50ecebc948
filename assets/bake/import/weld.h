// assets/bake/import/weld.h
// Soup to connected triangles: equal points become one, triangles without area and doubles go,
// points that lie on another triangle's edge are joined to it. Called by clean.
#pragma once

#include "assets/bake/import/notes.h"
#include "assets/bake/import/soup.h"
#include "assets/bake/surface.h"

namespace bake {

/// Points nearer than this times the body's diagonal are one, where edges are open: about ten
/// steps of a 32-bit float.
inline constexpr double kWeldShare = 1e-6;

/// In metres; points that are equal bit for bit become one.
Surface weld_equal(const Soup& soup, double unit_m);

/// Triangles with two equal corners or without any area, and doubles: of equal triangles one stays;
/// of a surface given twice, once from each side, one side stays.
void drop_useless(Surface& surface, Notes& notes);

/// Joins points of open edges that are nearer than the tolerance to each other, then splits open
/// edges where such a point lies on them (T-junctions).
void close_seams(Surface& surface, Notes& notes);

} // namespace bake
