// assets/bake/import/organ_body.h
// One body to one organ: skin, boundary, tetrahedra, footprints. Called by import.
#pragma once

#include "assets/bake/import/import.h"
#include "assets/bake/import/phase_clock.h"

namespace bake {

struct BodyPlan {
    std::string name;
    double edge_m = 0.0;
    std::uint64_t hash = 0; // of the file, the options and the version
};

/// `seen`: the triangles of the file that bound the body, to measure distances from. Throws
/// ImportRefused, saying which step failed and where.
ImportedBody make_organ(const Body& body, const Surface& seen, const BodyPlan& plan,
                        const ImportOptions& options, const Notes& notes, PhaseClock& clock);

} // namespace bake
