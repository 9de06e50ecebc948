// tests/tissue/calculix.h
// CalculiX (G. Dhondt, The Finite Element Method for Three-Dimensional Thermomechanical
// Applications, 2004; program ccx of Debian's calculix-ccx) on the meshes of the reference solver:
// writes the input, runs the program, reads what it printed. It shares nothing with ours but the
// nodes.
#pragma once

#include "tissue/mesh/quadratic_mesh.h"

#include <glm/vec3.hpp>
#include <string>

namespace calculix {

/// NLGEOM, C3D10, *HYPERELASTIC, NEO HOOKE. Components of flagged nodes go to `held_m`.
struct Problem {
    const tissue::QuadraticMesh& mesh;
    double c10_pa, d1_1pa, density_kgpm3;
    glm::dvec3 gravity_mps2{0.0};
    std::vector<std::uint8_t> held; // kHeldX, kHeldY, kHeldZ
    std::vector<glm::dvec3> held_m; // empty: they stay
    // more than 0: from rest, this many steps of dt_s by the trapezoidal rule (Newmark 1/4, 1/2)
    int steps = 0;
    double dt_s = 0.0;
};

struct Answer {
    std::vector<glm::dvec3> moved_m;    // seven digits, as printed
    std::vector<glm::dvec3> internal_n; // RF: what the elements of a node need to hold it there
    double seconds = 0.0;               // of the program
};

/// Where ccx is, on PATH; empty if it is not.
std::string program();

/// Throws std::runtime_error with the end of the program's own log if it found nothing.
Answer solve(const Problem& problem);

} // namespace calculix
