// tissue/solver/stress.cpp
#include "tissue/solver/stress.h"

#include "tissue/solver/corotated_element.h"

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

} // namespace tissue
