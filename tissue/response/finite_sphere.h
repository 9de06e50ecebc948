// tissue/response/finite_sphere.h
// The sphere's law where small strain no longer holds: a hemisphere on a shaft pressed to 8 of its
// radii into neo-Hookean tissue that sticks to it. sim/bridge fills the haptic loop's table from
// it. Set-up only; any thread.
//   D(x) = rho(x, nu) D_small(x),  x = cbrt(P (1-nu^2) / (E a^2))
// rho: depth of the half-space at finite strain over that of Sneddon at the same force, computed by
// half_space_press.h (`trocar study indenter` prints the table). Beyond 8 radii depth goes on along
// its last slope over force.
//
// On a bonded layer the same rho scales the layer's own depth, which leaves out that the layer gets
// thinner as it is pressed: at 1/4, 3/8, 1/2 of a thickness of 4 radii the force is 3, 6, 10 % too
// low, of 2 radii 4, 10, 17 % (small strain: 4, 8, 13 and 4, 10, 18 %; nu 0.45).
//
// Stuck, because with little friction a neo-Hookean half-space has no equilibrium beyond 2 to 5
// radii (friction 0: 1.8, 0.1: 2.7, 0.3: 5.2): the tangent becomes indefinite and energy falls on,
// as if the skin at the pole stretched without end. As far as it has one, friction 0.1 takes 5 %
// off the force at 1.75 radii and 12 % at 2.5, none at all takes 10 % off at 1.75.
#pragma once

#include "tissue/response/subgrid.h"

namespace tissue {

/// As computed: force/(E a^2) at `depth` tip radii, 0.2 to 8. Poisson's ratio is taken to lie from
/// 0.3 to 0.49, linear in between.
double finite_sphere_force(double depth, double poisson);

/// rho for x >= 0; once differentiable, see above.
double finite_depth_ratio(double x, double poisson);

/// make_sphere_law() with every level scaled by rho. Contact radii are those of small strain, which
/// differ by up to 2 % of the tip radius at equal depth. Throws as make_sphere_law().
SphereLaw make_finite_sphere_law(double tip_radius_m, double young_pa, double poisson, int levels,
                                 int entries);

} // namespace tissue
