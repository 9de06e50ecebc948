// See the header.
#include "tissue/solver/rod_solid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tissue {

RodBody make_rod_body(const RodLine& line, std::span<const glm::dvec3> skin_m,
                      const Material& material, const glm::dvec3& gravity_mps2) {
    RodBody body;
    body.rod = make_rod(line, material, gravity_mps2);
    body.vertex = attach(body.rod, skin_m);
    body.rest_m.assign(skin_m.begin(), skin_m.end());
    body.material = material;
    for (std::size_t i = 0; i < skin_m.size(); ++i, body.unknowns += 3)
        body.dof.push_back(body.unknowns);
    return body;
}

// E I/(E A) = r^2/4
double radius_m(const RodSection& section) noexcept {
    return 2.0 * std::sqrt(section.bend_nm2 / section.stretch_n);
}

double peak_von_mises_pa(const RodModel& model, const RodState& state) noexcept {
    const double young_pa = model.material.young_pa;
    double peak_pa = 0.0;
    const auto pull_pa = [&](std::size_t e) {
        const double now_m = glm::distance(state.position_m[e], state.position_m[e + 1]);
        return std::abs(young_pa * (now_m / model.length_m[e] - 1.0));
    };
    for (std::size_t e = 0; e < model.length_m.size(); ++e)
        peak_pa = std::max(peak_pa, pull_pa(e));
    for (std::size_t i = 1; i + 1 < model.rest_m.size(); ++i) {
        if (!(model.bend_length_m[i] > 0.0))
            continue;
        const BendStrain strain = bend_strain(state.frame[i - 1], state.frame[i]);
        const double curvature_1pm =
            std::hypot(strain[0] - model.rest_strain[i][0], strain[1] - model.rest_strain[i][1]) /
            model.bend_length_m[i];
        const double twist_1pm = (strain[2] - model.rest_strain[i][2]) / model.bend_length_m[i];
        for (const std::size_t e : {i - 1, i}) {
            const RodSection& s = model.section[e];
            const double r_m = radius_m(s), shear_pa = young_pa * s.twist_nm2 / (2 * s.bend_nm2);
            const double along_pa = pull_pa(e) + young_pa * r_m * curvature_1pm;
            const double across_pa = shear_pa * r_m * twist_1pm;
            peak_pa =
                std::max(peak_pa, std::sqrt(along_pa * along_pa + 3.0 * across_pa * across_pa));
        }
    }
    return peak_pa;
}

} // namespace tissue
