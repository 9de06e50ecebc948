// tissue/reference/tip_contact.h
// A rigid round tip against the skin of a reference body, as a part of the potential that its
// Newton makes least. Called by reference_newton.cpp and indenter.cpp; any thread.
//   normal      w/(2k) (max(0, p - k g)^2 - p^2)
//   tangential  w H(|s|),  H = k s^2/2 while k s <= m, else m (s - m/(2k)),  m = mu p
// g(x): distance of a place from the tip's surface, negative inside; p: pressure known so far; s:
// way along the tip since it was touched, less what has slipped; k: penalty; mu: friction. Summed
// over six quadrature points of every six-node face (Dunavant 1985, degree 4), w their rest areas.
// p and the slip are learned after each step of depth: the augmented Lagrangian of Hestenes (1969)
// and Powell (1969) with one round a step, Coulomb's limit one step late, as in Li et al. (2020).
// What is left of the penetration is told, see PressPoint.
#pragma once

#include "tissue/reference/reference.h"

namespace tissue {

/// A hemisphere on a shaft of the same radius, without end. World frame.
struct Tip {
    glm::dvec3 centre_m{0.0};
    glm::dvec3 shaft{0.0, 0.0, 1.0}; // unit, out of the body
    double radius_m = 0.0;
};

struct FacePoint {
    std::uint32_t tet = 0;
    std::array<std::uint8_t, 6> local{}; // nodes of the face within the tet
    std::array<double, 6> shape{};
    double area_m2 = 0.0;       // at rest
    double pressure_pa = 0.0;   // known so far
    double limit_pa = 0.0;      // of what friction holds
    bool bound = false;         // touched in the step before
    glm::dvec3 bound_at_m{0.0}; // where, from the tip's centre
};

struct TipContact {
    std::vector<FacePoint> points;
    Tip tip;
    double penalty_papm = 0.0;
};

/// Points of all faces with a corner within `reach_m` of `place_m`, at rest.
std::vector<FacePoint> contact_points(const QuadraticMesh& mesh, const glm::dvec3& place_m,
                                      double reach_m);

/// Gap and its slope, the outward unit normal of the tip's surface there.
struct Gap {
    double value_m = 0.0;
    glm::dvec3 normal{0.0};
};
Gap gap_at(const Tip& tip, const glm::dvec3& x_m) noexcept;

/// Where the point is, for displacements of the nodes.
glm::dvec3 place_of(const QuadraticMesh& mesh, const FacePoint& point,
                    std::span<const glm::dvec3> moved_m) noexcept;

/// What the tip's surface does per area to the body at `x_m`, Pa.
struct Traction {
    double pressure_pa = 0.0;
    glm::dvec3 normal{0.0};      // out of the tip
    glm::dvec3 friction_pa{0.0}; // against the way
    glm::dvec3 way_m{0.0};       // along the tip since it was bound
};
Traction traction_at(const TipContact& contact, const FacePoint& point,
                     const glm::dvec3& x_m) noexcept;

/// What is known after a step: pressures, limits for this `friction` (may be infinite), slip.
void learn_contact(const ReferenceModel& model, std::span<const glm::dvec3> moved_m,
                   double friction, TipContact& contact) noexcept;

double contact_energy_j(const ReferenceModel& model, const TipContact& contact,
                        std::span<const glm::dvec3> moved_m) noexcept;

/// Adds the tangent to `stiffness` on ReferenceModel::all and sets `slope_n`, the gradient per
/// component. `projected`: without the part that the tip's roundness makes negative.
void linearize_contact(const ReferenceModel& model, const TipContact& contact,
                       std::span<const glm::dvec3> moved_m, bool projected,
                       std::span<double> slope_n, std::span<double> stiffness) noexcept;

} // namespace tissue
