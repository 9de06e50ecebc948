// sim/check/exercise_check.h
// Can this exercise be done in this scene? Every target: on a skin, reached by its role, seen by
// the endoscope, its force band met. All at rest. Called when an attempt is set up, and by
// `trocar scene check`; some ten milliseconds, not real time.
//
// The rule for the force band, from the static stiffness at the target and the softest coupling
// that the role's lever asks for there:
//   F(15 mm, or 0.8 of the tissue's thickness) >= force_min_n   deeper a press leaves the tissue,
//                                                               or pulls the organ from its bed
//   F(0.5 mm) <= force_max_n                                    finer no hand holds a depth at the
//                                                               end of a long instrument
// A tube to be found needs no force band: it has to be hidden at rest, and in the endoscope's sight
// once what is to be lifted is out of the way.
// The rule for neighbours is the exercise file's own (two radii, or one touch counts for both),
// asked again where targets of one role lie after they were snapped onto the skin.
#pragma once

#include "sim/check/finding.h"
#include "sim/check/rest_feel.h"
#include "sim/check/solid.h"
#include "tasks/exercise/exercise.h"

namespace sim {

inline constexpr double kDeepPress_m = 15e-3;
inline constexpr double kDeepShare = 0.8; // of the tissue's thickness
inline constexpr double kShallowPress_m = 0.5e-3;

struct TargetCheck {
    std::string id, organ; // organ: empty if there is none near
    tasks::Role role{};
    double snap_m = 0.0;
    glm::dvec3 place_m{0.0};
    double insertion_m = 0.0;
    double deep_m = 0.0; // the deepest press that counts
    double shallow_n = 0.0, deep_n = 0.0;
};

struct ExerciseCheck {
    std::string id, file;
    tasks::ExerciseKind kind{};
    std::vector<TargetCheck> target;
    std::vector<Finding> finding;
};

/// `bodies` and `solids` at rest, in the order of the scene. Throws tasks::BadInput for a text that
/// cannot be read.
ExerciseCheck check_exercise(const LoadedScene& scene, std::span<const Body> bodies,
                             std::span<const Solid> solids, const std::string& text,
                             const std::string& file);

} // namespace sim
