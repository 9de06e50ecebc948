// sim/command/replay.cpp
// trocar replay: the recorded motion and schedule again. Same build and machine: the same hash.
#include "sim/command/commands.h"
#include "sim/command/report.h"
#include "sim/session/session.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace sim {
namespace {

struct ReplayArguments {
    std::string db, coupling, scene;
    std::int64_t attempt = 0;
    bool json = false;
};

void replay(const ReplayArguments& a, int& exit_code) {
    tasks::Logbook logbook(a.db);
    const auto recorded = logbook.attempt(a.attempt);
    if (!recorded) {
        throw std::invalid_argument(fmt::format("{}: has no attempt {}", a.db, a.attempt));
    }
    std::vector<tasks::Chunk> chunks;
    for (const auto& bytes : logbook.chunks(a.attempt)) {
        chunks.push_back(tasks::decode_chunk(bytes));
    }
    const std::unique_ptr<Session> session = session_of(*recorded, a.scene);
    const bool same_coupling = a.coupling.empty() || a.coupling == recorded->coupling;
    if (!same_coupling)
        session->haptics.coupling = coupling_named(a.coupling);
    tasks::AttemptRow row = *recorded;
    if (!same_coupling)
        row.coupling = a.coupling;
    const ReplayResult result = run_replay(*session, row, chunks, logbook.events(a.attempt));
    const bool same = result.outcome.row.log_sha256 == recorded->log_sha256;
    if (a.json) {
        nlohmann::ordered_json json = outcome_json(result.outcome);
        json["recorded_sha256"] = recorded->log_sha256;
        json["same"] = same;
        json["worst_force_difference_n"] = result.worst_force_difference_n;
        json["first_difference_tick"] = result.first_difference_tick;
        fmt::print("{}\n", json.dump());
    } else {
        fmt::print("{}  {} the recorded {}\n  worst force difference {:.3f} N\n",
                   outcome_table(result.outcome), same ? "same as" : "DIFFERS from",
                   recorded->log_sha256, result.worst_force_difference_n);
    }
    if (same_coupling && !same && recorded->ended)
        exit_code = 1;
}

} // namespace

void add_replay(CLI::App& app, int& exit_code) {
    auto a = std::make_shared<ReplayArguments>();
    CLI::App* c = app.add_subcommand("replay", "A recorded attempt again, from its motion");
    c->add_option("db", a->db, "Logbook")->required()->check(CLI::ExistingFile);
    c->add_option("attempt", a->attempt, "Number of the attempt")->required();
    c->add_option("--scene", a->scene, "Directory of the scene, if it is not a shipped one");
    c->add_option("--coupling", a->coupling, "Another coupling: reports the force difference");
    c->add_flag("--json", a->json, "One JSON object instead of a table");
    c->callback([a, &exit_code] { replay(*a, exit_code); });
}

} // namespace sim
