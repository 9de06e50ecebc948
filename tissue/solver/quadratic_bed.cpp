// The elastic bed of a quadratic body: the same points as for linear tetrahedra, seen through the
// shapes of ten nodes. A matrix on the pattern of the mass, since a point couples the nodes of one
// tet; made at setup, used in the tissue loop.
#include "tissue/reference/tet10.h"
#include "tissue/solver/quadratic_linear.h"

#include <algorithm>

namespace tissue {
std::vector<double> bed_stiffness(const QuadraticModel& model, std::span<const BedSample> bed) {
    std::vector<double> npm(model.mass_kg.size(), 0.0);
    const auto entry = [&](std::uint32_t row, std::uint32_t column) -> double& {
        const auto first = model.mass_column.begin() + model.mass_start[row],
                   last = model.mass_column.begin() + model.mass_start[row + 1];
        const auto found = std::find(first, last, static_cast<std::int32_t>(4 * column));
        return npm[static_cast<std::size_t>(found - model.mass_column.begin())];
    };
    for (const BedSample& sample : bed) {
        const Tet10& tet = model.mesh.tets.at(sample.tet);
        const std::array<double, 10> N = shape_values(sample.weight);
        for (std::size_t a = 0; a < 10; ++a) {
            for (std::size_t b = 0; b < 10; ++b)
                entry(tet[a], tet[b]) += model.material.young_pa * sample.stiffness_m * N[a] * N[b];
        }
    }
    return npm;
}

double add_bed(const QuadraticModel& model, const NodeVector<double>& moved_m,
               NodeVector<double>& scratch, NodeVector<double>& internal_n) noexcept {
    if (model.bed_npm.empty())
        return 0.0;
    scalar_product(model, model.bed_npm, 1.0, moved_m, scratch);
    double twice_j = 0.0;
    for (std::size_t i = 0; i < scratch.size(); ++i) {
        internal_n[i] += scratch[i];
        twice_j += scratch[i] * moved_m[i];
    }
    return 0.5 * twice_j;
}

} // namespace tissue
