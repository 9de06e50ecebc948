// tissue/baseline/run.h
// Steps of any method of this folder, many or until it rests. Called by studies and tests.
#pragma once

#include "tissue/baseline/baseline.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace tissue {

/// `steps` from `state`: the last report.
template <typename Model>
BaselineReport run(const Model& model, std::span<const glm::dvec3> load_n, double dt_s, int steps,
                   BaselineState& state) {
    auto scratch = make_scratch(model);
    BaselineReport report;
    for (int i = 0; i < steps; ++i)
        report = step(model, load_n, dt_s, scratch, state);
    return report;
}

/// Not a number if one is not.
inline double fastest_mps(const BaselineState& state) {
    double fastest = 0.0;
    for (const glm::dvec3& v : state.velocity_mps) {
        const double speed = glm::length(v);
        if (std::isnan(speed))
            return speed;
        fastest = std::fmax(fastest, speed);
    }
    return fastest;
}

/// Steps from rest until nothing is faster than `still_mps`; no numbers if `most_steps` are not
/// enough, so that no check passes.
template <typename Model>
BaselineState settled(const Model& model, std::span<const glm::dvec3> load_n, double dt_s,
                      double still_mps, int most_steps) {
    auto scratch = make_scratch(model);
    BaselineState state = rest_state(model.body);
    for (int i = 0; i < most_steps; ++i) {
        step(model, load_n, dt_s, scratch, state);
        if (fastest_mps(state) < still_mps)
            return state;
    }
    state.position_m.assign(state.position_m.size(), glm::dvec3{NAN});
    return state;
}

/// One tet on an equilateral base of radius 10 mm, its apex (node 3) above the centroid.
inline TetMesh lone_tet(double height_m) {
    const double r = 0.01, root3 = std::sqrt(3.0);
    return {{{r, 0, 0}, {-r / 2, r * root3 / 2, 0}, {-r / 2, -r * root3 / 2, 0}, {0, 0, height_m}},
            {{0, 1, 2, 3}}};
}
/// Anchors of its base.
inline constexpr std::uint8_t kLoneTetBase[] = {1, 1, 1, 0};

} // namespace tissue
