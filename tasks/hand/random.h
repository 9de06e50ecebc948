// tasks/hand/random.h
// Seeded randomness with our own transforms: std::mt19937_64 gives the same bits everywhere, the
// distributions of the standard library do not. Called by the hands; one generator per use.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace tasks {

struct Random {
    std::mt19937_64 engine;
    explicit Random(std::uint64_t seed = 0) : engine(seed) {}

    /// In (0, 1): 53 bits, never an end.
    double uniform() { return (static_cast<double>(engine() >> 11) + 0.5) * 0x1.0p-53; }
    /// Mean 0, standard deviation 1 (Box & Muller 1958); two draws a call, so that what follows
    /// does not depend on how many were asked for before.
    double normal() {
        const double radius = std::sqrt(-2.0 * std::log(uniform()));
        return radius * std::cos(2.0 * std::numbers::pi * uniform());
    }
};

} // namespace tasks
