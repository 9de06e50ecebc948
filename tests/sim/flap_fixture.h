// tests/sim/flap_fixture.h
// Scripted attempts at find-tubes in the scene with the flap, told by the exercise's own places:
// each step is a few lines of a script's text.
#pragma once

#include "sim/io/files.h"
#include "sim/session/session.h"

#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

namespace flap_tests {

inline constexpr int kArtery = 0, kDuct = 1, kVein = 2, kLift = 3; // in the exercise's order
inline constexpr std::array<const char*, 3> kTube{"artery", "duct", "vein"};

/// The shipped scene and exercise, at rest, without hands.
inline std::unique_ptr<sim::Session> flap_session() {
    sim::RunOptions options;
    options.scene = "flap";
    options.exercise = "find-tubes";
    return sim::make_session(options, false);
}

/// Places of the tubes and of the lift on the skins at rest.
inline const std::vector<tasks::Target>& places() {
    static const std::vector<tasks::Target> made = flap_session()->rest_targets;
    return made;
}

inline std::string mm(const glm::dvec3& place_m) {
    return fmt::format("[{:.2f}, {:.2f}, {:.2f}]", 1e3 * place_m.x, 1e3 * place_m.y,
                       1e3 * place_m.z);
}

inline std::string move(const char* tool, const glm::dvec3& to_m, double seconds) {
    return fmt::format("[[step]]\nverb = \"move\"\ntool = \"{}\"\nat_mm = {}\nseconds = {:.2f}\n",
                       tool, mm(to_m), seconds);
}

inline std::string wait(double seconds) {
    return fmt::format("[[step]]\nverb = \"wait\"\nseconds = {:.2f}\n", seconds);
}

inline std::string look(const glm::dvec3& at_m, double distance_m) {
    return fmt::format("[[step]]\nverb = \"look\"\nat_mm = {}\ndistance_mm = {:.1f}\n"
                       "seconds = 0.8\n",
                       mm(at_m), 1e3 * distance_m);
}

inline constexpr double kNear_m = 0.1; // marks are larger than least_share from there

inline std::string look_at(int tube) {
    return look(places()[static_cast<std::size_t>(tube)].position_m, kNear_m);
}
/// From where everything is in the picture.
inline std::string look_from_afar() {
    return look({0.0, 0.0, 0.02}, 0.2);
}

inline glm::dvec3 above(int place, double height_m) {
    const tasks::Target& target = places()[static_cast<std::size_t>(place)];
    return target.position_m + height_m * target.normal;
}

/// The tip comes down over the tube, and stops so far over the skin; 3 mm is the tip itself.
inline std::string point(const char* tool, int tube, double height_m = 3.8e-3) {
    return move(tool, above(tube, 30e-3), 1.2) + move(tool, above(tube, height_m), 0.8);
}
inline std::string leave(const char* tool, int tube) {
    return move(tool, above(tube, 30e-3), 0.8);
}

/// Takes hold of the flap where it is marked, and brings it where the exercise says.
inline std::string lift_flap() {
    const glm::dvec3 to_m = flap_session()->exercise.lift->to_m;
    return look_from_afar() + move("left", above(kLift, 15e-3), 1.0) +
           move("left", above(kLift, 1e-3), 0.5) + "[[step]]\nverb = \"grasp\"\ntool = \"left\"\n" +
           move("left", to_m, 2.5) + wait(0.5);
}

/// What a script led to, in order, without the begins and ends of contacts.
struct Led {
    std::string events;
    int found = 0;
    bool valid = false;
};

/// A script in a file, for as long as this lives.
struct ScriptFile {
    std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("trocar_find_tubes_" + std::to_string(getpid()));

    explicit ScriptFile(const std::string& script) {
        std::filesystem::create_directories(folder);
        sim::write_text(folder / "script.toml", script);
    }
    ~ScriptFile() { std::filesystem::remove_all(folder); }
    ScriptFile(const ScriptFile&) = delete;

    sim::RunOptions options(double max_seconds) const {
        sim::RunOptions options;
        options.scene = "flap";
        options.exercise = "find-tubes";
        options.hands = (folder / "script.toml").string();
        options.max_seconds = max_seconds;
        return options;
    }
};

inline Led led_by(sim::Session& session) {
    const sim::Attempt::Outcome outcome = sim::run_lockstep(session, nullptr, 0);
    Led led;
    led.valid = outcome.row.valid;
    for (const tasks::Event& event : outcome.events) {
        if (event.kind == tasks::EventKind::contact_begin ||
            event.kind == tasks::EventKind::contact_end)
            continue;
        led.events += (led.events.empty() ? "" : " ") + std::string(tasks::event_name(event.kind));
        led.found += event.kind == tasks::EventKind::tube_found;
    }
    return led;
}

inline Led led_to(const std::string& script, double max_seconds) {
    const ScriptFile file(script);
    return led_by(*sim::make_session(file.options(max_seconds)));
}

} // namespace flap_tests
