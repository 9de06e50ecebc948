// tissue/response/mode_shapes.cpp
// See the header. Called by sim/bridge in the tissue loop, once per patch vertex and FEM step.
#include "tissue/response/mode_shapes.h"

#include <algorithm>

namespace tissue {

void turn_shapes(const ContactBasis& basis, int unknowns, std::span<double> by_unknown) noexcept {
    const std::size_t n = static_cast<std::size_t>(unknowns);
    const std::size_t modes = static_cast<std::size_t>(basis.modes);
    for (std::size_t m = 0; m < modes; ++m) {
        const double* column = basis.shape.data() + m * n;
        for (std::size_t d = 0; d < n; ++d)
            by_unknown[d * modes + m] = column[d];
    }
}

void vertex_shapes(Dofs dofs, const ContactSurface& surface, std::uint32_t vertex,
                   std::span<const double> by_unknown, int modes,
                   const std::array<double*, 3>& out) noexcept {
    for (double* line : out)
        std::fill_n(line, modes, 0.0);
    for (std::uint32_t k = surface.row_start[vertex]; k < surface.row_start[vertex + 1]; ++k) {
        const std::int32_t dof = dofs[surface.row_node[k]];
        if (dof < 0)
            continue;
        const double w = surface.row_weight[k];
        const double* lines = by_unknown.data() + static_cast<std::size_t>(dof) * modes;
        for (int axis = 0; axis < 3; ++axis) {
            double* to = out[axis];
            const double* from = lines + axis * modes;
            for (int m = 0; m < modes; ++m)
                to[m] += w * from[m];
        }
    }
}

} // namespace tissue
