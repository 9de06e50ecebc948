// tissue/baseline/hinged.h
// A row of tets that meet in single nodes, so that nothing but tension holds it straight: a taut
// string and a hanging chain, whose answers are closed forms. Called by studies and tests.
//   Hinge k is node 3k. Nodes 3k+1 and 3k+2 stand off the middle of the link behind it, turn with
//   it and carry nothing. With nu = 0 a link has V = l offset^2/6 and stretches by f l^2/(E V).
#pragma once

#include "tissue/solver/corotated.h"

namespace tissue {

/// `links` from the origin along x. Lengths > 0.
TetMesh hinged_links(int links, double link_m, double offset_m);

/// Largest distance of a hinge from the x axis; not a number if one is not.
double sag_m(std::span<const glm::dvec3> position_m);

/// Free masses under tension between two held ends. Stretched, not bent, it moves to the side as
/// beads on a string: w_max^2 = 4 T/(m l) sin^2(pi n/(2 (n + 1))).
struct TautString {
    int free_nodes = 15;
    double spacing_m = 0.02, mass_kg = 1e-3, tension_n = 1.0;
    double young_pa = 2e7, offset_m = 0.01;
};
/// 2/w_max: what moves to the side without stiffness in the matrix diverges beyond it.
double critical_step_s(const TautString& string);
/// Of the links at rest, so that they have the tension at the spacing.
double rest_length_m(const TautString& string);

struct HingedRow {
    CorotatedModel model;
    CorotatedState state;
};
/// Hinges start up to `kick_m` aside in y, the links turned with them.
HingedRow taut_string(const TautString& string, double kick_m, std::uint64_t seed);

/// Masses on links of compliance alpha, hung up by the first, along x: gravity is too.
struct HangingChain {
    int links = 20;
    double link_m = 0.05, mass_kg = 0.01, compliance_mpn = 1e-4, gravity_mps2 = 9.81;
    double offset_m = 0.01;
};
/// alpha m g n (n + 1)/2.
double hanging_stretch_m(const HangingChain& chain);
/// Of links with this compliance.
double young_pa(const HangingChain& chain);
/// Straight and not yet stretched.
HingedRow hanging_chain(const HangingChain& chain);

} // namespace tissue
