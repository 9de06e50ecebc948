// tests/sim/scene_place_test.cpp
// A scene directory may lie anywhere: the same bytes give the same hash and the same attempt.
#include "tests/sim/scene_fixture.h"

using namespace scene_tests;

namespace {

sim::RunOptions short_run(const std::string& scene, const std::string& exercise) {
    sim::RunOptions options;
    options.scene = scene;
    options.exercise = exercise;
    options.max_seconds = 8.0;
    options.seed = 4;
    return options;
}

sim::Attempt::Outcome perform(const sim::RunOptions& options, tasks::Logbook* logbook = nullptr,
                              std::int64_t* id = nullptr) {
    const auto session = sim::make_session(options);
    std::int64_t attempt = 0;
    if (logbook) {
        tasks::AttemptRow row = sim::attempt_row(*session, false);
        row.session = logbook->add_session(sim::session_row("scripted"));
        attempt = *id = logbook->begin_attempt(row);
    }
    return sim::run_lockstep(*session, logbook, attempt);
}

double peak_n(const sim::Attempt::Outcome& outcome) {
    for (const tasks::Metric& m : outcome.metrics) {
        if (m.id == "force_peak")
            return m.value;
    }
    return 0.0;
}

} // namespace

TEST_CASE("scene: a moved directory has the same hash and replays to the same log hash") {
    const Directory here("first/bench"), there("second/other name");
    tasks::Logbook logbook((here.folder / "log.db").string());
    std::int64_t id = 0;
    const sim::Attempt::Outcome live = perform(short_run(here.path(), "bench"), &logbook, &id);
    CHECK(peak_n(live) > 0.05); // it did touch something
    CHECK(sim::load_scene(here.path()).hash == sim::load_scene(there.path()).hash);
    CHECK(perform(short_run(there.path(), "bench")).row.log_sha256 == live.row.log_sha256);

    const auto row = logbook.attempt(id);
    REQUIRE(row);
    std::vector<tasks::Chunk> chunks;
    for (const auto& bytes : logbook.chunks(id))
        chunks.push_back(tasks::decode_chunk(bytes));
    const auto session = sim::session_of(*row, there.path());
    CHECK(sim::run_replay(*session, *row, chunks, logbook.events(id)).outcome.row.log_sha256 ==
          live.row.log_sha256);
    CHECK_THROWS(sim::session_of(*row)); // nobody knows where it is
}

TEST_CASE("scene: the hash covers text, organs and regions, and nothing else") {
    const Directory directory;
    directory.write("scene.toml", with(kScene, "low_mm = [-1, -1, -1]\nhigh_mm = [81, 81, 10]\n",
                                       "region = \"r.txt\"\n"));
    directory.write("r.txt", "40 40 5 20\n");
    const auto hash = [&] { return sim::load_scene(directory.path()).hash; };
    const std::string before = hash();
    directory.write("notes.txt", "anything");
    directory.write("exercises/bench.toml", "anything");
    CHECK(hash() == before);
    directory.write("r.txt", "40 40 5 21\n");
    CHECK(hash() != before);
    directory.write("r.txt", "40 40 5 20\n");
    CHECK(hash() == before);
    tissue::BakedOrgan other = block();
    other.material.friction += 0.1;
    directory.add("block.organ", other);
    CHECK(hash() != before);
}

TEST_CASE("scene: its own exercise comes before the shipped one of that name") {
    const Directory directory;
    directory.write("exercises/touch-points.toml", kExercise);
    const sim::ScenePlace place = sim::find_scene(directory.path());
    CHECK(sim::find_exercise(place, "touch-points") ==
          directory.folder / "exercises/touch-points.toml");
    CHECK(sim::exercise_names(place) == std::vector<std::string>{"bench", "touch-points"});
    CHECK(sim::find_exercise(sim::find_scene("basic"), "touch-points") ==
          sim::assets_dir() / "exercises/touch-points.toml");
    CHECK_THROWS(sim::find_exercise(place, "no-such"));
    CHECK_THROWS(sim::find_scene("no-such"));
    CHECK_THROWS(sim::find_scene("../scenes/basic"));
}

TEST_CASE("scene: an organ that nobody touches stays at rest to the bit") {
    sim::RunOptions options = short_run("two_organs", "touch-points");
    options.max_seconds = 9.0; // the first target is on the spleen, and takes that long
    const auto session = sim::make_session(options);
    sim::run_lockstep(*session, nullptr, 0);
    const sim::Body &liver = session->tissue.bodies[0], &spleen = session->tissue.bodies[1];
    CHECK(liver.soft->resting);
    CHECK(liver.soft->linearisations == 0);
    CHECK(std::ranges::equal(tissue::position_m(liver.soft->solid), liver.organ->mesh.rest_m));
    CHECK_FALSE(
        std::ranges::equal(tissue::position_m(spleen.soft->solid), spleen.organ->mesh.rest_m));
}

TEST_CASE("scene: each tool meets the tissue with its own tip") {
    const Directory mixed, narrow("narrow");
    const std::string left = "start_tip_mm = [10, 40, 90]\n";
    mixed.write("scene.toml", with(kScene, left, left + "tip_radius_mm = 1.5\n"));
    std::string all = kScene;
    for (const std::string& start : {left, std::string("start_tip_mm = [70, 40, 90]\n"),
                                     std::string("start_tip_mm = [40, 70, 90]\n")})
        all = with(all, start, start + "tip_radius_mm = 1.5\n");
    narrow.write("scene.toml", all);
    const auto bodies = [](const Directory& d) {
        return sim::make_bodies(sim::load_scene(d.path()), 0.01);
    };
    constexpr double kLight_n = 1e-3; // the contact is small beside either tip
    const auto depth_m = [](const sim::Body& body, int tool) {
        const haptics::LocalLaw law = sim::law_on(body, {7, {0.3, 0.3, 0.4}}, tool, 0.0);
        return haptics::law_at(law, std::cbrt(kLight_n / law.table->force_scale_n)).depth_m;
    };
    const std::vector<sim::Body> a = bodies(mixed), b = bodies(narrow), c = bodies(Directory());
    CHECK(depth_m(a[0], 0) == depth_m(b[0], 0));
    CHECK(depth_m(a[0], 1) == depth_m(c[0], 1));
    CHECK(a[0].tip[1].table == a[0].tip[2].table);
    // Hertz: a sphere of half the radius sinks cbrt(2) times as deep; thick tissue, less the
    // linear part that both share
    const double linear_m = kLight_n * sim::law_on(c[0], {7, {0.3, 0.3, 0.4}}, 1, 0.0).normal_mpn;
    CHECK((depth_m(a[0], 0) - linear_m) / (depth_m(a[0], 1) - linear_m) ==
          doctest::Approx(std::cbrt(2.0)).scale(0.0).epsilon(0.02));
}
