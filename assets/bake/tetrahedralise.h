// assets/bake/tetrahedralise.h
// A closed surface to tetrahedra by TetGen (Si 2015), in a child process with a time limit. The
// surface is kept as it is; points are added inside only. Called by bake.
#pragma once

#include "assets/bake/surface.h"

#include <optional>
#include <string>

namespace bake {

struct TetOptions {
    double edge_m = 0.013; // inside; bounds the volume of a tetrahedron
    double quality_ratio = 1.2;
    double quality_dihedral_deg = 15.0;
    double time_limit_s = 60.0;            // of each attempt
    std::vector<glm::dvec3> cavity_m = {}; // a place in each cavity, which stays empty
};

struct TetAttempt {
    std::string what, outcome;
    double seconds = 0.0;
};
struct TetAnswer {
    std::optional<tissue::TetMesh> mesh; // none: refused, the attempts say why
    std::vector<TetAttempt> attempts;
    std::string problem; // of the surface, if one was found after the last attempt failed
};

/// The asked quality; then coarser; then without quality; then it refuses.
TetAnswer tetrahedralise(const Surface& boundary, const TetOptions& options);

} // namespace bake
