// sim/session/rehold.h
// An organ held otherwise than it was baked. What its tetrahedra owe under a fingertip
// (tissue/response/mesh_term.h) includes what they owe around the held region, so it changes with
// the hold: a spleen held along the wall instead of by its hilum alone would feel 19 % too soft.
// The change is not smooth: interpolated from 120 vertices it was off by up to 30 % of the
// compliance where the skin has edges, and by four times it at the slender end of a stomach; from
// 400, still by a fifth. So all of it is solved for again. Called when a scene is loaded; some
// seconds for an organ of 500 to 1000 nodes.
#pragma once

#include "tissue/mesh/baked_organ.h"

namespace sim {

/// `organ` held by `bed` instead of by its own bed and anchored nodes. Throws std::invalid_argument
/// if the new hold does not hold; an empty `bed` is allowed and leaves the organ afloat.
tissue::BakedOrgan held_by(const tissue::BakedOrgan& organ, std::vector<tissue::BedSample> bed);

/// A rod whose line is held where `inside` says; a bed around it stays.
tissue::BakedOrgan rod_held_by(const tissue::BakedOrgan& organ,
                               const std::function<bool(const glm::dvec3&)>& inside,
                               double length_m);

} // namespace sim
