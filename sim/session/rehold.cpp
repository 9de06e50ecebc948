#include "sim/session/rehold.h"

#include "tissue/response/mesh_term.h"

#include <utility>

namespace sim {

tissue::BakedOrgan held_by(const tissue::BakedOrgan& organ, std::vector<tissue::BedSample> bed) {
    tissue::BakedOrgan held = organ;
    held.bed = std::move(bed);
    held.anchored.assign(organ.mesh.rest_m.size(), 0);
    // only a layer bonded to fixed nodes has a thickness of its own
    held.surface.thickness_m.assign(organ.surface.rest_m.size(), tissue::kUnbacked_m);
    if (!held.bed.empty() && organ.order == 1) { // quadratic shapes owe no term
        tissue::make_mesh_terms(held.mesh, held.material.poisson, held.anchored,
                                {.tip_radius_max_m = held.tip_radius_max_m}, held.surface,
                                held.bed);
    }
    return held;
}

tissue::BakedOrgan rod_held_by(const tissue::BakedOrgan& organ,
                               const std::function<bool(const glm::dvec3&)>& inside,
                               double length_m) {
    tissue::BakedOrgan held = organ;
    tissue::hold_line(inside, length_m, held.line);
    return held;
}

} // namespace sim
