// sim/study/solid_effort.h
// What a step of a tissue model, or its way to rest, took and left. Studies.
#pragma once

#include <limits>

namespace sim {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Not a number: the model does not know it.
struct SolidEffort {
    int newton = 0, linear = 0;        // iterations
    int substeps = 0;                  // of the baselines
    double linear_residual = kUnknown; // |A x - b| / |b|
    double residual = kUnknown;        // of all equations, relative to all forces that take part
    bool converged = true;             // as the model itself means it
};

} // namespace sim
