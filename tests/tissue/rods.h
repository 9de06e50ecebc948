// tests/tissue/rods.h
// Rods that tests bend: along x or a circle, clamped by two held nodes.
#pragma once

#include "tissue/rod/rod.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace rods {

inline constexpr double kStatics_s = std::numeric_limits<double>::infinity();

inline tissue::Material elastic(double young_pa = 30e3) {
    return {.young_pa = young_pa,
            .poisson = 0.45,
            .density_kgpm3 = 1050.0,
            .damping_mass_1ps = 0.0,
            .damping_stiffness_s = 0.0,
            .friction = 0.0,
            .source = "test"};
}

/// From -L/n, held as the node at 0 is, to L, in n free edges; `both`: clamped beyond L, too.
struct Straight {
    double length_m = 0.1, radius_m = 3e-3;
    int edges = 20;
    bool both = false;
};

inline tissue::RodModel straight(const Straight& s, const tissue::Material& material = elastic()) {
    std::vector<glm::dvec3> node_m;
    std::vector<std::uint8_t> held;
    for (int i = -1; i <= s.edges + (s.both ? 1 : 0); ++i) {
        node_m.emplace_back(s.length_m * i / s.edges, 0.0, 0.0);
        held.push_back(i < 1 || (s.both && i >= s.edges) ? 1 : 0);
    }
    const std::array section{tissue::round_section(material, s.radius_m)};
    return tissue::make_rod(node_m, section, material, held, glm::dvec3{0.0});
}

/// `force_n` on a node.
inline std::vector<double> load_at(const tissue::RodModel& model, std::size_t node,
                                   const glm::dvec3& force_n) {
    std::vector<double> load_n(static_cast<std::size_t>(model.unknowns), 0.0);
    for (int k = 0; k < 3; ++k)
        load_n[static_cast<std::size_t>(model.dof[node] + k)] = force_n[k];
    return load_n;
}

/// One step, of statics too; velocities are those of the step.
inline tissue::RodReport step(const tissue::RodModel& model, double dt_s,
                              std::span<const double> load_n, tissue::RodSystem& system,
                              tissue::RodState& state, double tolerance = 1e-7) {
    std::vector<double> du(static_cast<std::size_t>(model.unknowns));
    linearize(model, state, dt_s, system);
    free_motion(model, system, load_n, du);
    return end_step(model, load_n, {.tolerance = tolerance, .max_iterations = 100}, du, system,
                    state);
}

} // namespace rods
