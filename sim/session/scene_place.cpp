#include "sim/session/scene_place.h"

#include "sim/io/files.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace sim {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSceneFile = "scene.toml";

bool is_shipped(const fs::path& folder) {
    std::error_code ignored;
    const fs::path parent = fs::weakly_canonical(folder, ignored).parent_path();
    return parent == fs::weakly_canonical(assets_dir() / "scenes", ignored);
}

fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

ScenePlace place_at(const fs::path& file) {
    const fs::path folder = folder_of(file);
    return {file, folder, file.filename() != kSceneFile || is_shipped(folder)};
}

bool is_name(const std::string& text) {
    return !text.empty() && text.find_first_of("/\\") == std::string::npos && text != "." &&
           text != "..";
}

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code absent;
    for (const auto& entry : fs::directory_iterator(folder, absent)) {
        if (entry.path().extension() == ".toml")
            names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

} // namespace

ScenePlace find_scene(const std::string& scene) {
    if (fs::is_directory(scene)) {
        if (const fs::path file = fs::path(scene) / kSceneFile; fs::is_regular_file(file))
            return place_at(file);
        if (!is_name(scene)) {
            throw std::runtime_error(
                fmt::format("{}: is a directory without {}", scene, kSceneFile));
        }
    }
    if (fs::is_regular_file(scene))
        return place_at(scene);
    const fs::path named = assets_dir() / "scenes" / scene / kSceneFile;
    if (is_name(scene) && fs::is_regular_file(named))
        return place_at(named);
    throw std::runtime_error(fmt::format("scene \"{}\" is neither a directory with {}, nor a file, "
                                         "nor one of the scenes (tried {})",
                                         scene, kSceneFile, named.string()));
}

ScenePlace place_of_known(const std::string& id) {
    const fs::path folder = assets_dir() / "scenes" / id;
    if (is_name(id) && fs::is_regular_file(folder / kSceneFile))
        return {"scene in the logbook", folder, true};
    return {"scene in the logbook", organ_path("."), true};
}

bool stays_inside(const std::string& path) {
    const fs::path p(path);
    return !path.empty() && path.find('\\') == std::string::npos &&
           path.find('\0') == std::string::npos && p.is_relative() && p.has_filename() &&
           std::none_of(p.begin(), p.end(), [](const fs::path& part) { return part == ".."; });
}

fs::path organ_file(const ScenePlace& place, const std::string& file) {
    const fs::path own = place.folder / file;
    if (place.shipped && !fs::exists(own))
        return organ_path(file);
    return own;
}

fs::path find_exercise(const ScenePlace& place, const std::string& exercise) {
    if (is_name(exercise)) {
        const fs::path own = place.folder / "exercises" / (exercise + ".toml");
        if (fs::is_regular_file(own))
            return own;
    }
    return find_asset("exercises", exercise);
}

std::string scene_for(const std::string& exercise) {
    const std::string usual = "basic", file = exercise + ".toml";
    if (!is_name(exercise) || fs::is_regular_file(assets_dir() / "exercises" / file))
        return usual;
    std::vector<std::string> scenes;
    std::error_code absent;
    for (const auto& entry : fs::directory_iterator(assets_dir() / "scenes", absent)) {
        if (fs::is_regular_file(entry.path() / "exercises" / file))
            scenes.push_back(entry.path().filename().string());
    }
    const auto first = std::min_element(scenes.begin(), scenes.end());
    return first == scenes.end() ? usual : *first;
}

std::vector<OfferedExercise> offered_exercises() {
    std::vector<std::string> names = names_in(assets_dir() / "exercises"), others;
    std::error_code absent;
    for (const auto& scene : fs::directory_iterator(assets_dir() / "scenes", absent)) {
        for (const std::string& name : names_in(scene.path() / "exercises"))
            if (std::find(names.begin(), names.end(), name) == names.end())
                others.push_back(name);
    }
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    names.insert(names.end(), others.begin(), others.end());
    std::vector<OfferedExercise> offered;
    for (const std::string& name : names)
        offered.push_back({name, scene_for(name)});
    return offered;
}

std::vector<std::string> exercise_names(const ScenePlace& place) {
    std::vector<std::string> names = names_in(place.folder / "exercises");
    if (names.empty() && place.shipped)
        names = names_in(assets_dir() / "exercises");
    return names;
}

} // namespace sim
