// tissue/material/elastic.h
// Isotropic tissue, elastic or with a memory: the numbers and where they come from.
#pragma once

#include <string>
#include <vector>

namespace tissue {

/// What a term of a Prony series takes from the shear modulus in the long run, see prony.h.
struct PronyTerm {
    double share;  // of the modulus at once, 0 < share; all terms together less than 1
    double time_s; // > 0
};

struct Material {
    double young_pa = 5.4e3; // with a memory: at once, as poisson
    double poisson = 0.45;   // 0 <= nu < 0.5
    double density_kgpm3 = 1060.0;
    double damping_mass_1ps = 4.0;     // alpha in C = alpha M + beta K
    double damping_stiffness_s = 3e-3; // beta; K is the step's own tangent, in every model
    double friction = 0.1;             // tool on wet tissue
    std::string source;                // of the numbers above
    std::vector<PronyTerm> prony{};    // none: elastic
};

struct Lame {
    double lambda_pa, mu_pa;
};
/// Throws std::invalid_argument naming the value that is out of range and the range.
Lame lame(const Material& material);

} // namespace tissue
