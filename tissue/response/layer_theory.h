// tissue/response/layer_theory.h
// Elastic layer bonded to a rigid base, pressed by an axisymmetric load: how much stiffer it is
// than a half-space. Called by subgrid.cpp at set-up; pure functions, any thread, not real time.
//   surface displacement u(r) = (1-nu)/G int p^(k) M(kT) J0(kr) dk
//   M(z) = [k sinh z cosh z - z] / [k cosh^2 z + z^2 + (1-2nu)^2],  k = 3 - 4 nu
// (Hayes, Keer, Herrmann & Mockros 1972; Lebedev & Ufliand 1958 for the integral equation).
#pragma once

#include <vector>

namespace tissue {

struct QuadratureRule {
    std::vector<double> point, weight; // on [-1, 1]
};
/// Gauss-Legendre, exact for polynomials of degree 2 count - 1.
QuadratureRule gauss_legendre(int count);

/// M(z) for z >= 0: 0 at 0, 1 far out.
double layer_response(double z, double poisson);

/// A tip with contact radius a on a layer of thickness T, ratio = a/T, 0: half-space.
struct LayerContact {
    double punch_stiffening;      // kappa: P = 4 G a w kappa / (1-nu), flat punch
    double depth_factor;          // chi: w0 = chi a^2 / R, paraboloid of radius R
    double paraboloid_stiffening; // kappa_s: P = (8/3) G a w0 kappa_s / (1-nu)
};
/// Exact up to quadrature (relative 1e-9 for ratio <= 3, 1e-5 at 50). Ratio is cut at 50.
LayerContact solve_layer_contact(double ratio, double poisson);

/// int k^(s)^2 M(s/ratio) ds / int k^(s)^2 ds for the kernel 2/pi (1 - rho^2), ratio = r/T;
/// k^(s) = 8 J2(s) / s^2. To 1e-6.
double kernel_response(double ratio, double poisson);

/// int k^(s)^2 ds of that kernel: its mean displacement under itself on a half-space.
double kernel_self_integral();

} // namespace tissue
