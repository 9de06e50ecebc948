// tissue/reference/indenter.h
// What it takes to press a rigid round tip into a reference body: statics with contact, one depth
// after the other. Called by studies and tests; slow; any thread, one per system.
// The tip slides on the skin under Coulomb friction, freely (0) or not at all (infinite); the limit
// is that of the step before, so friction is of first order in the step, and first steps are short.
#pragma once

#include "tissue/reference/tip_contact.h"

#include <functional>

namespace tissue {

struct Press {
    glm::dvec3 place_m{0.0};         // on the skin at rest: there the depth is 0
    glm::dvec3 into{0.0, 0.0, -1.0}; // unit, the way of the tip
    double radius_m = 1.5e-3;        // of the tip
    std::vector<double> depth_m;     // ascending, > 0
    double friction = 0.0;           // Coulomb coefficient, may be infinite
    double step_m = 0.0; // greatest step; 0: a quarter of the radius. With friction half the depth
                         // so far, from a sixteenth of the greatest on
    double penalty = 100.0; // k radius / E
    int step_halvings = 3;  // before giving up
    NewtonOptions newton{.tolerance = 1e-7, .max_iterations = 25, .max_halvings = 1};
};

/// The state at one of Press::depth_m.
struct PressPoint {
    double depth_m = 0.0;
    glm::dvec3 force_n{0.0};    // on the tip, world frame
    double radius_m = 0.0;      // of a disc with the area that is touched, at rest
    double penetration_m = 0.0; // greatest, of a point that is touched
    double min_det_f = 1.0;
};

struct PressReport {
    std::vector<PressPoint> point;   // one for each depth that was reached
    double reached_m = 0.0;          // the last depth with an equilibrium
    int iterations = 0, factors = 0; // linear solves, and with a factor of their own of these
    double failed_at_m = 0.0;        // the depth tried last without an equilibrium; 0: none
    NewtonReport failed{};           // what Newton said there
};

/// From `state` at rest; ends at the last equilibrium. Fewer points than depths: no equilibrium was
/// found beyond reached_m. `progress` (may be empty) gets every equilibrium on the way. Throws
/// std::invalid_argument for a radius, way or depths that are not as above, and if no face is near.
PressReport press(const ReferenceModel& model, const Press& press, ReferenceSystem& system,
                  ReferenceState& state,
                  const std::function<void(const PressPoint&)>& progress = {});

/// Depth at which a tip on its way first touches a quadrature point of the skin: 0 on a plane,
/// less where the skin bulges or is not square to the way.
double touch_depth_m(const QuadraticMesh& mesh, const Press& press);

} // namespace tissue
