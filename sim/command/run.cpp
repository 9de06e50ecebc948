// sim/command/run.cpp
// trocar run: one scripted attempt, lockstep or real time, with expectations and JUnit.
#include "sim/command/commands.h"
#include "sim/command/report.h"
#include "sim/command/stage.h"
#include "sim/io/files.h"
#include "sim/io/guard.h"
#include "sim/session/session.h"
#include "sim/study/auto_model.h"
#include "tasks/logbook/junit.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <fmt/format.h>
#include <optional>
#include <thread>

namespace sim {
namespace {

struct RunArguments {
    RunOptions options;
    std::string coupling = "anchored", log, junit;
    bool realtime = false, window = false, json = false, no_noise = false, no_forces = false;
    bool rate_asked = false; // --fem-hz was given
    double seconds = 0.0;
};

// Expectations of a script against the metrics; prints the failures.
std::vector<tasks::ExpectationResult> judge(const RunArguments& a, const Attempt::Outcome& out) {
    std::vector<tasks::ExpectationResult> results;
    if (!a.options.hands.ends_with(".toml"))
        return results;
    for (const tasks::Expectation& expected :
         tasks::parse_script(read_text(a.options.hands), a.options.hands).expect) {
        results.push_back(tasks::check(expected, out.metrics));
    }
    return results;
}

// Threads and deadlines; with a window the picture is drawn here, and no loop waits for it.
Attempt::Outcome perform_in_real_time(const RunArguments& a, Session& session, tasks::Logbook* log,
                                      std::int64_t id) {
    if (!a.window) {
        return run_realtime(session, log, id, a.seconds, [](Exchange&) {
            std::this_thread::sleep_for(std::chrono::milliseconds(16));
            return !asked_to_stop();
        });
    }
    leave_cores_to_the_loops();
    view::Window window({.title = "Trocar: trocar run"});
    view::Screens screens;
    screens.screen = view::Screen::demo;
    Stage stage(session, false, 1);
    session.exchange->surface_wanted = true;
    const auto outcome = run_realtime(session, log, id, a.seconds, [&](Exchange& exchange) {
        const view::UserInput input = window.draw(stage.frame(exchange), screens);
        if (input.zero_forces)
            exchange.zero_forces = true;
        return !asked_to_stop() && input.action != view::Action::quit;
    });
    fmt::print(stderr, "window: {}\n", view::cost_line(window.cost()));
    return outcome;
}

Attempt::Outcome perform(const RunArguments& a, Session& session) {
    std::optional<tasks::Logbook> logbook;
    std::int64_t id = 0;
    if (!a.log.empty()) {
        logbook.emplace(a.log);
        tasks::AttemptRow row = attempt_row(session, a.realtime);
        row.session = logbook->add_session(session_row("scripted"));
        id = logbook->begin_attempt(row);
    }
    tasks::Logbook* log = logbook ? &*logbook : nullptr;
    return a.realtime ? perform_in_real_time(a, session, log, id)
                      : run_lockstep(session, log, id, asked_to_stop);
}

// The rate too, unless it was asked for.
void choose_model(RunOptions& options, bool choose_rate) {
    const AutoModel chosen =
        auto_model(options, choose_rate, model_memory(), [](const std::string& doing) {
            fmt::print(stderr, "choosing the model: {}\n", doing);
        });
    options.model = chosen.model;
    options.model_why = chosen.why;
    options.fem_hz = chosen.fem_hz;
    fmt::print(stderr, "{}{}", chosen.why, chosen.remembered ? "(chosen before)\n" : "");
}

void run(const RunArguments& a, int& exit_code) {
    install_signal_guard();
    RunOptions options = a.options;
    if (options.model == "auto")
        choose_model(options, !a.rate_asked);
    const std::unique_ptr<Session> session = make_session(options);
    const auto start = std::chrono::steady_clock::now();
    const Attempt::Outcome outcome = perform(a, *session);
    const double wall_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double simulated_s = double(session->haptics.next_tick) * kTick_s;

    const auto results = judge(a, outcome);
    bool failed = false;
    for (const auto& result : results) {
        if (result.ok)
            continue;
        failed = true;
        fmt::print(stderr, "expectation failed: {}: {}\n", result.name, result.message);
    }
    if (!a.junit.empty())
        write_text(a.junit, tasks::junit_xml("trocar run", results));
    if (a.json) {
        nlohmann::ordered_json json = outcome_json(outcome);
        json["simulated_s"] = simulated_s;
        json["wall_s"] = wall_s;
        fmt::print("{}\n", json.dump());
    } else {
        fmt::print("{}  {:.1f} s simulated in {:.1f} s\n", outcome_table(outcome), simulated_s,
                   wall_s);
    }
    if (failed || !outcome.row.rig.faults.empty())
        exit_code = 1;
}

} // namespace

void add_run(CLI::App& app, int& exit_code) {
    auto a = std::make_shared<RunArguments>();
    CLI::App* c = app.add_subcommand("run", "One scripted attempt, without a window");
    c->add_option("exercise", a->options.exercise, "Name or file of an exercise")->required();
    c->add_option("--scene", a->options.scene,
                  "Name, directory or file of a scene; default: the one made for the exercise");
    c->add_option("--hands", a->options.hands,
                  "expert, intermediate, novice, another named skill, or FILE.toml");
    c->add_option("--coupling", a->coupling, "anchored or hold");
    c->add_option("--model", a->options.model,
                  "auto: the cheapest that is accurate enough; or rigid, linear-compliance, "
                  "corotated, quadratic; of one organ otherwise: "
                  "corotated,flap=quadratic");
    c->add_option("--fem-hz", a->options.fem_hz,
                  "FEM steps a second; divides 1000. Default: 100, with --model auto fewer where "
                  "they are enough");
    c->add_option("--seed", a->options.seed, "Of everything random in the hand");
    c->add_option("--max-seconds", a->options.max_seconds, "End incomplete after this long");
    c->add_option("--trainee", a->options.trainee, "Pseudonymous id, see trocar trainee");
    c->add_option("--log", a->log, "Logbook to write the attempt to");
    c->add_option("--junit", a->junit, "Write the script's expectations as JUnit XML");
    c->add_flag("--realtime", a->realtime, "Threads and deadlines instead of lockstep");
    c->add_flag("--window", a->window, "With --realtime: draw it, too")->needs("--realtime");
    c->add_option("--seconds", a->seconds, "With --realtime: stop after this long");
    c->add_flag("--no-noise", a->no_noise, "The hand makes no errors");
    c->add_flag("--no-forces", a->no_forces, "Forces off: positions only");
    c->add_flag("--json", a->json, "One JSON object instead of a table");
    c->callback([a, c, &exit_code] {
        a->rate_asked = c->count("--fem-hz") > 0;
        a->options.coupling = coupling_named(a->coupling);
        a->options.noise = !a->no_noise;
        a->options.forces_on = !a->no_forces;
        run(*a, exit_code);
    });
}

} // namespace sim
