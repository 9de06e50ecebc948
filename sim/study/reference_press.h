// sim/study/reference_press.h
// One press of a tip into an organ by the reference solver: quadratic tetrahedra refined around the
// place, neo-Hooke, Coulomb friction, the organ's own bed. Called by the organ study; slow.
// With edges of 0.8 tip radii within 0.8 of the place it is stiffer than half_space_press.h (stuck,
// nu 0.45, a block of 40 radii) by 1 % to 2 radii, 3 % at 4, 6 % at 5, 9 % at 6 and 12 % at 6.7;
// with edges of 0.55 by 0, 1, 2, 4 and 5 %. A tip that sticks draws skin in from farther out: with
// edges of 0.5 within 1.5 radii the liver's forces at 6.7 radii are 4 to 5 % less than with the
// former. So it is the deepest stiffness that is least certain: on that block 17 % too great at 6.7
// radii, of which the block's size is 2; 9 % with edges of 0.4 within 2 radii
// (tests/tissue/finite_sphere_test.cpp).
#pragma once

#include "tissue/mesh/baked_organ.h"

#include <functional>
#include <string>

namespace sim {

struct ReferencePressOptions {
    double radius_m = 1.5e-3;    // of the tip, a hemisphere on a shaft
    double friction = 0.1;       // Coulomb coefficient
    std::vector<double> depth_m; // ascending
    double edge_share = 0.5;     // longest edge under the tip, of the radius
    double core_share = 1.5;     // how far around the place edges are that short, of the radius
    double step_share = 0.5;     // greatest step of depth, of the radius
};

struct ReferencePress {
    std::vector<glm::dvec3> force_n{}; // on the tip, for each depth that was reached
    double reached_m = 0.0;            // last depth with an equilibrium
    double penetration_m = 0.0;        // greatest that contact left
    double least_det_f = 1.0;          // at the last depth
    int nodes = 0, tets = 0, iterations = 0;
    double cpu_s = 0.0;
    std::string stopped{}; // where and why, if not at the last depth
};

/// Along `into` (unit) through the point of the body's facets nearest to `place_m`; depth 0 is
/// where the tip first touches. `progress` (may be empty) gets depths with an equilibrium, and the
/// force. Throws std::invalid_argument for an organ that nothing holds and for bad options.
ReferencePress
press_reference(const tissue::BakedOrgan& organ, const tissue::Material& material,
                const glm::dvec3& place_m, const glm::dvec3& into,
                const ReferencePressOptions& options,
                const std::function<void(double depth_m, double force_n)>& progress = {});

} // namespace sim
