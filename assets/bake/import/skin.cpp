#include "assets/bake/import/skin.h"

#include "assets/bake/import/distance.h"
#include "assets/bake/import/notes.h"
#include "assets/bake/nearest.h"

#include <cmath>
#include <limits>

namespace bake {
namespace {

constexpr double kDense = 0.5; // mean edge of a scan over the skin's: coarsened first
constexpr double kRadiiPerEdge = 0.9, kShare = 0.5;
constexpr double kAway = 0.3;   // from the surface given, of the skin's edge
constexpr double kLoss = 0.2;   // that coarsening may cost, of the skin's edge
constexpr double kFiner = 0.65; // of the edge, where it keeps away
constexpr int kTries = 5;

/// With fewer triangles if it has far more than the skin needs and keeps its thin parts.
Surface lighter(const Surface& given, double skin_m) {
    for (const double share : {1.0, 0.5}) {
        const double edge_m = share * kDense * skin_m;
        if (mean_edge_m(given) < edge_m) {
            Surface coarse = coarsen(given, edge_m);
            if (farthest(given, coarse).distance_m < kLoss * skin_m) {
                return coarse;
            }
        }
    }
    return given;
}

/// Makes the size at the nearest point of `carrier` smaller for every place of `given` that is
/// farther than limit_m from `skin`; true if there was one.
bool refine_far(const Surface& given, const Surface& skin, const Surface& carrier, double limit_m,
                std::vector<double>& size_m) {
    std::vector<glm::dvec3> places;
    add_far_places(given, skin, limit_m, places);
    const NearestOnSurface nearest(carrier);
    std::vector<char> there(size_m.size(), 0);
    for (const auto& p : places) {
        for (const auto v : carrier.triangles[nearest(p).triangle]) {
            there[v] = 1;
        }
    }
    for (std::size_t v = 0; v < size_m.size(); ++v) {
        size_m[v] *= there[v] ? kFiner : 1.0;
    }
    return !places.empty();
}

Surface try_skin(const Surface& given, const Surface& shape, double skin_m, RemeshOptions keep) {
    keep.rounds = 5;
    const Surface even = remesh(
        shape, [skin_m](const glm::dvec3&) { return skin_m; }, keep);
    keep.rounds = RemeshOptions{}.rounds;
    SizeAt size = curvature_size(even, skin_m, kRadiiPerEdge, kShare);
    std::vector<double> size_m;
    for (const auto& p : even.point_m) {
        size_m.push_back(size(p));
    }
    Surface skin = remesh(shape, size, keep);
    for (int tries = 0; tries < kTries; ++tries) {
        if (!refine_far(given, skin, even, kAway * skin_m, size_m)) {
            break;
        }
        skin = remesh(shape, graded_size(even, size_m), keep);
    }
    return skin;
}

std::string problem_of(const Surface& s, std::size_t shells) {
    SurfaceProblems problems = check_surface(s);
    problems.shells = problems.shells == static_cast<int>(shells) ? 1 : problems.shells;
    const auto lines = describe(problems);
    return lines.empty() ? "" : lines.front();
}

} // namespace

Surface make_skin(const Surface& given, double skin_m, double away_m, std::size_t shells,
                  const RemeshOptions& keep) {
    const Surface shape = lighter(given, skin_m);
    std::string problem;
    Surface best;
    double least_m = std::numeric_limits<double>::max();
    for (const double share : {1.0, 0.7, 1.25}) {
        Surface skin = try_skin(given, shape, share * skin_m, keep);
        problem = problem_of(skin, shells);
        const double now_m = hausdorff(given, skin).distance_m;
        if (problem.empty() && now_m < least_m) {
            best = std::move(skin);
            least_m = now_m;
        }
        if (least_m <= away_m) {
            break;
        }
    }
    if (best.triangles.empty()) {
        throw ImportRefused(
            fmt::format("no skin with edges of {:.3g} mm can be made: {}", 1e3 * skin_m, problem));
    }
    return best;
}

} // namespace bake
