#include "tests/bake/skin_compliance.h"

#include "tissue/response/footprint_kernel.h"
#include "tissue/response/linear_statics.h"
#include "tissue/response/subgrid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <stdexcept>

namespace bake_tests {

std::vector<std::uint32_t> skin_places(const tissue::ContactSurface& skin, int count,
                                       std::uint64_t seed) {
    std::vector<double> area(skin.rest_m.size(), 0.0);
    double sum = 0.0;
    for (const auto& [a, b, c] : skin.triangles) {
        const double sixth = glm::length(glm::cross(skin.rest_m[b] - skin.rest_m[a],
                                                    skin.rest_m[c] - skin.rest_m[a])) /
                             6.0;
        for (const std::uint32_t v : {a, b, c}) {
            area[v] += sixth;
            sum += sixth;
        }
    }
    std::mt19937_64 random(seed);
    std::vector<std::uint32_t> places;
    for (int i = 0; i < count; ++i) {
        double left = sum * static_cast<double>(random() >> 11) * 0x1p-53;
        std::uint32_t v = 0;
        while (v + 1 < area.size() && left > area[v])
            left -= area[v++];
        places.push_back(v);
    }
    return places;
}

std::vector<double> normal_compliances_mpn(const tissue::BakedOrgan& organ,
                                           const std::vector<std::uint32_t>& vertices,
                                           double tip_radius_m) {
    const auto& skin = organ.surface;
    const double young_pa = organ.material.young_pa, poisson = organ.material.poisson;
    const auto statics =
        tissue::make_linear_statics(organ.mesh, organ.order, poisson, organ.anchored, organ.bed);
    tissue::SparseFactor factor(statics.pattern);
    if (!factor.factor(statics.stiffness_m))
        throw std::runtime_error("nothing holds " + organ.name);
    const auto normal = tissue::vertex_normals(skin.rest_m, skin.triangles);
    tissue::SparseColumns load;
    std::vector<double> compliance(vertices.size());
    for (const std::uint32_t v : vertices) {
        for (std::uint32_t k = skin.row_start[v]; k < skin.row_start[v + 1]; ++k) {
            const std::int32_t dof = statics.dof[skin.row_node[k]];
            for (int axis = 0; dof >= 0 && axis < 3; ++axis)
                load.add(dof + axis, skin.row_weight[k] * normal[v][axis]);
        }
        load.end_column();
    }
    factor.compliances(load, compliance);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const std::uint32_t v = vertices[i];
        const double thick_m = skin.thickness_m[v];
        const double term_mpn =
            tissue::punch_compliance_mpn(young_pa, poisson, tip_radius_m, thick_m) -
            tissue::kernel_compliance_mpn(young_pa, poisson, skin.footprint_radius_m[v], thick_m);
        compliance[i] =
            (compliance[i] + skin.mesh_term_n_m[v]) / young_pa + std::max(0.0, term_mpn);
    }
    return compliance;
}

Ratios stiffness_ratios(const tissue::BakedOrgan& organ, const tissue::BakedOrgan& finer,
                        double tip_radius_m, std::uint64_t seed) {
    if (organ.surface.rest_m != finer.surface.rest_m)
        throw std::invalid_argument("two skins");
    constexpr int kPlaces = 50;
    const auto places = skin_places(organ.surface, kPlaces, seed);
    const auto coarse = normal_compliances_mpn(organ, places, tip_radius_m);
    const auto fine = normal_compliances_mpn(finer, places, tip_radius_m);
    Ratios r{0.0, 0.0, 1e9, 0.0};
    double squares = 0.0;
    for (int i = 0; i < kPlaces; ++i) {
        const double ratio = fine[i] / coarse[i];
        r.mean += ratio / kPlaces;
        squares += ratio * ratio / kPlaces;
        r.low = std::min(r.low, ratio);
        r.high = std::max(r.high, ratio);
    }
    r.deviation = std::sqrt(std::max(0.0, squares - r.mean * r.mean));
    return r;
}

} // namespace bake_tests
