// tests/tissue/bodies.h
// Bodies and small helpers shared by the tests of the corotated solver.
#pragma once

#include "tissue/solver/corotated.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>

namespace bodies {

inline constexpr double kStatics = std::numeric_limits<double>::infinity();

/// Undamped unless said, so that closed forms hold.
inline tissue::Material elastic(double young_pa, double poisson, double density_kgpm3 = 1000.0) {
    return {.young_pa = young_pa,
            .poisson = poisson,
            .density_kgpm3 = density_kgpm3,
            .damping_mass_1ps = 0.0,
            .damping_stiffness_s = 0.0,
            .source = "test"};
}

/// 1 for every node where `chosen(rest position)`.
template <typename Where>
std::vector<std::uint8_t> anchors(const tissue::TetMesh& mesh, Where chosen) {
    std::vector<std::uint8_t> flags;
    for (const glm::dvec3& x : mesh.rest_m)
        flags.push_back(chosen(x) ? 1 : 0);
    return flags;
}

/// Uniform in [-1, 1).
inline double signed_unit(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11) * 0x1p-52 - 1.0;
}
inline glm::dvec3 signed_vector(std::mt19937_64& random) {
    const double x = signed_unit(random), y = signed_unit(random), z = signed_unit(random);
    return {x, y, z};
}
inline glm::dmat3 rotation(const glm::dvec3& axis, double angle_rad) {
    return glm::mat3_cast(glm::angleAxis(angle_rad, glm::normalize(axis)));
}

inline std::vector<double> random_unknowns(const tissue::CorotatedModel& model, unsigned seed) {
    std::mt19937_64 random(seed);
    std::vector<double> v(static_cast<std::size_t>(model.unknowns));
    for (double& x : v)
        x = signed_unit(random);
    return v;
}

/// Moves the free nodes by `scale * d`.
inline tissue::CorotatedState moved(const tissue::CorotatedModel& model,
                                    tissue::CorotatedState state, const std::vector<double>& d,
                                    double scale) {
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        const int k = model.dof[i];
        if (k >= 0)
            state.position_m[i] += scale * glm::dvec3{d[k], d[k + 1], d[k + 2]};
    }
    return state;
}

inline double norm(const std::vector<double>& v) {
    double sum = 0.0;
    for (const double x : v)
        sum += x * x;
    return std::sqrt(sum);
}
inline double inner(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
    return sum;
}

/// One step without contact.
inline tissue::StepReport step(const tissue::CorotatedModel& model, tissue::CorotatedState& state,
                               tissue::CorotatedSystem& system, double dt_s, bool exact = true) {
    std::vector<double> du(static_cast<std::size_t>(model.unknowns));
    tissue::linearize(model, state, dt_s, system, exact);
    const tissue::StepReport report = tissue::free_motion(model, state, system, du);
    tissue::advance(model, du, dt_s, state);
    return report;
}

inline double kinetic_energy_j(const tissue::CorotatedModel& model,
                               const tissue::CorotatedState& state) {
    double sum = 0.0;
    for (std::size_t i = 0; i < model.mass_kg.size(); ++i) {
        sum += 0.5 * model.mass_kg[i] * glm::dot(state.velocity_mps[i], state.velocity_mps[i]);
    }
    return sum;
}

} // namespace bodies
