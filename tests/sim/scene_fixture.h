// tests/sim/scene_fixture.h
// A scene directory for tests: a block of tissue 80 x 80 x 40 mm under three tools, and rigid
// plates put where a test wants something in the way. Written to a temporary folder.
#pragma once

#include "sim/check/scene_check.h"
#include "sim/io/files.h"
#include "sim/session/session.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <filesystem>
#include <unistd.h>

namespace scene_tests {

inline const char* const kScene = R"(id = "bench"
title = "A block"

[[organ]]
name = "block"
file = "block.organ"
young_kpa = 6.0

[[organ.anchor]]
low_mm = [-1, -1, -1]
high_mm = [81, 81, 10]

[[tool]]
role = "left"
fulcrum_mm = [-40, 40, 160]
start_tip_mm = [10, 40, 90]

[[tool]]
role = "right"
fulcrum_mm = [120, 40, 160]
start_tip_mm = [70, 40, 90]

[[tool]]
role = "assist"
fulcrum_mm = [40, 130, 160]
start_tip_mm = [40, 70, 90]

[view]
eye_mm = [40, 40, 220]
look_at_mm = [40, 40, 40]
up = [0, 1, 0]
field_of_view_deg = 50
)";

inline const char* const kExercise = R"(id = "bench"
title = "Three points"
card = "Touch them"
force_min_n = 0.1
force_max_n = 1.0

[[target]]
id = "1"
role = "right"
at_mm = [55, 25, 40]

[[target]]
id = "2"
role = "left"
at_mm = [25, 40, 40]

[[target]]
id = "3"
role = "assist"
at_mm = [40, 60, 40]
)";

/// `text` with every `from` written as `to`; a test that changes nothing is a mistake.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
    REQUIRE(text.find(from) != std::string::npos);
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

inline tissue::BakedOrgan block() {
    return tissue::read_organ(sim::read_bytes(sim::organ_path("block_s12.organ")));
}

/// A rigid rectangle low..high in x and y at height z, facing up or down; millimetres.
inline tissue::BakedOrgan plate(glm::dvec2 low_mm, glm::dvec2 high_mm, double z_mm, bool up) {
    tissue::BakedOrgan organ;
    organ.name = "plate";
    organ.rigid = true;
    organ.surface.rest_m = {1e-3 * glm::dvec3{low_mm.x, low_mm.y, z_mm},
                            1e-3 * glm::dvec3{high_mm.x, low_mm.y, z_mm},
                            1e-3 * glm::dvec3{high_mm.x, high_mm.y, z_mm},
                            1e-3 * glm::dvec3{low_mm.x, high_mm.y, z_mm}};
    organ.surface.triangles = {{0, 1, 2}, {0, 2, 3}};
    if (!up)
        organ.surface.triangles = {{0, 2, 1}, {0, 3, 2}};
    organ.surface.neighbours = tissue::triangle_neighbours(organ.surface.triangles);
    return organ;
}

inline const char* const kPlate = R"(
[[organ]]
name = "plate"
file = "plate.organ"
)";

struct Directory {
    std::filesystem::path folder;

    explicit Directory(const std::string& name = "bench")
        : folder(std::filesystem::temp_directory_path() /
                 ("trocar_scene_" + std::to_string(getpid())) / name) {
        std::filesystem::create_directories(folder / "exercises");
        write("scene.toml", kScene);
        write("exercises/bench.toml", kExercise);
        add("block.organ", block());
    }
    ~Directory() { std::filesystem::remove_all(folder.parent_path()); }
    Directory(const Directory&) = delete;

    void write(const std::string& file, const std::string& text) const {
        sim::write_text(folder / file, text);
    }
    void add(const std::string& file, const tissue::BakedOrgan& organ) const {
        const std::vector<std::byte> bytes = tissue::write_organ(organ);
        write(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    }
    /// The block with a plate somewhere.
    void put(const tissue::BakedOrgan& plate) const {
        add("plate.organ", plate);
        write("scene.toml", std::string(kScene) + kPlate);
    }
    std::string path() const { return folder.string(); }
    sim::SceneCheck check() const { return sim::check_scene(path()); }
};

inline std::vector<std::string> kinds(const sim::SceneCheck& check) {
    std::vector<std::string> out;
    for (const sim::Finding& finding : check.finding)
        out.push_back(finding.kind);
    return out;
}

} // namespace scene_tests
