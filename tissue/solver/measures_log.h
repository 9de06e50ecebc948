// tissue/solver/measures_log.h
// From samples of stress to the shares and the percentile of TissueMeasures. Internal to the
// measures.
#pragma once

#include "tissue/solver/measures.h"

namespace tissue {

/// Peak, percentile and shares from TissueLog::sample and `over`, impulses on the way. Reorders
/// the samples.
void summarise(const DamageLimits& limits, double dt_s, TissueLog& log,
               TissueMeasures& measures) noexcept;

/// Quadratic tissue: samples, `over` now, and the sums. In quadratic_measures.cpp.
TissueMeasures sample_points(const QuadraticModel& model, const QuadraticState& state,
                             const DamageLimits& limits, TissueLog& log) noexcept;

} // namespace tissue
