// tests/sim/path_errors_test.cpp
// Every mistake at follow-path, made on the liver by a script: exactly the expected events.
#include "sim/io/files.h"
#include "sim/session/session.h"

#include <doctest/doctest.h>
#include <filesystem>
#include <unistd.h>

namespace {

std::string step(const std::string& tool, const std::string& verb, const std::string& rest) {
    return "[[step]]\ntool = \"" + tool + "\"\nverb = \"" + verb + "\"\n" + rest + "\n";
}

std::string down_at(const std::string& tool, const std::string& point, const char* force_n) {
    return step(tool, "move", "target = \"" + point + "\"") +
           step(tool, "press",
                "target = \"" + point + "\"\nforce_n = " + force_n + "\nseconds = 2.0");
}

std::string slide_to(const std::string& tool, const std::string& point) {
    return step(tool, "slide", "target = \"" + point + "\"\nseconds = 0.8");
}

/// The shipped path with a limit that a press reaches before it leaves the liver.
std::string gentle_path() {
    std::string text = sim::read_text(sim::assets_dir() / "exercises/follow-path.toml");
    for (const auto& [from, to] : {std::pair{"force_max_n = 1.0", "force_max_n = 0.5"},
                                   std::pair{"force_limit_n = 2.0", "force_limit_n = 0.6"}}) {
        const auto at = text.find(from);
        REQUIRE(at != std::string::npos);
        text.replace(at, std::string(from).size(), to);
    }
    return text;
}

/// What it led to, in order, without the begins and ends of contacts.
std::string events_of(const std::string& script) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("trocar_path_errors_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    sim::write_text(folder / "script.toml", script);
    sim::write_text(folder / "path.toml", gentle_path());
    sim::RunOptions options;
    options.exercise = (folder / "path.toml").string();
    options.hands = (folder / "script.toml").string();
    options.max_seconds = 40.0;
    const auto session = sim::make_session(options);
    std::filesystem::remove_all(folder);
    const sim::Attempt::Outcome outcome = sim::run_lockstep(*session, nullptr, 0);
    CHECK(outcome.row.valid);
    std::string names;
    for (const tasks::Event& event : outcome.events) {
        if (event.kind != tasks::EventKind::contact_begin &&
            event.kind != tasks::EventKind::contact_end)
            names += (names.empty() ? "" : " ") + std::string(tasks::event_name(event.kind));
    }
    return names;
}

} // namespace

TEST_CASE("path errors: drawn from point to point, lifted on the way, is none") {
    std::string script = down_at("right", "1", "0.35");
    for (int k = 2; k <= 14; ++k) {
        const std::string point = std::to_string(k);
        script += slide_to("right", point);
        if (k == 5 || k == 9) // a press keeps its direction, and the liver is round
            script += step("right", "retract", "seconds = 1.0") + down_at("right", point, "0.35");
    }
    script += step("right", "slide", "at_mm = [60.0, 10.0, 15.0]\nseconds = 1.0");
    CHECK(events_of(script) == "path_begun completed");
}

TEST_CASE("path errors: off the path in contact is left, and nothing else") {
    const std::string script =
        down_at("right", "1", "0.35") + slide_to("right", "2") +
        step("right", "slide", "at_mm = [-46.0, -25.0, 30.0]\nseconds = 1.5");
    CHECK(events_of(script) == "path_begun path_left");
}

TEST_CASE("path errors: taken up further on breaks the order, and nothing else") {
    const std::string script = down_at("right", "1", "0.35") + slide_to("right", "2") +
                               step("right", "retract", "seconds = 1.0") +
                               step("right", "move", "at_mm = [-30.0, 0.0, 60.0]\nseconds = 1.0") +
                               down_at("right", "8", "0.35") +
                               step("right", "hold", "seconds = 0.5");
    CHECK(events_of(script) == "path_begun order_broken");
}

TEST_CASE("path errors: another tool on the path has the wrong role, and nothing else") {
    const std::string script = down_at("left", "1", "0.35") + slide_to("left", "2");
    CHECK(events_of(script) == "wrong_role");
}

TEST_CASE("path errors: too much force on the path is that, and nothing else") {
    const std::string script = down_at("right", "1", "0.35") + slide_to("right", "2") +
                               step("right", "hold", "force_n = 0.75\nseconds = 5.0");
    CHECK(events_of(script) == "path_begun over_force");
}
