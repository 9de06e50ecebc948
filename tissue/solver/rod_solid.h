// tissue/solver/rod_solid.h
// A tube as one of the bodies of solid.h: a rod that carries the points of its skin, on which
// everything outside sees three unknowns each, as if they were nodes. Every tier but the rigid one
// makes the same of a tube: an exact section needs no better shapes. Tissue loop; made at setup.
#pragma once

#include "tissue/rod/rod_line.h"
#include "tissue/rod/rod_points.h"

namespace tissue {

/// Constant: the rod and where its points are on it. The fields that other models have, too, have
/// the same names.
struct RodBody {
    RodModel rod;
    std::vector<RodVertex> vertex;
    std::vector<glm::dvec3> rest_m; // of the points
    Material material;
    std::vector<std::int32_t> dof; // three unknowns a point
    int unknowns = 0;
};
RodBody make_rod_body(const RodLine& line, std::span<const glm::dvec3> skin_m,
                      const Material& material, const glm::dvec3& gravity_mps2);

/// Largest stress of a fibre, von Mises: of pull and bending together, and twist at the skin.
double peak_von_mises_pa(const RodModel& model, const RodState& state) noexcept;

/// Radius that an edge's section is a full circle of.
double radius_m(const RodSection& section) noexcept;

} // namespace tissue
