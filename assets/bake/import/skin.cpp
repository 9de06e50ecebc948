#include "assets/bake/import/skin.h"

#include "assets/bake/import/boundary.h"
#include "assets/bake/import/distance.h"

#include <cmath>

namespace bake {
namespace {

constexpr double kDense = 0.5; // mean edge of a scan over the skin's: coarsened first
constexpr double kRadiiPerEdge = 0.9, kShare = 0.5;
constexpr double kAway = 0.3; // from the surface given, of the skin's edge
constexpr int kTries = 4;
constexpr std::size_t kMostSpots = 300;

double mean_edge_m(const Surface& s) {
    const double each_m2 = area_m2(s) / static_cast<double>(s.triangles.size());
    return std::sqrt(each_m2 * 4.0 / std::sqrt(3.0)); // of equilateral triangles
}

Surface try_skin(const Surface& given, const Surface& shape, double skin_m, RemeshOptions keep) {
    keep.rounds = 5;
    const Surface even = remesh(
        shape, [skin_m](const glm::dvec3&) { return skin_m; }, keep);
    const SizeAt by_shape = curvature_size(even, skin_m, kRadiiPerEdge, kShare);
    keep.rounds = RemeshOptions{}.rounds;
    std::vector<FineSpot> spots;
    for (int tries = 0;; ++tries) {
        const SizeAt size = with_spots(by_shape, spots);
        Surface skin = remesh(shape, size, keep);
        std::vector<glm::dvec3> places;
        add_far_places(given, skin, kAway * skin_m, places);
        if (places.empty() || tries == kTries || places.size() > kMostSpots) {
            return skin;
        }
        add_spots(places, size, spots);
    }
}

std::string problem_of(const Surface& s, std::size_t shells) {
    SurfaceProblems problems = check_surface(s);
    problems.shells = problems.shells == static_cast<int>(shells) ? 1 : problems.shells;
    const auto lines = describe(problems);
    return lines.empty() ? "" : lines.front();
}

} // namespace

Surface make_skin(const Surface& given, double skin_m, std::size_t shells,
                  const RemeshOptions& keep) {
    const Surface shape =
        mean_edge_m(given) < kDense * skin_m ? coarsen(given, kDense * skin_m) : given;
    std::string problem;
    for (const double share : {1.0, 0.8, 1.25, 0.6}) {
        Surface skin = try_skin(given, shape, share * skin_m, keep);
        problem = problem_of(skin, shells);
        if (problem.empty()) {
            return skin;
        }
    }
    throw ImportRefused(
        fmt::format("no skin with edges of {:.3g} mm can be made: {}", 1e3 * skin_m, problem));
}

} // namespace bake
