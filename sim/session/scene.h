// sim/session/scene.h
// A scene: organs with what holds them, materials, tools with their trocars, the endoscope. Read
// from scene.toml and the baked organs that it names; everything that an attempt needs to be judged
// again later is in the text, which goes into the logbook. Setup only, not real time.
#pragma once

#include "haptics/device/trocar.h"
#include "sim/loop/haptic_loop.h"
#include "sim/loop/tissue_loop.h"
#include "sim/session/anchor.h"
#include "sim/session/model_choice.h"
#include "sim/session/scene_place.h"
#include "sim/view/tissue_look.h"
#include "tasks/exercise/observation.h"

namespace sim {

struct SceneOrgan {
    std::string name;
    std::string file; // beside scene.toml
    tissue::Material material;
    std::vector<Anchor> anchor;           // if any, instead of what the organ was baked with
    std::string runs_into;                // an organ that its ends may lie in, as vessels do
    double hold_length_m = 10e-3;         // L of tissue/mesh/elastic_bed.h
    view::Look look = view::Look::tissue; // of the picture only
};

struct SceneTool {
    tasks::Role role{};
    haptics::Trocar trocar;
    glm::dvec3 start_tip_m{0.0};
    double tip_radius_m = 3e-3;
    haptics::JawConfig jaws;
    double metres_per_count = 20e-6; // of the recorded counts
};

struct Scene {
    std::string id, title, text; // text: the file as it was read
    bool organs_meet = false;    // organs push each other and lie on scenery
    std::vector<SceneOrgan> organ;
    std::array<SceneTool, kTools> tool; // left, right, assist
    tasks::View view;                   // with a scope: as it is held at first
    std::optional<SceneScope> scope;    // none: the picture is fixed
    glm::dvec3 look_at_m{0.0};
};

/// What is wrong with a file: all of it, for `trocar scene check`. Where one is passed, mistakes
/// are added to it and reading goes on; where it is null, the first one is thrown.
using Mistakes = std::vector<tasks::BadInput>;

/// Parses a scene file. tasks::BadInput: file, line, key, value and what would be accepted. With
/// mistakes the scene is only good for telling what else is wrong.
Scene parse_scene(std::string_view text, std::string_view file, Mistakes* mistakes = nullptr);

struct LoadedScene {
    Scene scene;
    ScenePlace place;
    std::vector<std::shared_ptr<const tissue::BakedOrgan>> organ; // beside scene.organ
    // the same on coarse tets with quadratic shapes; null: there is none, the fine ones serve
    std::vector<std::shared_ptr<const tissue::BakedOrgan>> quadratic;
    std::string hash; // SHA-256 of text, organs' bytes and region files; not of their place
};
/// The baked organs of a scene, held as it says. tasks::BadInput names the key of a file that is
/// missing or damaged.
LoadedScene load_organs(Scene scene, ScenePlace place, Mistakes* mistakes = nullptr);
/// `scene`: a name ("basic"), a directory or a .toml file.
LoadedScene load_scene(const std::string& scene);

/// The surface of an organ at rest, for distances and hits.
std::shared_ptr<const tissue::BoundaryTree> rest_surface(const tissue::BakedOrgan& organ);

/// Distance fields of organ `index`'s anchors, in their order.
std::vector<DistanceField> anchor_fields(const LoadedScene& scene, std::size_t index);

/// Bodies at rest, in the order of scene.organ.
/// `choice`: by organ; empty: the usual tier.
std::vector<Body> make_bodies(const LoadedScene& scene, double step_s,
                              const ModelChoice& choice = {});

/// A place that an exercise wants on the skin.
struct TargetWish {
    glm::dvec3 at_m{0.0};
    std::string organ; // empty: the nearest
};
/// Snapped onto the nearest skin; nothing if there is none within kSnap_m.
inline constexpr double kSnap_m = 10e-3;
std::optional<EmbeddedTarget> snap_target(const LoadedScene& scene, std::span<const Body> bodies,
                                          const TargetWish& wish);

/// Snaps all targets onto the rig's bodies. Throws naming the first that is not near any skin.
void embed_targets(const LoadedScene& scene, std::span<const TargetWish> targets, TissueRig& rig);

/// Bodies at rest with all targets embedded.
TissueRig make_tissue(const LoadedScene& scene, std::span<const TargetWish> targets,
                      const TissueConfig& config);

/// Instruments without devices: geometry, limits, the zero of the counts.
HapticRig make_haptics(const Scene& scene);

/// What the exercise sees in one tick, from recorded integers alone.
tasks::Observation observe_trace(const HapticRig& geometry, const tasks::TickTrace& tick,
                                 const TissueSeen& tissue,
                                 std::span<const tasks::Target> rest_targets);

} // namespace sim
