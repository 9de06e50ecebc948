// tasks/exercise/touch_points.h
// Touch numbered points on the tissue in order, each with its role, gently and long enough.
// Touched: the named tool's tip is within `radius_m` of the target, contact force inside the band,
// without a break, for `hold_s`.
#pragma once

#include "tasks/exercise/progress.h"

namespace tasks {

void observe_points(Progress& progress, const Exercise& exercise, const Observation& seen);

} // namespace tasks
