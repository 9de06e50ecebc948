// sim/command/rescore.cpp
// trocar rescore: every attempt of a logbook under today's metric definitions, old beside new.
// Folds the recorded ticks; simulates nothing.
#include "sim/command/commands.h"
#include "sim/command/report.h"
#include "sim/session/session.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <map>

namespace sim {
namespace {

struct Scores {
    std::map<std::string, double> recorded, now;
    bool agree = true;
    Attempt::Outcome outcome; // of today's definitions
};

Scores rescore_attempt(tasks::Logbook& logbook, const tasks::AttemptRow& row) {
    const Scene scene = parse_scene(row.scene_text, "scene in the logbook");
    const tasks::Exercise exercise =
        tasks::parse_exercise(row.exercise_text, "exercise in the logbook");
    Attempt attempt(scene, exercise, std::vector<tasks::Target>(tasks::places_of(exercise)), row,
                    nullptr);
    for (const auto& bytes : logbook.chunks(row.id)) {
        const tasks::Chunk chunk = tasks::decode_chunk(bytes);
        for (const tasks::StepTrace& step : chunk.steps)
            attempt.add(step);
        for (const tasks::TickTrace& tick : chunk.ticks)
            attempt.add(tick);
    }
    Scores scores;
    for (const tasks::Metric& m : logbook.metrics(row.id))
        scores.recorded[m.id] = m.value;
    scores.outcome = attempt.finish(row.rig);
    for (const tasks::Metric& m : scores.outcome.metrics)
        scores.now[m.id] = m.value;
    scores.agree = scores.recorded == scores.now;
    return scores;
}

void rescore(const std::string& db, bool json) {
    tasks::Logbook logbook(db);
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const tasks::AttemptRow& row : logbook.attempts()) {
        const Scores scores = rescore_attempt(logbook, row);
        if (json) {
            all.push_back({{"attempt", row.id},
                           {"exercise", row.exercise},
                           {"agree", scores.agree},
                           {"recorded", scores.recorded},
                           {"now", scores.now},
                           {"profile", profile_json(scores.outcome)},
                           {"moments", moments_json(scores.outcome)}});
            continue;
        }
        fmt::print("attempt {}  {}  {}\n", row.id, row.exercise,
                   !row.ended     ? "never ended"
                   : scores.agree ? "old and new agree exactly"
                                  : "old and new DIFFER");
        for (const auto& [id, value] : scores.now) {
            const auto old = scores.recorded.find(id);
            fmt::print("  {:<28} {:>14} {:>14.6g}\n", id,
                       old == scores.recorded.end() ? "-" : fmt::format("{:.6g}", old->second),
                       value);
        }
    }
    if (json)
        fmt::print("{}\n", nlohmann::ordered_json{{"attempts", all}}.dump());
}

} // namespace

void add_rescore(CLI::App& app, int&) {
    auto db = std::make_shared<std::string>();
    auto json = std::make_shared<bool>(false);
    CLI::App* c = app.add_subcommand("rescore", "All attempts under today's definitions");
    c->add_option("db", *db, "Logbook")->required()->check(CLI::ExistingFile);
    c->add_flag("--json", *json, "One JSON object instead of a table");
    c->callback([db, json] { rescore(*db, *json); });
}

} // namespace sim
