// tissue/reference/half_space_press.h
// A rigid hemisphere on a shaft pressed deep into a neo-Hookean half-space or bonded layer: force
// against depth where small strain no longer holds. Called by a study, which tabulates it for
// finite_sphere.h, and by tests; any thread, slow, not real time.
// Units: tip radius 1, Young's modulus 1, so forces are F/(E a^2) and depths d/a.
// Contact and friction as in tip_contact.h, three Gauss points on each quadratic edge of the skin.
#pragma once

#include <functional>
#include <vector>

namespace tissue {

struct HalfSpacePress {
    double poisson = 0.45;
    double friction = 0.0;     // Coulomb coefficient; infinite: what touches sticks
    std::vector<double> depth; // ascending, > 0, in tip radii
    double thickness = 0.0;    // of the layer, in tip radii; 0: half-space
    double cell = 0.15;        // of the mesh under the tip
    double core = 1.5;         // how far it is that fine
    double growth = 0.2;       // of cells beyond, over the way
    double extent = 150.0;     // of the mesh
    double step = 0.1;         // greatest
    double penalty = 100.0;    // k a / E
    int step_halvings = 5;     // before giving up
};

struct HalfSpacePoint {
    double depth = 0.0, force = 0.0;
    double contact_radius = 0.0; // of the farthest place that is touched, as pressed
    double penetration = 0.0;    // greatest left
    double min_det_f = 1.0;
};

struct HalfSpaceReport {
    std::vector<HalfSpacePoint> point; // of each depth that was reached
    double reached = 0.0;              // last depth with an equilibrium
    int iterations = 0;                // linear solves
};

/// `progress` (may be empty) gets every equilibrium on the way. Throws std::invalid_argument for
/// depths that do not ascend, bad sizes, and as lame() does for the ratio.
HalfSpaceReport press_half_space(const HalfSpacePress& press,
                                 const std::function<void(const HalfSpacePoint&)>& progress = {});

} // namespace tissue
