#include "sim/session/session.h"

#include "sim/check/exercise_check.h"
#include "sim/io/files.h"

#include <cmath>
#include <ctime>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <openssl/opensslv.h>
#include <stdexcept>
#include <sys/utsname.h>

namespace sim {
namespace {

int period_of(int fem_hz) {
    const int period = fem_hz > 0 ? static_cast<int>(std::lround(1000.0 / fem_hz)) : 0;
    if (period < 2 || period > 100 || 1000 % period != 0) {
        throw std::invalid_argument(fmt::format(
            "--fem-hz {}: must divide 1000 ticks a second: 10, 20, 25, 40, 50, 100, 125, 200, 250, "
            "500",
            fem_hz));
    }
    return period;
}

std::vector<std::string> organ_names(const Scene& scene) {
    std::vector<std::string> names;
    for (const SceneOrgan& organ : scene.organ)
        names.push_back(organ.name);
    return names;
}

std::vector<TargetWish> wishes(const tasks::Exercise& exercise) {
    std::vector<TargetWish> out;
    for (const tasks::ExerciseTarget& target : exercise.target)
        out.push_back({target.at_m, target.organ});
    if (exercise.lift)
        out.push_back({exercise.lift->at_m, exercise.lift->organ});
    return out;
}

std::vector<tasks::Target> rest_targets(const TissueRig& rig) {
    std::vector<tasks::Target> out;
    for (const EmbeddedTarget& target : rig.targets) {
        const Body& body = rig.bodies[target.body];
        out.push_back({place_on(body, target.at), normal_on(body, target.at)});
    }
    return out;
}

// An exercise that cannot be done here is bad input, and all of what is wrong is said at once.
void refuse_impossible(const Session& session, const std::string& exercise_file) {
    const ExerciseCheck check =
        check_exercise(session.scene, session.tissue.bodies, make_solids(session.scene),
                       session.exercise_text, exercise_file);
    if (check.finding.empty())
        return;
    std::string message =
        fmt::format("this exercise cannot be done in scene \"{}\"", session.scene.scene.id);
    for (const Finding& finding : check.finding)
        message += "\n" + text_of(finding);
    throw std::invalid_argument(message);
}

// Everything that follows from options, scene and exercise. `check`: asks first if it can be done.
std::unique_ptr<Session> build(const RunOptions& options, LoadedScene scene,
                               const std::string& exercise_text, const std::string& exercise_file,
                               bool check) {
    auto session = std::make_unique<Session>();
    session->options = options;
    const int period = period_of(options.fem_hz);
    session->exercise_text = exercise_text;
    session->exercise = tasks::parse_exercise(exercise_text, exercise_file);
    session->scene = std::move(scene);
    TissueConfig config;
    config.step_s = period * kTick_s;
    config.organs_meet = session->scene.scene.organs_meet;
    config.tier = parse_model(options.model, organ_names(session->scene.scene));
    session->tissue = make_tissue(session->scene, {}, config);
    if (check)
        refuse_impossible(*session, exercise_file);
    embed_targets(session->scene, wishes(session->exercise), session->tissue);
    if (session->exercise.kind == tasks::ExerciseKind::find_tubes)
        session->tissue.sight = make_sight(session->tissue.bodies);
    session->tissue.mark_radius_m = session->exercise.mark_radius_m;
    session->rest_targets = rest_targets(session->tissue);
    session->haptics = make_haptics(session->scene.scene);
    session->haptics.coupling = options.coupling;
    session->haptics.coupling_config.period_ticks = period;
    session->haptics.forces_on = options.forces_on;
    const double limit =
        options.max_seconds > 0.0 ? options.max_seconds : session->exercise.time_limit_s;
    session->max_ticks = static_cast<std::int64_t>(limit / kTick_s);
    place_targets(session->tissue, session->haptics.seen.target_um);
    session->rest_target_um = session->haptics.seen.target_um;
    session->haptics.seen.targets = static_cast<int>(session->tissue.targets.size());
    return session;
}

void give_skilled_hand(Session& session, const tasks::HandSkill& skill) {
    const auto start = start_tips(session.scene.scene);
    auto& hand = session.crew.hand;
    if (session.exercise.kind == tasks::ExerciseKind::find_tubes)
        hand.emplace<tasks::FindHand>(skill, session.exercise, session.options.seed, start);
    else
        hand.emplace<tasks::Hand>(skill, session.exercise, session.options.seed, start);
}

// The endoscope in somebody's hands, if the exercise wants that.
void give_camera(Session& session, const tasks::HandSkill& skill) {
    if (session.exercise.scope != tasks::ScopeHold::assistant || !session.haptics.scope.fitted)
        return;
    give_scope(session.crew, session.haptics);
    const Scene& scene = session.scene.scene;
    session.crew.camera.emplace(skill, session.exercise, session.options.seed,
                                start_goal(scene.view, scene.look_at_m));
}

void give_hands(Session& session) {
    const auto start = start_tips(session.scene.scene);
    const std::string& hands = session.options.hands;
    if (hands.ends_with(".toml")) {
        tasks::Script script = tasks::parse_script(read_text(hands), hands);
        const bool looks = tasks::holds_scope(script);
        session.crew.hand.emplace<tasks::ScriptHand>(std::move(script), session.exercise, start);
        if (looks)
            give_scope(session.crew, session.haptics);
        else
            give_camera(session, tasks::without_errors(tasks::skill_named("expert")));
        return;
    }
    tasks::HandSkill skill = tasks::skill_named(hands);
    if (!session.options.noise)
        skill = tasks::without_errors(skill);
    give_skilled_hand(session, skill);
    give_camera(session, skill);
}

} // namespace

std::unique_ptr<Session> make_session(const RunOptions& options, bool with_hands) {
    LoadedScene scene =
        load_scene(options.scene.empty() ? scene_for(options.exercise) : options.scene);
    const auto path = find_exercise(scene.place, options.exercise);
    auto session = build(options, std::move(scene), read_text(path), path.string(), true);
    if (with_hands) {
        session->crew = make_crew(session->scene.scene, session->haptics);
        give_hands(*session);
    }
    return session;
}

std::unique_ptr<Session> session_of(const tasks::AttemptRow& recorded, const std::string& place) {
    RunOptions options;
    options.coupling = coupling_named(recorded.coupling);
    options.model = recorded.model;
    options.fem_hz = recorded.fem_hz;
    options.seed = recorded.seed;
    options.hands = recorded.hands;
    options.trainee = recorded.trainee;
    options.forces_on = recorded.forces_on;
    Scene known = parse_scene(recorded.scene_text, "scene in the logbook");
    ScenePlace from = place.empty() ? place_of_known(known.id) : find_scene(place);
    LoadedScene scene = load_organs(std::move(known), std::move(from));
    if (scene.hash != recorded.scene_hash) {
        throw std::runtime_error("the scene's organs are not the ones that this attempt was made "
                                 "with: name the scene's directory with --scene, bake its organs "
                                 "from the same recipes, or use rescore");
    }
    return build(options, std::move(scene), recorded.exercise_text, "exercise in the logbook",
                 false);
}

tasks::SessionRow session_row(const std::string& input_class) {
    utsname name{};
    uname(&name);
    return {.build = TROCAR_VERSION,
            .machine = fmt::format("{} {}", name.sysname, name.machine),
            .blas = tissue::blas_name(),
            .dispatch = "scalar",
            .input_class = input_class,
            .device_serials_hash = {}};
}

tasks::AttemptRow attempt_row(const Session& session, bool realtime) {
    tasks::AttemptRow row;
    row.trainee = session.options.trainee;
    row.started_utc = fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr)));
    row.exercise = session.exercise.id;
    row.exercise_text = session.exercise_text;
    row.scene_text = session.scene.scene.text;
    row.scene_hash = session.scene.hash;
    row.model = session.options.model;
    row.model_why = session.options.model_why;
    row.coupling = session.options.coupling == Coupling::hold ? "hold" : "anchored";
    row.hands = session.options.hands;
    row.seed = session.options.seed;
    row.fem_hz = session.options.fem_hz;
    row.realtime = realtime;
    row.forces_on = session.options.forces_on;
    for (const Instrument& instrument : session.haptics.instrument) {
        const auto& c = instrument.sample.counts;
        row.start_counts.push_back({c[0], c[1], c[2]});
    }
    return row;
}

