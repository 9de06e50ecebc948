// Jaws on the shipped liver: FEM steps under prescribed tips, and whole attempts with a script.
#include "haptics/contact/grasp.h"
#include "sim/session/session.h"
#include "tests/sim/grasp_bench.h"

#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <unistd.h>

using grasp_tests::Bench;
using grasp_tests::kRadius_m;

namespace {

// What the published local model yields at rest under a unit force on the held point, m/N.
glm::dmat3 static_compliance(const Bench& bench) {
    const haptics::LocalModels& local = bench.answer->local;
    const haptics::ToolPatch& patch = local.tool[0];
    const auto& corner = patch.triangle[patch.contact.triangle].vertex;
    glm::dmat3 W{0.0};
    for (int m = 0; m < patch.modes; ++m) {
        glm::dvec3 s{0.0};
        for (int k = 0; k < 3; ++k)
            for (int axis = 0; axis < 3; ++axis)
                s[axis] += patch.contact.weight[k] * patch.shape[corner[k]][axis][m];
        W += glm::outerProduct(s, s) / local.lambda[patch.first_mode + m];
    }
    return W;
}

const char* const kScript = R"(
[[step]]
verb = "move"
tool = "right"
target = "1"
seconds = 2
[[step]]
verb = "press"
tool = "right"
target = "1"
force_n = 0.15
seconds = 4
[[step]]
verb = "grasp"
tool = "right"
[[step]]
verb = "retract"
tool = "right"
seconds = 1.0
[[step]]
verb = "retract"
tool = "right"
seconds = 1.0
[[step]]
verb = "release"
tool = "right"
[[step]]
verb = "wait"
seconds = 0.5
)";

struct TemporaryScript {
    std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("trocar_grasp_" + std::to_string(getpid()));
    TemporaryScript() {
        std::filesystem::create_directories(folder);
        std::ofstream(folder / "grasp.toml") << kScript;
    }
    ~TemporaryScript() { std::filesystem::remove_all(folder); }
    sim::RunOptions options() const {
        sim::RunOptions out;
        out.hands = (folder / "grasp.toml").string();
        out.max_seconds = 12.0;
        return out;
    }
};

} // namespace

TEST_CASE("grasp: a lifted organ follows the tip, as hard as the local model says") {
    // a block held along its sides: what a liver yields as a whole is not in a local model
    const scene_tests::Directory scene;
    Bench bench(0, scene.path(), grasp_tests::kOverBlock_m);
    bench.lift(4e-3);
    const glm::dvec3 before = bench.rest(bench.tip(4e-3), 300);
    REQUIRE(bench.grasped());
    CHECK(glm::dot(before, bench.normal) < -0.05); // it pulls
    CHECK(glm::dot(bench.material_place() - bench.place, bench.normal) > 0.5e-3);

    const haptics::LocalLaw law =
        sim::law_on(bench.rig.bodies[0], bench.rig.contact[0].at, 0, bench.rig.floor_mpn[0]);
    const haptics::GraspCompliance held = haptics::grasp_compliance(law);
    const glm::dvec3 n = bench.rig.contact[0].normal;
    const glm::dmat3 own = static_compliance(bench) + glm::dmat3{held.tangential_mpn} +
                           (held.normal_mpn - held.tangential_mpn) * glm::outerProduct(n, n);
    for (const glm::dvec3& direction : {n, glm::normalize(glm::cross(n, {0, 1, 0}))}) {
        const glm::dvec3 there = bench.tip(4e-3) + 1e-3 * direction;
        const glm::dvec3 change = bench.rest(there, 300) - before;
        const glm::dvec3 wanted = -glm::inverse(own) * (1e-3 * direction);
        MESSAGE("1 mm more: ", 1e3 * glm::length(change), " mN, local model ",
                1e3 * glm::length(wanted), " mN");
        CHECK(glm::distance(change, wanted) < 0.07 * glm::length(wanted));
        bench.rest(bench.tip(4e-3), 300);
    }
}

TEST_CASE("grasp: the organ slips out of the jaws at grip times friction and not before") {
    for (const double jaw : {0.8, 1.0}) {
        const double limit_n = 2.4 * (jaw - 0.4) / 0.6;
        const glm::dvec3 up = Bench().normal;
        const glm::dvec3 across = glm::normalize(glm::cross(up, {0, 1, 0}));
        for (const glm::dvec3& way : {up, across, 0.7 * (up + across)}) {
            Bench b;
            b.rig.config.basis = false; // nobody reads it here
            b.lift(-2e-3);
            b.jaw = jaw;
            const haptics::SurfacePoint held = b.rig.contact[0].at;
            int slipping = 0;
            for (int i = 0; i < 2000 && slipping < 5; ++i) {
                b.step(b.tip(-2e-3) + 4e-4 * i * way);
                REQUIRE(b.grasped());
                REQUIRE(glm::length(b.force()) < 5.0);
                const bool moved = b.rig.contact[0].at.triangle != held.triangle ||
                                   b.rig.contact[0].at.weight != held.weight ||
                                   b.rig.memory[0].out_m > 0.0;
                if (!moved)
                    continue;
                ++slipping;
                const glm::dvec3 f = b.force(), n = b.rig.contact[0].normal;
                const double pull = glm::length(f - std::max(0.0, glm::dot(f, n)) * n);
                CHECK(pull == doctest::Approx(limit_n).scale(0.0).epsilon(0.02));
            }
            CHECK(slipping == 5);
        }
    }
}

