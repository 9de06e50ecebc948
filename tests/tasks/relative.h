// tests/tasks/relative.h
// doctest's Approx adds 1 to the scale of its tolerance, which forgives everything in metres.
#pragma once

#include <doctest/doctest.h>

namespace tasks::testing {

/// Equal within `tolerance` of the larger of the two, whatever the unit.
inline doctest::Approx relative(double expected, double tolerance = 1e-9) {
    return doctest::Approx(expected).epsilon(tolerance).scale(0.0);
}

} // namespace tasks::testing
