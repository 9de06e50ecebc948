// See the header.
#include "sim/study/hold_side.h"

#include "sim/session/rehold.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

namespace sim {

using glm::dvec3;

OrganPointer held_organ(OrganPointer organ, const HoldSide& hold) {
    if (hold.toward == dvec3{0.0})
        return organ;
    const dvec3 toward = glm::normalize(hold.toward);
    if (!std::isfinite(glm::length(toward))) {
        throw std::invalid_argument(fmt::format("--hold-toward {} {} {}: accepted: three numbers",
                                                hold.toward.x, hold.toward.y, hold.toward.z));
    }
    if (!(hold.share > 0.0 && hold.share <= 1.0)) {
        throw std::invalid_argument(
            fmt::format("--hold-share {}: accepted: above 0, to 1", hold.share));
    }
    double low = std::numeric_limits<double>::max(), high = -low;
    for (const dvec3& x : organ->surface.rest_m) { // the same for all meshes of an organ
        low = std::min(low, glm::dot(x, toward));
        high = std::max(high, glm::dot(x, toward));
    }
    const double from = high - hold.share * (high - low);
    return std::make_shared<const tissue::BakedOrgan>(
        held_by(*organ, tissue::make_bed(
                            organ->mesh, [&](const dvec3& x) { return glm::dot(x, toward) > from; },
                            hold.length_m)));
}

} // namespace sim
