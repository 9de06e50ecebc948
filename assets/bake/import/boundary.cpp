#include "assets/bake/import/boundary.h"

#include "assets/bake/fit.h"
#include "assets/bake/import/crossing.h"
#include "assets/bake/import/distance.h"

#include <algorithm>

namespace bake {
namespace {

constexpr int kTries = 8;
constexpr int kFitRounds = 20;
constexpr double kMm = 1e-3;
constexpr std::size_t kMostSpots = 400;
constexpr std::size_t kMostCrossings = 1000;

/// Moves all points along their normals until the volume is right; first order, twice.
void hold_volume(Surface& s, double wanted_m3) {
    for (int round = 0; round < 2; ++round) {
        const double offset_m = (wanted_m3 - volume_m3(s)) / area_m2(s);
        const auto normal = vertex_normals(s);
        for (std::size_t v = 0; v < s.point_m.size(); ++v) {
            s.point_m[v] += offset_m * normal[v];
        }
    }
}

} // namespace

void add_spots(const std::vector<glm::dvec3>& places, const SizeAt& size,
               std::vector<FineSpot>& spots) {
    constexpr double kFiner = 0.65; // of the edge there
    const std::size_t before = spots.size();
    for (const auto& p : places) {
        const double now_mm = size(p) / kMm;
        const bool near_another =
            std::any_of(spots.begin() + static_cast<std::ptrdiff_t>(before), spots.end(),
                        [&](const FineSpot& s) {
                            return glm::length(p / kMm - s.centre_mm) < 0.5 * s.radius_mm;
                        });
        if (!near_another) {
            spots.push_back(
                {.centre_mm = p / kMm, .radius_mm = now_mm, .edge_mm = kFiner * now_mm});
        }
    }
}

namespace {

/// One try, with the places where it went wrong.
Boundary try_boundary(const Surface& skin, const SizeAt& size, const BoundaryOptions& o,
                      const Notes& notes, std::vector<glm::dvec3>& places) {
    Boundary now{.surface = remesh(skin, size, o.keep), .problem = {}};
    Surface unfitted = now.surface; // its points lie on the skin
    fit_to_skin(skin, kFitRounds, o.keep.crease_deg, now.surface);
    hold_volume(now.surface, o.volume_m3);
    auto crossings = find_crossings(now.surface, kMostCrossings);
    if (!crossings.empty()) { // fitting may push sheets through each other
        hold_volume(unfitted, o.volume_m3);
        const auto fewer = find_crossings(unfitted, kMostCrossings);
        if (fewer.size() < crossings.size()) {
            now.surface = std::move(unfitted);
            crossings = fewer;
        }
    }
    for (const auto& c : crossings) {
        places.push_back(c.at_m);
    }
    now.crossings = crossings.size();
    now.problem = describe(crossings, o.edge_m, notes);
    now.distance_m = hausdorff(skin, now.surface).distance_m;
    const double most_m = o.farthest * std::min(o.edge_m, mean_edge_m(now.surface));
    if (now.distance_m > most_m) {
        add_far_places(skin, now.surface, most_m, places);
        add_far_places(now.surface, skin, most_m, places);
        now.problem += now.problem.empty()
                           ? fmt::format("{} from the surface given", notes.length(now.distance_m))
                           : "";
    }
    return now;
}

} // namespace

Boundary make_boundary(const Surface& skin, const SizeAt& by_shape, const BoundaryOptions& o,
                       const Notes& notes) {
    std::vector<FineSpot> spots = o.fine;
    Boundary best;
    for (int tries = 1; tries <= kTries; ++tries) {
        const SizeAt size = with_spots(by_shape, spots);
        std::vector<glm::dvec3> places;
        Boundary now = try_boundary(skin, size, o, notes, places);
        const bool better = now.crossings != best.crossings ? now.crossings < best.crossings
                                                            : now.distance_m < best.distance_m;
        const bool good = now.problem.empty();
        if (best.tries == 0 || better || good) {
            best = std::move(now);
        }
        best.tries = tries;
        if (good || places.empty() || spots.size() > kMostSpots) {
            break;
        }
        add_spots(places, size, spots);
    }
    return best;
}

} // namespace bake
