// sim/study/reference_press.h
// One press of a tip into an organ by the reference solver: quadratic tetrahedra refined around the
// place and laid there on the skin that the trainer's tools touch, for a first touch of
// millinewtons feels a facet and not the organ (onto_skin.h); neo-Hooke, Coulomb friction, the
// organ's own bed. Called by the organ study; slow.
//
// What its mesh costs in accuracy, on a block of 40 tip radii, stuck, nu 0.45, beside
// half_space_press.h (tests/tissue/finite_sphere_test.cpp): + 1 % force at 1 radius, 2 % at 3, 5 %
// at 6.7, where the stiffness is 9 % too great, 2 of which are the block's size. What coarser tets
// leave out there is under the tip rather than around it: edges of 0.5 radii within 1.5 of the
// place, with a seventh fewer nodes, are 6 and 17 % off; 0.4 within 0.6 of the line, with a fifth
// more, 4 and 5 %.
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
    double core_share = 0.7;     // how far around the line below the place, of the radius
    double down_share = 0.6;     // length of that line, of the greatest depth
    double step_share = 0.5;     // greatest step of depth, of the radius
    bool onto_skin = true;       // lay the facets around the place on the organ's skin
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

/// Along `into` (unit) through the point of the skin, or else of the facets, nearest to `place_m`;
/// depth 0 is where the tip first touches. `progress` (may be empty) gets depths with an
/// equilibrium, and the force. Throws std::invalid_argument for an organ that nothing holds, one
/// whose facets cannot be laid on its skin, and for bad options.
ReferencePress
press_reference(const tissue::BakedOrgan& organ, const tissue::Material& material,
                const glm::dvec3& place_m, const glm::dvec3& into,
                const ReferencePressOptions& options,
                const std::function<void(double depth_m, double force_n)>& progress = {});

} // namespace sim
