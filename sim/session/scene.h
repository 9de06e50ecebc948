// sim/session/scene.h
// A scene: organs, materials, tools with their trocars, the endoscope. Read from a TOML file and
// the baked organs that it names; everything that an attempt needs to be judged again later is in
// the text, which goes into the logbook.
#pragma once

#include "haptics/device/trocar.h"
#include "sim/loop/haptic_loop.h"
#include "sim/loop/tissue_loop.h"
#include "tasks/exercise/observation.h"

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace sim {

struct SceneOrgan {
    std::string name;
    std::string file; // relative to the organ folder
    tissue::Material material;
};

struct SceneTool {
    tasks::Role role{};
    haptics::Trocar trocar;
    glm::dvec3 start_tip_m{0.0};
    double tip_radius_m = 3e-3;
    double metres_per_count = 20e-6; // of the recorded counts
};

struct Scene {
    std::string id, title, text; // text: the file as it was read
    std::vector<SceneOrgan> organ;
    std::array<SceneTool, kTools> tool; // left, right, assist
    tasks::View view;
};

/// Parses a scene file. Throws std::invalid_argument with file, line, key, value and what would
/// be accepted.
Scene parse_scene(std::string_view text, std::string_view file);

struct LoadedScene {
    Scene scene;
    std::vector<std::shared_ptr<const tissue::BakedOrgan>> organ; // beside scene.organ
    std::string hash; // SHA-256 of the text and the organs' bytes
};
/// The baked organs of a scene. Throws with the path that failed.
LoadedScene load_organs(Scene scene);
/// `scene`: a name ("basic") or a path to a .toml file. Throws with the path that failed.
LoadedScene load_scene(const std::string& scene);

/// Bodies at rest with the targets of an exercise snapped onto the first organ's skin.
/// Throws naming the target if one is farther than 10 mm from any skin.
TissueRig make_tissue(const LoadedScene& scene, std::span<const glm::dvec3> target_m,
                      const TissueConfig& config);

/// Instruments without devices: geometry, limits, the zero of the counts.
HapticRig make_haptics(const Scene& scene);

/// What the exercise sees in one tick, from recorded integers alone.
tasks::Observation observe_trace(const HapticRig& geometry, const tasks::View& view,
                                 const tasks::TickTrace& tick, const TargetPlaces& target_um,
                                 std::span<const tasks::Target> rest_targets);

} // namespace sim
