#include "sim/session/rehold.h"

#include "tissue/response/mesh_term.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

namespace sim {
namespace {

using glm::dvec3;

constexpr std::size_t kProbes = 40; // triangles of the skin, three vertices each
constexpr std::size_t kNearest = 6; // probed vertices that a vertex is interpolated from

// Triangles spread over the skin: each the farthest from those before it.
std::vector<tissue::Triangle> spread(const tissue::ContactSurface& skin) {
    const auto centre = [&](const tissue::Triangle& t) {
        return (skin.rest_m[t[0]] + skin.rest_m[t[1]] + skin.rest_m[t[2]]) / 3.0;
    };
    std::vector<double> far_m(skin.triangles.size(), std::numeric_limits<double>::max());
    std::vector<tissue::Triangle> out;
    std::size_t next = 0;
    while (out.size() < std::min(kProbes, skin.triangles.size())) {
        out.push_back(skin.triangles[next]);
        const dvec3 from = centre(out.back());
        for (std::size_t t = 0; t < far_m.size(); ++t)
            far_m[t] = std::min(far_m[t], glm::distance(from, centre(skin.triangles[t])));
        next =
            static_cast<std::size_t>(std::max_element(far_m.begin(), far_m.end()) - far_m.begin());
    }
    return out;
}

// The skin's probed vertices alone; triangles that share one get their own copies of it.
tissue::ContactSurface probes_of(const tissue::ContactSurface& skin) {
    tissue::ContactSurface probes;
    for (const tissue::Triangle& t : spread(skin)) {
        const auto first = static_cast<std::uint32_t>(probes.rest_m.size());
        probes.triangles.push_back({first, first + 1, first + 2});
        for (const std::uint32_t v : t) {
            probes.rest_m.push_back(skin.rest_m[v]);
            probes.footprint_radius_m.push_back(skin.footprint_radius_m[v]);
        }
    }
    probes.mesh_term_n_m.resize(probes.rest_m.size());
    probes.mesh_term_t_m.resize(probes.rest_m.size());
    return probes;
}

struct Term {
    double normal_m = 0.0, tangential_m = 0.0;
};

// Shepard's mean of the nearest probes.
Term interpolated(const std::vector<dvec3>& place_m, const std::vector<Term>& change,
                  const dvec3& at_m) {
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t i = 0; i < place_m.size(); ++i) {
        const dvec3 d = place_m[i] - at_m;
        near.emplace_back(glm::dot(d, d), i);
    }
    const std::size_t count = std::min(kNearest, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
    constexpr double kSame_m2 = 1e-12;
    Term sum;
    double weights = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        const auto [square_m2, i] = near[k];
        const double weight = 1.0 / (square_m2 + kSame_m2);
        weights += weight;
        sum.normal_m += weight * change[i].normal_m;
        sum.tangential_m += weight * change[i].tangential_m;
    }
    return {sum.normal_m / weights, sum.tangential_m / weights};
}

void change_terms(const tissue::BakedOrgan& from, tissue::BakedOrgan& to) {
    const tissue::FootprintOptions footprint{.tip_radius_max_m = from.tip_radius_max_m};
    const bool fixed = std::count(from.anchored.begin(), from.anchored.end(), 1) > 0;
    const std::vector<tissue::BedSample> loose =
        fixed || !from.bed.empty() ? from.bed : tissue::weak_bed(from.mesh);
    tissue::ContactSurface before = probes_of(from.surface), after = before;
    tissue::make_mesh_terms(from.mesh, from.material.poisson, from.anchored, footprint, before,
                            loose);
    tissue::make_mesh_terms(to.mesh, to.material.poisson, to.anchored, footprint, after, to.bed);
    std::vector<Term> change;
    for (std::size_t i = 0; i < before.rest_m.size(); ++i) {
        change.push_back({after.mesh_term_n_m[i] - before.mesh_term_n_m[i],
                          after.mesh_term_t_m[i] - before.mesh_term_t_m[i]});
    }
    tissue::ContactSurface& skin = to.surface;
    for (std::size_t v = 0; v < skin.rest_m.size(); ++v) {
        const Term more = interpolated(before.rest_m, change, skin.rest_m[v]);
        skin.mesh_term_n_m[v] = std::max(0.0, skin.mesh_term_n_m[v] + more.normal_m);
        skin.mesh_term_t_m[v] = std::max(0.0, skin.mesh_term_t_m[v] + more.tangential_m);
    }
}

} // namespace

tissue::BakedOrgan held_by(const tissue::BakedOrgan& organ, std::vector<tissue::BedSample> bed) {
    tissue::BakedOrgan held = organ;
    held.bed = std::move(bed);
    held.anchored.assign(organ.mesh.rest_m.size(), 0);
    // only a layer bonded to fixed nodes has a thickness of its own
    held.surface.thickness_m.assign(organ.surface.rest_m.size(), tissue::kUnbacked_m);
    if (!held.bed.empty() && organ.order == 1) // quadratic shapes owe no term
        change_terms(organ, held);
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
