// tissue/reference/tip_contact.h
// A rigid round tip against the skin of a reference body, as a part of the potential that its
// Newton makes least. Called by reference_newton.cpp and indenter.cpp; any thread.
//   g(x)   distance of a place from the tip's surface, negative inside
//   slides w/(2k) (max(0, p - k g)^2 - p^2)       p: pressure known so far, k: penalty
//   sticks w (t.(x - q) + k/2 |x - q|^2)          t: traction known so far, q: place on the tip
// summed over six quadrature points of every six-node face (Dunavant 1985, degree 4), w their rest
// areas. One round of p <- max(0, p - k g) per step of depth is the augmented Lagrangian of
// Hestenes (1969) and Powell (1969): what is left of the penetration is told, see PressPoint.
#pragma once

#include "tissue/reference/reference.h"

namespace tissue {

/// A hemisphere on a shaft of the same radius, without end. World frame.
struct Tip {
    glm::dvec3 centre_m{0.0};
    glm::dvec3 shaft{0.0, 0.0, 1.0}; // unit, out of the body
    double radius_m = 0.0;
};

struct ContactPoint {
    std::uint32_t tet = 0;
    std::array<std::uint8_t, 6> local{}; // nodes of the face within the tet
    std::array<double, 6> shape{};
    double area_m2 = 0.0;        // at rest
    glm::dvec3 traction_pa{0.0}; // on the tip; slides: pressure in x alone
    glm::dvec3 held_at_m{0.0};   // sticks: on the tip, from its centre
    bool stuck = false;
};

struct TipContact {
    std::vector<ContactPoint> points;
    Tip tip;
    double penalty_papm = 0.0;
};

/// Points of all faces with a corner within `reach_m` of `place_m`, at rest.
std::vector<ContactPoint> contact_points(const QuadraticMesh& mesh, const glm::dvec3& place_m,
                                         double reach_m);

/// Gap and its slope, the outward unit normal of the tip's surface there.
struct Gap {
    double value_m = 0.0;
    glm::dvec3 normal{0.0};
};
Gap gap_at(const Tip& tip, const glm::dvec3& x_m) noexcept;

/// Where the point is, for displacements of the nodes.
glm::dvec3 place_of(const QuadraticMesh& mesh, const ContactPoint& point,
                    std::span<const glm::dvec3> moved_m) noexcept;

/// Force of the tip's surface per area on the body at `x_m`, Pa.
glm::dvec3 traction_at(const TipContact& contact, const ContactPoint& point,
                       const glm::dvec3& x_m) noexcept;

double contact_energy_j(const ReferenceModel& model, const TipContact& contact,
                        std::span<const glm::dvec3> moved_m) noexcept;

/// Adds the tangent to `stiffness` on ReferenceModel::all and sets `slope_n`, the gradient per
/// component. `projected`: without the part that the tip's roundness makes negative.
void linearize_contact(const ReferenceModel& model, const TipContact& contact,
                       std::span<const glm::dvec3> moved_m, bool projected,
                       std::span<double> slope_n, std::span<double> stiffness) noexcept;

} // namespace tissue