tasks::HandSight sight_of(const Session& session, const tasks::TickTrace& trace, int next_target,
                          std::uint32_t found, bool done) {
    return {.tick = trace.tick,
            .now =
                observe_trace(session.haptics, trace, session.haptics.seen, session.rest_targets),
            .next_target = next_target,
            .found = found,
            .done = done,
            .held = session.crew.mouse[0] ? session.crew.pointer.held : std::array<bool, kTools>{},
            .scope_held = session.crew.pointer.scope_held};
}

ProgressNow progress_now(const Attempt& attempt, const tasks::Exercise& exercise) {
    const tasks::Progress& p = attempt.progress();
    ProgressNow now;
    now.tick = attempt.seen().tick;
    now.next_target = p.next;
    now.found = tasks::found_tubes(p);
    now.hold_share = tasks::share_at_next(p, exercise);
    now.complete = p.complete;
    for (const tasks::Event& event : p.events)
        now.errors += tasks::is_error(event.kind);
    return now;
}

tasks::StepTrace run_step(Session& session, const ToolsNow& tools, TissueAnswer& answer) {
    const auto start = std::chrono::steady_clock::now();
    if (session.poses)
        session.poses->push_back(tools);
    StepOutcome outcome = tissue_step(session.tissue, tools, answer);
    const double us =
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
    session.step_time.add(us);
    session.worst_linear_residual =
        std::max(session.worst_linear_residual, outcome.linear_residual);
    session.warped_steps += outcome.warped;
    session.inverted_steps += outcome.inverted > 0;
    outcome.trace.duration_us = static_cast<std::int32_t>(us);
    return outcome.trace;
}

