// tests/tissue/quadratic_bodies.h
// Bodies and helpers shared by the tests of the real-time quadratic solver.
#pragma once

#include "tests/tissue/reference_bodies.h"
#include "tissue/solver/quadratic.h"

namespace quadratic_bodies {

inline std::vector<std::uint8_t> held_at_x0(const tissue::QuadraticMesh& mesh) {
    return reference_bodies::flags(mesh, [](auto x) { return x.x < 1e-9 ? tissue::kHeld : 0; });
}

/// An irregular box with its edge nodes off the middle, so that nothing is straight.
inline tissue::QuadraticMesh curved_box(unsigned seed) {
    auto mesh = reference_bodies::irregular_box({0.1, 0.08, 0.06}, 2, seed);
    std::mt19937_64 random(seed);
    for (glm::dvec3& x : mesh.rest_m)
        x += 1e-3 * bodies::signed_vector(random);
    for (glm::dvec3& x : mesh.rest_m)
        x.x = x.x < 5e-3 ? 0.0 : x.x; // a flat end to hold
    return mesh;
}

/// Bent, stretched and shaken, with det F far from 1 and positive.
inline std::vector<glm::dvec3> bent(const std::vector<glm::dvec3>& rest_m, unsigned seed) {
    std::mt19937_64 random(seed);
    std::vector<glm::dvec3> x;
    for (const glm::dvec3& X : rest_m) {
        const double angle = 5.0 * X.x;
        const double r = 0.2 - 1.25 * (X.y - 0.04);
        x.push_back(glm::dvec3{r * std::sin(angle), 0.2 - r * std::cos(angle), 0.95 * X.z} +
                    2e-4 * bodies::signed_vector(random));
    }
    return x;
}

inline std::vector<glm::dvec3> random_vectors(std::size_t count, double size, unsigned seed) {
    std::mt19937_64 random(seed);
    std::vector<glm::dvec3> v;
    for (std::size_t i = 0; i < count; ++i)
        v.push_back(size * bodies::signed_vector(random));
    return v;
}

/// Newton to rounding: what is left is the single precision of the products.
inline tissue::QuadraticOptions exact() {
    return {.linear_tolerance = 1e-4, .newton_tolerance = 1e-12, .max_newton = 12};
}

inline tissue::QuadraticReport step(const tissue::QuadraticModel& model,
                                    const tissue::QuadraticOptions& options,
                                    tissue::QuadraticSystem& system,
                                    tissue::QuadraticState& state) {
    std::vector<double> du(static_cast<std::size_t>(model.unknowns));
    linearize(model, state, system);
    const auto report = free_motion(model, options, system, du);
    advance(model, system, du, state);
    return report;
}

inline double greatest_distance_m(const std::vector<glm::dvec3>& a,
                                  const std::vector<glm::dvec3>& b) {
    double greatest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        greatest = std::max(greatest, glm::length(a[i] - b[i]));
    return greatest;
}

} // namespace quadratic_bodies
