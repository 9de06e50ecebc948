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
    const bool memory = !system.tangent.shear.empty();
    for (std::size_t g = 0; g < system.tangent.elastic.size(); ++g) {
        for (std::size_t q = 0; q < 4; ++q) {
            const auto& point = system.tangent.elastic[g].point[q];
            for (std::size_t lane = 0; lane < QuadraticGroup::kLanes; ++lane) {
                glm::dmat3 F, T;
                for (int k = 0; k < 9; ++k) {
                    F[k / 3][k % 3] = point[QuadraticTangent::kF + k][lane];
                    T[k / 3][k % 3] =
                        memory ? system.tangent.shear[g].point[q][QuadraticShear::kFM + k][lane]
                               : model.elasticity.mu_pa * F[k / 3][k % 3];
                }
                const double J = glm::determinant(F);
                if (!(J > 0.0))
                    continue;
                // times J^(-10/3); a root only for what may be the peak, as J^(-1/3) <= max(1, 1/J)
                const double stress2 = von_mises_squared(T * glm::transpose(F)) / (J * J * J);
                if (stress2 * std::max(1.0, 1.0 / J) > peak2)
                    peak2 = std::max(peak2, stress2 / std::cbrt(J));
            }
        }
    }
    return std::sqrt(peak2);
}

} // namespace tissue
