// tests/sim/person_test.cpp
// A person at one mouse beside the assistants: who holds what, and what the trace says of it.
#include "scene_fixture.h"
#include "sim/session/replayer.h"

#include <cmath>
#include <glm/geometric.hpp>

using namespace sim;
using namespace scene_tests;

namespace {

constexpr std::uint8_t kFaultless = 2, kAssistant = 8, kMount = 16; // ScopeTrace, present

RunOptions options_of(const std::string& exercise, const std::string& scene) {
    RunOptions options;
    options.exercise = exercise;
    options.scene = scene;
    return options;
}

/// Ticks without tissue: nothing is touched here.
struct Bench {
    std::unique_ptr<Session> session;
    tasks::TickTrace trace;
    tasks::HandSight sight;

    Bench(const std::string& exercise, const std::string& scene)
        : session(make_session(options_of(exercise, scene), false)) {
        give_to_person(*session);
        sight = sight_of(*session, trace, 0, 0, false);
        run(1);
    }
    void run(int ticks) {
        for (int i = 0; i < ticks; ++i) {
            crew_tick(session->crew, session->haptics, sight);
            haptic_tick(session->haptics, *session->exchange, trace);
            sight = sight_of(*session, trace, 0, 0, false);
        }
    }
    PointerGoals& pointer() { return session->crew.pointer; }
    const ToolsNow& now() { return session->exchange->tools_seen.latest(); }
    void take_scope() {
        const ScopeNow scope = now().scope;
        pointer().scope_tip_m = scope.view.eye_m;
        pointer().camera_rad = scope.camera_rad;
        pointer().optic_rad = scope.optic_rad;
        pointer().scope_held = true;
    }
};

int largest(const tasks::ScopeTrace& a, const tasks::ScopeTrace& b) {
    int most = std::max(std::abs(a.camera_counts - b.camera_counts),
                        std::abs(a.optic_counts - b.optic_counts));
    for (int axis = 0; axis < 3; ++axis)
        most = std::max(most, std::abs(a.counts[axis] - b.counts[axis]));
    return most;
}

} // namespace

TEST_CASE("person: in find-tubes he holds one tool, experts the others and the endoscope") {
    Bench bench("find-tubes", "flap");
    CHECK(bench.pointer().held == std::array<bool, kTools>{false, true, false});
    CHECK(bench.trace.scope.flags == (kFaultless | kAssistant));
    const glm::dvec3 left_m = bench.now().tip[0].centre_m, right_m = bench.now().tip[1].centre_m;
    bench.run(2500);
    CHECK(glm::distance(bench.now().tip[0].centre_m, left_m) > 5e-3);   // on its way to the flap
    CHECK(glm::distance(bench.now().tip[1].centre_m, right_m) < 30e-6); // counts
}

TEST_CASE("person: taking and giving back the endoscope moves nothing by more than rounding") {
    Bench bench("find-tubes", "flap");
    bench.run(300);
    tasks::ScopeTrace before = bench.trace.scope;
    bench.take_scope();
    bench.run(1);
    CHECK(largest(bench.trace.scope, before) <= 1);
    CHECK(bench.trace.scope.flags == kFaultless);
    bench.pointer().scope_tip_m += glm::dvec3{8e-3, 5e-3, -4e-3}; // he looks elsewhere, askew
    bench.pointer().camera_rad += 0.4;
    bench.pointer().optic_rad -= 0.3;
    bench.run(50);
    before = bench.trace.scope;
    bench.pointer().scope_held = false;
    bench.run(1);
    CHECK(bench.trace.scope.flags == (kFaultless | kAssistant));
    CHECK(largest(bench.trace.scope, before) <= 4); // 80 um, 4 mrad: an expert's own tremor
    bench.run(6000);                                // brought back to the work, level
    CHECK(std::abs(bench.now().scope.horizon_rad) < 0.3);
}

TEST_CASE("person: a tool that he lets go stays where it is at first, its jaws as they are") {
    Bench bench("find-tubes", "flap");
    bench.pointer().tip_m[1] += glm::dvec3{-0.01, 0.01, 0.0};
    bench.pointer().jaw[1] = 1.0;
    bench.run(500);
    const glm::dvec3 tip_m = bench.now().tip[1].centre_m;
    bench.pointer().held = {true, false, false};
    bench.pointer().tip_m[0] = bench.now().tip[0].centre_m;
    bench.run(1);
    CHECK(glm::distance(bench.now().tip[1].centre_m, tip_m) < 200e-6); // tremor and counts
    CHECK(bench.now().jaw[1] == 1.0);
}

TEST_CASE("person: on a mount the endoscope stays where he left it") {
    const Directory directory;
    directory.write("scene.toml", std::string(kScene) + "\n[scope]\nfulcrum_mm = [40, -20, 290]\n");
    Bench bench("bench", directory.path());
    CHECK(bench.pointer().held == std::array<bool, kTools>{true, true, true});
    CHECK(bench.trace.scope.flags == (kFaultless | kMount));
    bench.take_scope();
    bench.pointer().scope_tip_m += glm::dvec3{8e-3, 5e-3, -4e-3};
    bench.run(10);
    CHECK(bench.trace.scope.flags == kFaultless);
    const tasks::ScopeTrace left = bench.trace.scope;
    CHECK(largest(left, tasks::ScopeTrace{}) > 50);
    bench.pointer().scope_held = false;
    bench.run(100);
    CHECK(bench.trace.scope.flags == (kFaultless | kMount));
    CHECK(largest(bench.trace.scope, left) == 0);
}

TEST_CASE("person: a replay holds the endoscope as it was recorded, and by whom") {
    const auto recorded = make_session(options_of("find-tubes", "flap"));
    recorded->keep_recording = true;
    recorded->max_ticks = 2500;
    const Attempt::Outcome outcome = run_lockstep(*recorded, nullptr, 0);
    std::vector<tasks::Chunk> chunks;
    for (const auto& bytes : outcome.chunks)
        chunks.push_back(tasks::decode_chunk(bytes));
    const Recording recording = join(chunks);
    REQUIRE(largest(recording.ticks.back().scope, tasks::ScopeTrace{}) > 50);
    const auto again = session_of(outcome.row);
    Replayer replayer(*again, recording);
    int different = 0;
    while (!replayer.done()) {
        const tasks::ScopeTrace& wanted = recording.ticks[replayer.next()].scope;
        const tasks::ScopeTrace& given = replayer.tick(nullptr).scope;
        different += largest(given, wanted) != 0 || given.flags != wanted.flags;
    }
    CHECK(different == 0);
}