void fill_report(Session& session, std::int64_t ticks, bool realtime) {
    tasks::RigReport& r = session.report;
    r.tick_us_p50 = session.tick_time.at_share(0.5);
    r.tick_us_p99 = session.tick_time.at_share(0.99);
    r.tick_us_p9999 = session.tick_time.at_share(0.9999);
    r.tick_us_max = session.tick_time.max_us();
    r.fem_ms_p50 = 1e-3 * session.step_time.at_share(0.5);
    r.fem_ms_p99 = 1e-3 * session.step_time.at_share(0.99);
    r.fem_ms_max = 1e-3 * session.step_time.max_us();
    r.dropped = static_cast<std::int64_t>(session.exchange->dropped.load());
    r.energy_min_j = 0.0;
    for (const Instrument& instrument : session.haptics.instrument) {
        r.energy_min_j += instrument.energy.min_j;
        if (instrument.limit_state.not_finite > 0)
            r.faults.push_back("force was not a number");
    }
    if (session.worst_linear_residual > kMostLinearResidual) {
        r.faults.push_back(fmt::format("linear residual {:.1e} > {:.0e}",
                                       session.worst_linear_residual, kMostLinearResidual));
    }
    if (session.haptics.not_finite > 0)
        r.faults.push_back("contact force was not a number");
    if (r.dropped > 0)
        r.faults.push_back(fmt::format("{} records dropped", r.dropped));
    // one tick in a thousand late: a hand notices, and the score is not the trainee's alone
    if (realtime && r.missed * 1000 > ticks) {
        r.faults.push_back(fmt::format("{} of {} ticks missed their deadline", r.missed, ticks));
    }
}

} // namespace sim
