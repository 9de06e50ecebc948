#include "tissue/material/elastic.h"

#include <stdexcept>

namespace tissue {

Lame lame(const Material& material) {
    if (!(material.young_pa > 0.0)) {
        throw std::invalid_argument("young_pa = " + std::to_string(material.young_pa) +
                                    ": must be greater than 0");
    }
    if (!(material.poisson >= 0.0 && material.poisson < 0.5)) {
        throw std::invalid_argument("poisson = " + std::to_string(material.poisson) +
                                    ": must be at least 0 and below 0.5");
    }
    const double nu = material.poisson;
    return {material.young_pa * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            material.young_pa / (2.0 * (1.0 + nu))};
}

} // namespace tissue
