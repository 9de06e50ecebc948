// tissue/material/elastic.h
// Isotropic elastic tissue: the numbers and where they come from.
#pragma once

#include <string>

namespace tissue {

struct Material {
    double young_pa = 5.4e3;
    double poisson = 0.45; // 0 <= nu < 0.5
    double density_kgpm3 = 1060.0;
    double damping_mass_1ps = 4.0;     // alpha in C = alpha M + beta K
    double damping_stiffness_s = 3e-3; // beta; K is the step's own tangent, in every model
    double friction = 0.1;             // tool on wet tissue
    std::string source;                // of the numbers above
};

struct Lame {
    double lambda_pa, mu_pa;
};
/// Throws std::invalid_argument naming the value that is out of range and the range.
Lame lame(const Material& material);

} // namespace tissue
