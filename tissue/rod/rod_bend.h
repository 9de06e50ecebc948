// tissue/rod/rod_bend.h
// How a rod bends and twists at one node between two edges, with first and second derivatives:
// discrete elastic rods (Bergou et al. 2008; derivatives: Bergou et al. 2010, Kaldor et al. 2010).
// Called by rod_assembly.cpp. Pure, real-time safe.
//   kb = 2 te x tf/(1 + te.tf), |kb| = 2 tan(half the turn)
//   kappa1 =  (m2e + m2f).kb/2, kappa2 = -(m1e + m1f).kb/2
//   twist  = angle about tf from m1e, carried along without twist from te to tf, to m1f
// Frames of edges are carried without twist when edges turn, and turn by theta about them: the
// derivatives are by (e, theta_e, f, theta_f), the edges in m.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace tissue {

/// Of an edge: its unit tangent and a unit vector across it that is fixed to the material.
struct RodFrame {
    glm::dvec3 tangent{1.0, 0.0, 0.0}, across{0.0, 1.0, 0.0};
};

/// `v` turned by the smallest rotation that takes the unit vector `from` to `to`. Where they are
/// opposite, `v` itself: half a turn about it.
glm::dvec3 carried(const glm::dvec3& v, const glm::dvec3& from, const glm::dvec3& to) noexcept;

/// `frame` along the unit vector `to`, turned by `theta_rad` about it.
RodFrame moved(const RodFrame& frame, const glm::dvec3& to, double theta_rad) noexcept;

/// kappa1, kappa2, twist: no units. The twist is told from -pi to pi.
using BendStrain = std::array<double, 3>;
using BendGradient = std::array<double, 8>;
using BendHessian = std::array<std::array<double, 8>, 8>;

/// Folds sharper than 177.4 degrees are taken for that, so that nothing is ever infinite.
BendStrain bend_strain(const RodFrame& e, const RodFrame& f) noexcept;
std::array<BendGradient, 3> bend_gradient(const RodFrame& e, double e_m, const RodFrame& f,
                                          double f_m) noexcept;
std::array<BendHessian, 3> bend_hessian(const RodFrame& e, double e_m, const RodFrame& f,
                                        double f_m) noexcept;

} // namespace tissue