TEST_CASE("grasp: a lift held for a minute does not drift") {
    Bench bench;
    bench.rig.config.basis = false; // nobody reads it here
    bench.lift(6e-3);
    const glm::dvec3 tip =
        bench.tip(6e-3) + 4e-3 * glm::normalize(glm::cross(bench.normal, {0, 1, 0}));
    const glm::dvec3 force = bench.rest(tip, 500);
    const glm::dvec3 place = bench.material_place();
    const haptics::SurfacePoint at = bench.rig.contact[0].at;
    const glm::dvec3 later = bench.rest(tip, 6000);
    REQUIRE(bench.grasped());
    MESSAGE("drift ", 1e6 * glm::distance(bench.material_place(), place), " um, force ",
            1e3 * glm::length(force), " mN, changed ", 1e3 * glm::distance(later, force), " mN");
    CHECK(glm::distance(bench.material_place(), place) < 0.1e-3);
    CHECK(bench.rig.contact[0].at.weight == at.weight);
    CHECK(glm::distance(later, force) < 1e-3);
}

TEST_CASE("grasp: opening leaves no force in the next step and the energy only falls") {
    Bench bench;
    bench.lift(8e-3);
    bench.rest(bench.tip(8e-3), 100);
    REQUIRE(glm::dot(bench.force(), bench.normal) < -0.1);
    double energy = bench.energy_j();
    const double held = energy;
    bench.jaw = 0.0;
    double most_j = 0.0;
    for (int i = 0; i < 200; ++i) {
        CHECK(bench.step(bench.tip(8e-3)) == glm::dvec3{0.0});
        most_j = std::max(most_j, bench.energy_j() - energy);
        energy = bench.energy_j();
    }
    MESSAGE("held ", 1e3 * held, " mJ, largest rise ", 1e3 * most_j, " mJ, left ", 1e3 * energy,
            " mJ");
    CHECK(most_j < 1e-3 * held);
    CHECK(energy < 0.01 * held);
}

TEST_CASE("grasp: nothing is taken in the air, and nothing rigid at all") {
    Bench air;
    air.jaw = 1.0;
    air.rest(air.tip(1.7e-3), 3);
    CHECK_FALSE(air.grasped());
    air.rest(air.tip(-2e-3), 5); // closed jaws push
    CHECK_FALSE(air.grasped());
    CHECK(glm::dot(air.force(), air.normal) > 0.0);

    Bench close;
    close.jaw = 1.0;
    close.rest(close.tip(1.3e-3), 3);
    CHECK(close.grasped());
    CHECK(glm::length(close.force()) < 1e-6);
    close.rest(close.tip(8e-3), 100);
    CHECK(glm::dot(close.force(), close.normal) < -0.05);
    sim::SurfaceNow drawn; // the skin drawn under the tip has come along
    sim::draw_surface(close.rig, drawn);
    double nearest_m = 1.0;
    for (const glm::vec3& p : drawn.position_m[0])
        nearest_m = std::min(nearest_m, glm::distance(glm::dvec3(p), close.tip(8e-3)));
    MESSAGE("skin drawn ", 1e3 * nearest_m, " mm from the tip's centre");
    CHECK(nearest_m < kRadius_m + 4e-3);

    std::size_t rigid = 0;
    while (rigid < air.rig.bodies.size() && air.rig.bodies[rigid].soft)
        ++rigid;
    REQUIRE(rigid < air.rig.bodies.size());
    Bench wall(rigid);
    wall.rest(wall.tip(-1e-3), 3);
    REQUIRE(wall.rig.contact[0].body == static_cast<int>(rigid));
    wall.jaw = 1.0;
    wall.rest(wall.tip(-1e-3), 3);
    CHECK_FALSE(wall.grasped());
    CHECK(wall.step(wall.tip(1e-3)) == glm::dvec3{0.0});
}

TEST_CASE("grasp: an attempt with grasps gives the same hash again, and replays to it") {
    const TemporaryScript script;
    tasks::Logbook logbook((script.folder / "station.db").string());
    std::int64_t id = 0;
    std::string hash;
    {
        const auto session = sim::make_session(script.options());
        tasks::AttemptRow row = sim::attempt_row(*session, false);
        row.session = logbook.add_session(sim::session_row("scripted"));
        id = logbook.begin_attempt(row);
        hash = sim::run_lockstep(*session, &logbook, id).row.log_sha256;
    }
    const auto again = sim::make_session(script.options());
    CHECK(sim::run_lockstep(*again, nullptr, 0).row.log_sha256 == hash);

    const auto recorded = logbook.attempt(id);
    REQUIRE(recorded);
    int grasping = 0, pulling = 0;
    std::vector<tasks::Chunk> chunks;
    for (const auto& bytes : logbook.chunks(id))
        chunks.push_back(tasks::decode_chunk(bytes));
    for (const tasks::Chunk& chunk : chunks)
        for (const tasks::TickTrace& tick : chunk.ticks) {
            grasping += (tick.tool[1].flags & 16) != 0;
            pulling += (tick.tool[1].flags & 16) != 0 && tick.tool[1].force_mn[2] < -50;
        }
    CHECK(grasping > 500);
    CHECK(pulling > 200);
    const auto session = sim::session_of(*recorded, "");
    const sim::ReplayResult replayed =
        sim::run_replay(*session, *recorded, chunks, logbook.events(id));
    CHECK(replayed.outcome.row.log_sha256 == hash);
    CHECK(replayed.worst_force_difference_n == 0.0);
}
