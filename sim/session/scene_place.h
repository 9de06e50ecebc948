// sim/session/scene_place.h
// Where a scene's files lie. A scene is a directory with scene.toml, its organs, its painted
// regions and its own exercises/; it names them by paths inside itself, so it can be moved or
// copied anywhere. Called by commands and session setup.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sim {

struct ScenePlace {
    std::filesystem::path file;   // the scene's text
    std::filesystem::path folder; // that its paths start from
    // Scenes of assets/scenes and lone .toml files come without organs: what is not beside them
    // is taken from the build's organ folder. A scene directory of one's own never is.
    bool shipped = false;
};

/// `scene`: a directory with scene.toml, a .toml file, or the name of one of assets/scenes.
/// Throws std::runtime_error naming what was tried.
ScenePlace find_scene(const std::string& scene);

/// For a scene whose text is known, from a logbook: the shipped scene of that id, else a place
/// with the build's organs alone.
ScenePlace place_of_known(const std::string& id);

/// A path as a scene may write it: relative, inside the scene's folder, no "..".
bool stays_inside(const std::string& path);

std::filesystem::path organ_file(const ScenePlace& place, const std::string& file);

/// The scene's own exercises/NAME.toml before assets/exercises/NAME.toml, or `exercise` itself if
/// it is a file. Throws std::runtime_error naming what was tried.
std::filesystem::path find_exercise(const ScenePlace& place, const std::string& exercise);

/// The scene that an exercise is for when nobody names one: "basic" for those of assets/exercises,
/// else the first of assets/scenes, by name, that has it; "basic" too if none does.
std::string scene_for(const std::string& exercise);

/// What a menu offers when no scene is named: the exercises of assets/exercises, then what other
/// scenes have beside them, each with scene_for() it.
struct OfferedExercise {
    std::string name, scene;
};
std::vector<OfferedExercise> offered_exercises();

/// Names for a menu, sorted: the scene's own exercises; if it has none and is shipped, those of
/// assets/exercises.
std::vector<std::string> exercise_names(const ScenePlace& place);

} // namespace sim
