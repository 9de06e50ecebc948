// sim/check/scene_check.h
// All that a scene lacks or asks in vain, in one go. Called by `trocar scene check` and by tests.
#pragma once

#include "sim/check/exercise_check.h"

namespace sim {

struct OrganCheck {
    std::string name;
    bool rigid = false, held = false;
    bool rod = false; // a tube without tetrahedra; `nodes` are those of its line
    std::size_t nodes = 0, tets = 0;
    double volume_m3 = 0.0, held_volume_m3 = 0.0; // held: by the scene's anchors, 0 without
};

struct ToolCheck {
    tasks::Role role{};
    double insertion_m = 0.0; // at the start
};

struct SceneCheck {
    std::string id, file, hash;
    std::vector<OrganCheck> organ;
    std::vector<ToolCheck> tool;
    std::vector<ExerciseCheck> exercise;
    Mistakes mistakes;            // what cannot be read: nothing below the files was checked
    std::vector<Finding> finding; // of scene and exercises
};

/// More than this is an overlap: organs that touch, as in a body, each have a skin of triangles,
/// and remeshing moves either by some tenths of their edges. A share of the longer mean edge of the
/// two.
inline constexpr double kOverlapShare = 0.25;
inline constexpr double kLeastOverlap_m = 0.5e-3, kMostOverlap_m = 2e-3; // bounds of the share

/// `exercise`: a name or file; empty: all that exercise_names lists. Throws std::runtime_error if
/// there is no such scene or exercise.
SceneCheck check_scene(const std::string& scene, const std::string& exercise = {});

} // namespace sim
