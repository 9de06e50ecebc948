// tissue/solver/chord.h
// The end of a corotated step by the tangent of an earlier step. Called by solid.cpp in the tissue
// loop: forces are exact, only A and its factor are old. Newton's method with an older tangent
// converges linearly (the chord method, Kelley 1995): of the error each iteration leaves a share
// that grows with the tangent's age, and the first correction is about that share of the step. So
// the tangent is kept while corrections are small. Where a body is held still, it plays no part.
#pragma once

#include "tissue/solver/corotated.h"

namespace tissue {

/// Scratch, made once per model.
struct Chord {
    CorotatedState trial;
    std::vector<double> force_n, residual_n; // on the unknowns
};
Chord make_chord(const CorotatedModel& model);

struct ChordEnd {
    bool made = false;     // false: the tangent is too old. Only `du` may have changed
    double share = 0.0;    // |correction| / |du|, what an iteration leaves
    double residual = 0.0; // |residual| before the correction / |all forces of its sum|
};

/// Corrects `du` once by the factor that `system` has, unless that leads away; if little was left,
/// u += du, v = du/dt, and system.internal_n is that of the new place. `du` is that of
/// free_motion() and contact; `load_n`: the contact force on the unknowns, may be empty. Not made
/// where a tet is inverted, before or after. No allocation outside CHOLMOD.
ChordEnd end_on_chord(const CorotatedModel& model, std::span<const double> load_n,
                      std::span<double> du, CorotatedSystem& system, Chord& chord,
                      CorotatedState& state) noexcept;

/// The same for a step without contact, or under a load that does not depend on where it leads: if
/// the tangent was too old, the step is begun again with that of `state`, which costs what the next
/// step's tangent would have. Then not made only where that one does not serve either.
struct FreshEnd {
    ChordEnd end;
    bool new_tangent = false;
};
FreshEnd end_or_begin_again(const CorotatedModel& model, std::span<const double> load_n,
                            std::span<double> du, CorotatedSystem& system, Chord& chord,
                            CorotatedState& state) noexcept;

} // namespace tissue
