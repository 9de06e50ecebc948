// tasks/exercise/follow_path.h
// Draw along a curve on the tissue from its first point to its last, in contact, with gentle force.
// The curve runs through the exercise's places (path_curve.h) and moves with the tissue.
//
// Distance from the curve is taken along the surface, not into the dimple that a press makes.
// Followed: the tool's tip touches within `radius_m` of the curve, at a place not more than
// kAhead_m beyond what was followed before; so the curve is followed in order, and what was left
// has to be taken up where it was left. Covered: the same with the force inside the band. Begun:
// the force in the band within `radius_m` of the first point. Complete: followed to within half a
// radius of the last, and in the band there.
//   path_left      touching, was on the curve in this contact, and out of the radius for 0.1 s
//   order_broken   touching the curve 0.2 s long where its turn has not come
//   off_target     a contact away from the curve;  wrong_role  another tool on the curve
//   a break        0.1 s without following, between begin and end; lifting is no error, but a break
#pragma once

#include "tasks/exercise/progress.h"

namespace tasks {

inline constexpr double kAhead_m = 6e-3;

void observe_path(Progress& progress, const Exercise& exercise, const Observation& seen);

} // namespace tasks
