// tissue/response/subgrid.h
// What lies below the mesh: the compliance of a tip on a half-space or bonded layer, minus that of
// the footprint kernel which the mesh already carries.
//   W_p(a_c) = (1-nu)/(2 pi G) (pi/2) lambda_p(a_c/T)/a_c      flat punch of radius a_c
//   W_k(r)   = (1-nu)/(2 pi G) 2.0695 lambda_k(r/T)/r          kernel of radius r
//   S = W_p - W_k >= 0 while a_c <= a <= r/1.3175
// Sphere of radius a: d_loc = (a_c/2) ln((a+a_c)/(a-a_c)) chi(a_c/T), dP = d(d_loc)/W_p
// (Sneddon 1965; bonded layer: Hayes, Keer, Herrmann & Mockros 1972, with lambda_p and chi from
// their integral equation, not from a fit; dP = dd/W_p is exact for linear bodies). Set-up only:
// a law of 10 levels takes tens of milliseconds, a factor up to a millisecond. Any thread.
#pragma once

#include <vector>

namespace tissue {

/// lambda_p and lambda_k for a layer: 1 for a half-space (ratio 0). 0 <= nu <= 0.5, else
/// std::invalid_argument; lambda_p keeps its value at 50 beyond a ratio of 50.
double punch_layer_factor(double radius_over_thickness, double poisson);
double kernel_layer_factor(double radius_over_thickness, double poisson);

double punch_compliance_mpn(double young_pa, double poisson, double radius_m, double thickness_m);
double kernel_compliance_mpn(double young_pa, double poisson, double radius_m, double thickness_m);

/// Tangential over normal, half-space: (2 - nu) / (2 (1 - nu)) (Cerruti, axisymmetric mean).
double tangential_ratio(double poisson);

/// The sphere's law in table form; layout as the haptic loop reads it (see sim/bridge).
/// depth_over_x_m[level][i] = d_loc/x and contact_radius_m[level][i] at x = i x_step,
/// x = cbrt(P (1-nu^2) / (E a^2)), up to x = 8. Entry 0 is 0. Levels: a/T = 3 (i/(levels-1))^2.
struct SphereLaw {
    double force_scale_n = 0.0;
    double x_step = 0.0;
    std::vector<double> radius_over_thickness;
    std::vector<std::vector<double>> depth_over_x_m;
    std::vector<std::vector<double>> contact_radius_m;
};
SphereLaw make_sphere_law(double tip_radius_m, double young_pa, double poisson, int levels,
                          int entries);

} // namespace tissue
