// sim/session/rehold.h
// An organ held otherwise than it was baked. What its tetrahedra owe under a fingertip
// (tissue/response/mesh_term.h) includes what they owe around the held region, so it changes with
// the hold: a spleen held along the wall instead of by its hilum alone would feel 19 % too soft.
// Solving all of it again takes seconds; the change is smooth over the skin, and is solved at some
// hundred vertices and interpolated. Called when a scene is loaded; some tenths of a second.
#pragma once

#include "tissue/mesh/baked_organ.h"

namespace sim {

/// `organ` held by `bed` instead of by its own bed and anchored nodes. An organ that was baked
/// loose is taken to have been given its mesh terms on tissue::weak_bed. Throws
/// std::invalid_argument if the old or the new hold does not hold; an empty `bed` is allowed and
/// leaves the organ afloat.
tissue::BakedOrgan held_by(const tissue::BakedOrgan& organ, std::vector<tissue::BedSample> bed);

/// A rod whose line is held where `inside` says; a bed around it stays.
tissue::BakedOrgan rod_held_by(const tissue::BakedOrgan& organ,
                               const std::function<bool(const glm::dvec3&)>& inside,
                               double length_m);

} // namespace sim
