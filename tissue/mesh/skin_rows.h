// tissue/mesh/skin_rows.h
// The sums of all footprint rows of a skin: most of what it costs to place one. Tissue loop, in
// every step. Internal to contact_surface.cpp.
#pragma once

#include "tissue/mesh/contact_surface.h"

namespace tissue {

/// position_m[v] = sum_i w_vi node_m[i]. Real-time safe.
void carry_rows(const ContactSurface& surface, std::span<const glm::dvec3> node_m,
                std::span<glm::dvec3> position_m) noexcept;

} // namespace tissue
