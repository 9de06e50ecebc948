// tissue/solver/stress.cpp
#include "tissue/solver/stress.h"

#include "tissue/solver/corotated_element.h"

#include <algorithm>
#include <cmath>

namespace tissue {

void von_mises_pa(const CorotatedModel& model, std::span<const glm::dvec3> position_m,
                  std::span<double> out_pa) noexcept {
    for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
        const ElementShape shape = element_shape(model, e, position_m);
        out_pa[e] =
            std::sqrt(von_mises_squared(element_stress_nm(model, e, shape))) / model.volume_m3[e];
    }
}

double peak_von_mises_pa(const QuadraticModel& model, const QuadraticSystem& system) noexcept {
    double peak2 = 0.0;
    for (const QuadraticTangent& tangent : system.tangent.elastic) {
        for (const auto& point : tangent.point) {
            for (std::size_t lane = 0; lane < QuadraticGroup::kLanes; ++lane) {
                glm::dmat3 F;
                for (int k = 0; k < 9; ++k)
                    F[k / 3][k % 3] = point[QuadraticTangent::kF + k][lane];
                const double J = glm::determinant(F);
                if (!(J > 0.0))
                    continue;
                const double scale = model.elasticity.mu_pa * std::pow(J, -5.0 / 3.0);
                peak2 = std::max(peak2, scale * scale * von_mises_squared(F * glm::transpose(F)));
            }
        }
    }
    return std::sqrt(peak2);
}

} // namespace tissue
