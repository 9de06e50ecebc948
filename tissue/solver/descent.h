// tissue/solver/descent.h
// The end of a corotated step: move, and linearise there. Called by the tissue loop after the
// contact solve, by studies and tests after free_motion(). A step with inverted tets before or
// after it is out of reach of its one Newton iteration and is made again here by descent. So is one
// that gains energy while a body recovers, from when it was inverted until its caller finds it at
// rest and says so, and at any time one that gains a tenth of all that there is and of what the
// load gave: a tangent may be all but singular, as of a flap that is about to buckle, and then its
// step leads anywhere. Every other step is advance() and linearize(), bit for bit.
//
// Implicit Euler minimises the incremental potential (Kane et al. 2000; Gast et al. 2015)
//   E(d) = |d/dt - v|_M^2 / 2 + d.C d / (2 dt) + W(x + d) - f.d,   v' = d/dt
// over the motion d: C damping, W elastic energy, f contact and weight, held over the step.
// Because C is positive semidefinite, any d with E(d) <= E(0) keeps
//   W' - f.d <= W + |v|_M^2 / 2 - |v' - v|_M^2 / 2 - d.C d / (2 dt).                          (1)
// At a minimiser, from grad E . d = 0, the whole balance closes where W is convex along the step:
//   W' + |v'|_M^2 / 2 - f.d - (W + |v|_M^2 / 2)
//     = W' - W - grad W'.d - |v' - v|_M^2 / 2 - d.C d / dt <= 0.                              (2)
// Corotated W is not convex. Where (2) fails v' is shortened until the balance holds, for which (1)
// always leaves room. (1) holds in the frame of the centre of mass as well, so a body that nothing
// holds keeps its linear momentum: only the motion about its centre of mass is shortened.
//
// Energy alone does not lead home. With R the nearest rotation also of an inverted F
// (polar_rotation.h) W is continuous, and a free tet has one rest: a stationary F is a multiple of
// R, and its stress vanishes for 1 only; where R jumps, W has a ridge. But tets that turn back one
// by one can wind twice around an edge: all det F > 0, a true rest of any elastic energy (a cube
// thrown together rests at 0.83 of its volume, three edges at 4 pi). So descent begins where
// tangled tets go when each tangle has one rotation (tangle.h): a convex problem, one linear solve
// a round, as the global step of Bouaziz et al. 2014 but with rotations that agree. That start
// counts if its E is below E(0). Inside a tangle nothing damps but the mass: K there belongs to no
// rest shape, and over so long a way it would hold the tangle together.
#pragma once

#include "tissue/solver/corotated.h"
#include "tissue/solver/tangle.h"

namespace tissue {

/// Scratch of finish_step() and what it needs to know of the body. Made once per model.
struct Descent {
    bool free = true;        // no anchor and no bed
    double mass_kg = 0.0;    // of all nodes
    double roundoff_j = 0.0; // differences of energy below it are rounding
    Tangles tangles;
    CorotatedState before, trial;
    // on the unknowns: the step so far, where it started, the next direction, grad E
    std::vector<double> motion_m, start_m, way_m, gradient_n;
    std::vector<double> trial_m, damped; // of the energy that is being looked at
    std::vector<double> damping_nspm;    // C without alpha M, on the pattern
};
Descent make_descent(const CorotatedModel& model);

struct StepEnd {
    int iterations = 0; // linear solves of the descent; 0: the step is that of free_motion()
    int inverted = 0;   // tets, at the end
    double relative_residual = 0.0; // |grad E(d)| / |grad E(0)|; of a descent
    double speed_share = 1.0;       // what is left of v', see (2)
};

inline constexpr int kMaxDescent = 4; // iterations, each an assembly and a factorisation

/// u += du, v = du/dt, and `system` linearised there; or the same by descent, and `du` is then the
/// motion that was made. `du` is that of free_motion() and contact from `state`; `load_n` is the
/// contact force on the unknowns (may be empty). `system` may have followed the tangent to `state`.
/// While state.recovering, elastic, kinetic and potential energy together grow by no more than
/// load . du and rounding. A state that is not finite is left so. No allocation outside CHOLMOD.
StepEnd finish_step(const CorotatedModel& model, std::span<const double> load_n,
                    std::span<double> du, CorotatedSystem& system, Descent& descent,
                    CorotatedState& state) noexcept;

} // namespace tissue
