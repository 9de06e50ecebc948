// tissue/response/mode_shapes.h
// The modes of a contact basis as the skin shows them: how far each skin vertex moves per unit of
// each mode. Made for every vertex of every patch in each FEM step, so it runs over contiguous
// memory: the basis is turned once, then each footprint row mixes whole lines of it.
#pragma once

#include "tissue/response/contact_basis.h"

namespace tissue {

/// by_unknown[d * modes + m] = basis.shape[m * unknowns + d]. `by_unknown` holds at least
/// unknowns * modes numbers. No allocation.
void turn_shapes(const ContactBasis& basis, int unknowns, std::span<double> by_unknown) noexcept;

/// out[axis][m] = sum_i w_i shape of mode m at node i along that axis. Each out[axis] holds
/// `modes` numbers.
void vertex_shapes(Dofs dofs, const ContactSurface& surface, std::uint32_t vertex,
                   std::span<const double> by_unknown, int modes,
                   const std::array<double*, 3>& out) noexcept;

} // namespace tissue
