// tissue/reference/axisymmetric.h
// A body of revolution at finite strain, for what is round: nine-node quadrilaterals in the plane
// (r, z), 3 x 3 Gauss points. Called by half_space_press.cpp; any thread, slow, not real time.
//   F = [1 + u_r, u_z, 0; w_r, 1 + w_z, 0; 0, 0, 1 + u/r], energy sum 2 pi r psi(F) dr dz
// (u, w): displacement along r and z. Everything is in units of one length and one pressure.
#pragma once

#include "tissue/material/hyperelastic.h"
#include "tissue/solver/sparse_factor.h"

#include <array>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace tissue {

/// Lines of nodes (columns + 1) x (rows + 1) of cells that grow away from the axis and the top, and
/// the middles between; node i of line j is j (2 columns + 1) + i, line 0 the top, i = 0 the axis.
struct AxisymmetricMesh {
    int columns = 0, rows = 0;
    std::vector<glm::dvec2> rest{};         // (r, z), z <= 0
    std::vector<std::array<int, 9>> quad{}; // three nodes of three lines each, from above
    std::vector<std::int32_t> unknown{};    // of 2 node + axis; -1: held
    int unknowns = 0;
};

/// A disc of radius `extent` and `thickness` (0: as far down too), held at its bottom and side.
/// Cells of `cell` up to `core` from the corner of axis and top, then growing by `growth` of the
/// way. Throws std::invalid_argument unless 0 < cell <= core < extent and growth > 0.
AxisymmetricMesh disc_mesh(double cell, double core, double growth, double extent,
                           double thickness = 0.0);

struct AxisymmetricSystem {
    AxisymmetricMesh mesh;
    Elasticity elasticity;
    SparsePattern pattern{};                         // of the unknowns
    std::vector<std::array<std::int32_t, 171>> at{}; // where a quad's lower triangle goes; -1: held
    std::vector<double> stiffness{}, slope{};        // of the energy
    double min_det_f = 1.0;
};

AxisymmetricSystem make_axisymmetric(AxisymmetricMesh mesh, const Elasticity& elasticity);

/// Infinite where turned inside out. `moved`: displacement of each node.
double axisymmetric_energy(const AxisymmetricSystem& system, std::span<const glm::dvec2> moved);

/// Slope, stiffness and least det F there. `projected`: from tangents without negative eigenvalues.
void linearize(AxisymmetricSystem& system, std::span<const glm::dvec2> moved, bool projected);

/// Entry of the pattern for two unknowns, -1 if either is held.
std::int32_t entry_of(const SparsePattern& pattern, std::int32_t i, std::int32_t j);

} // namespace tissue
