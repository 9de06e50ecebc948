#include "assets/bake/fine_spot.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace bake {
namespace {

constexpr double kMm = 1e-3;

} // namespace

SizeAt with_spots(SizeAt base, std::vector<FineSpot> spots) {
    if (spots.empty()) {
        return base;
    }
    return [base = std::move(base), spots = std::move(spots)](const glm::dvec3& p_m) {
        double size_m = base(p_m);
        for (const auto& s : spots) {
            const double beyond_mm =
                std::max(0.0, glm::length(p_m / kMm - s.centre_mm) - s.radius_mm);
            size_m = std::min(size_m, kMm * (s.edge_mm + s.growth * beyond_mm));
        }
        return size_m;
    };
}

} // namespace bake
