// tissue/response/rod_basis.h
// The modes of a tube that is a rod, for the local model: the same moments of the same loads as in
// contact_basis.h, made on the rod's own unknowns, which are few, and shown on the points of its
// skin. Tissue loop.
#pragma once

#include "tissue/response/contact_basis.h"
#include "tissue/solver/rod_solid.h"

namespace tissue {

/// As for other bodies; `surface` has one row per vertex, which is the point of that number. A rod
/// that is not linearised at `state` answers as it was. No allocation, here and below.
void compute_contact_basis(const RodBody& model, const ContactSurface& surface,
                           const RodState& state, RodSystem& system,
                           std::span<const BasisContact> contacts, ContactBasis& basis) noexcept;
void refresh_contact_basis(const RodBody& model, const RodState& state, const RodSystem& system,
                           ContactBasis& basis) noexcept;

} // namespace tissue
