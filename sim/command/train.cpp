// sim/command/train.cpp
// trocar train: the window. Menu, instruction card, the expert's demonstration, the attempt, the
// score. The loops run on their own threads; this one draws and never makes them wait.
#include "sim/command/commands.h"
#include "sim/command/exercise_words.h"
#include "sim/command/score_model.h"
#include "sim/command/stage.h"
#include "sim/io/files.h"
#include "sim/io/guard.h"
#include "sim/session/moment_replay.h"
#include "sim/session/scene_place.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>

namespace sim {
namespace {

struct TrainArguments {
    std::string exercise, scene, trainee, log, shots;
    double shot_seconds = 4.0;
    bool mute = false;
    int font_percent = 100, width = 1280, height = 720;
};

class Trainer {
  public:
    explicit Trainer(const TrainArguments& a)
        : a_(a), window_({.width_px = a.width,
                          .height_px = a.height,
                          .text_scale = 0.01 * a.font_percent,
                          .sound = a.shots.empty(),
                          .mute = a.mute}),
          logbook_(a.log.empty() ? (user_data_dir() / "station.db").string() : a.log),
          log_path_(a.log.empty() ? (user_data_dir() / "station.db").string() : a.log) {
        offered_ = a.scene.empty() ? offered_exercises() : of_scene(a.scene);
        for (const auto& [name, scene] : offered_) {
            const auto path = find_exercise(find_scene(scene), name);
            exercises_.push_back(tasks::parse_exercise(read_text(path), path.string()));
            screens_.menu.exercises.push_back(menu_entry(exercises_.back()));
        }
        for (const auto& t : logbook_.trainees()) {
            trainee_ids_.push_back(t.id);
            screens_.menu.trainees.push_back(t.name);
        }
        screens_.menu.devices =
            "Mouse and keyboard. Haptic drivers: none was ever run on hardware.";
        if (!a.exercise.empty())
            show_card(index_of(a.exercise));
    }

    void run() {
        while (!quit_ && !asked_to_stop()) {
            const view::UserInput input = window_.draw(idle_, screens_);
            using view::Action;
            if (input.action == Action::quit)
                quit_ = true;
            else if (input.action == Action::choose_trainee)
                screens_.menu.trainee = input.index;
            else if (input.action == Action::select)
                show_card(input.index);
            else if (input.action == Action::back || input.zero_forces)
                screens_.screen = view::Screen::menu;
            else if (input.action == Action::demo)
                perform(true);
            else if (input.action == Action::start)
                perform(false);
            else if (input.action == Action::show)
                show_moment(input.index);
        }
    }

    /// Pictures of every screen, for the README and for tests: no person needed.
    void take_pictures() {
        screens_.screen = view::Screen::menu;
        picture("menu");
        show_card(chosen_);
        picture("card");
        perform(true);
        picture("score");
        if (!outcome_.moments.empty())
            show_moment(0);
    }

  private:
    static std::vector<OfferedExercise> of_scene(const std::string& scene) {
        const ScenePlace place = find_scene(scene);
        std::vector<OfferedExercise> out;
        for (const std::string& name : exercise_names(place))
            out.push_back({name, scene});
        if (out.empty()) {
            throw std::runtime_error(
                fmt::format("{}: has no exercises/*.toml", place.folder.string()));
        }
        return out;
    }

    int index_of(const std::string& name) const {
        const auto found = std::find_if(offered_.begin(), offered_.end(),
                                        [&](const auto& offer) { return offer.name == name; });
        if (found == offered_.end())
            throw std::invalid_argument(fmt::format("exercise \"{}\" is unknown", name));
        return static_cast<int>(found - offered_.begin());
    }

    void picture(const std::string& name) {
        for (int i = 0; i < 3; ++i)
            window_.draw(idle_, screens_);
        window_.screenshot((std::filesystem::path(a_.shots) / (name + ".png")).string());
    }

    void show_card(int index) {
        chosen_ = std::clamp(index, 0, static_cast<int>(exercises_.size()) - 1);
        screens_.screen = view::Screen::card;
        screens_.card = card_model(exercises_[chosen_]);
    }

    // One attempt, by the person or as the expert's demonstration, with its own threads.
    void perform(bool demo) {
        RunOptions options;
        options.exercise = offered_[chosen_].name;
        options.scene = offered_[chosen_].scene;
        options.hands = demo ? "expert" : "person";
        options.forces_on = demo; // a mouse does not feel
        if (screens_.menu.trainee >= 0)
            options.trainee = trainee_ids_[screens_.menu.trainee];
        const std::unique_ptr<Session> session = make_session(options, demo);
        if (!demo)
            give_to_person(*session);
        session->exchange->surface_wanted = true;
        session->keep_recording = true;
        Stage stage(*session, !demo, next_surface_id_);
        next_surface_id_ += static_cast<int>(session->tissue.bodies.size());

        std::int64_t id = 0;
        if (!demo) {
            tasks::AttemptRow row = attempt_row(*session, true);
            row.session = logbook_.add_session(session_row("mouse"));
            id = logbook_.begin_attempt(row);
            session->recorded = true;
        }
        screens_.screen = demo ? view::Screen::demo : view::Screen::run;
        outcome_ =
            run_realtime(*session, demo ? nullptr : &logbook_, id, 0.0,
                         [&](Exchange& exchange) { return one_frame(stage, exchange, demo); });
        const std::string& title = exercises_[chosen_].title;
        screens_.score = score_model(outcome_, demo ? title + " (demonstration)" : title,
                                     demo ? "" : fmt::format("attempt {} in {}", id, log_path_));
        screens_.screen = view::Screen::score;
    }

    // The moment again, as it was recorded; then the score page, as before. A slow machine shows
    // it slower instead of leaving pictures out.
    void show_moment(int index) {
        if (index < 0 || index >= static_cast<int>(outcome_.moments.size()))
            return;
        const tasks::Moment& moment = outcome_.moments[index];
        MomentReplay replay(outcome_.row, outcome_.chunks, moment.tick, offered_[chosen_].scene);
        Stage stage(replay.session(), false, next_surface_id_);
        next_surface_id_ += static_cast<int>(replay.session().tissue.bodies.size());
        stage.say(moment.text);
        screens_.screen = view::Screen::replay;
        constexpr int kSlowest_ticks = 40; // a picture
        double due_ticks = 0.0;
        while (!replay.over() && !asked_to_stop()) {
            const view::UserInput input =
                window_.draw(stage.frame(*replay.session().exchange), screens_);
            quit_ = quit_ || input.action == view::Action::quit;
            if (quit_ || input.action == view::Action::abandon)
                break;
            due_ticks += std::clamp(window_.cost().frame_ms, 1.0, double(kSlowest_ticks));
            const int ticks = static_cast<int>(due_ticks);
            due_ticks -= ticks;
            replay.advance(ticks);
            shoot_replay(stage.frame(*replay.session().exchange).time_s, moment);
        }
        screens_.screen = view::Screen::score;
    }

    // With --screenshots: one picture of the moment itself.
    void shoot_replay(double now_s, const tasks::Moment& moment) {
        if (a_.shots.empty() || replay_shot_ || now_s < double(moment.tick) * kTick_s)
            return;
        replay_shot_ = true;
        window_.screenshot((std::filesystem::path(a_.shots) / "replay.png").string());
    }

    bool one_frame(Stage& stage, Exchange& exchange, bool demo) {
        const view::UserInput input = window_.draw(stage.frame(exchange), screens_);
        if (input.zero_forces)
            exchange.zero_forces = true;
        using view::Action;
        if (input.action == Action::forces_on)
            exchange.zero_forces = false;
        if (input.action == Action::pause || input.action == Action::resume) {
            const bool pause = input.action == Action::pause;
            exchange.paused = pause;
            exchange.marks.push(
                {.kind = pause ? tasks::EventKind::paused : tasks::EventKind::resumed});
            screens_.screen = pause  ? view::Screen::paused
                              : demo ? view::Screen::demo
                                     : view::Screen::run;
        }
        if (!a_.shots.empty())
            return shoot(exchange);
        const bool leave =
            input.action == Action::abandon || input.action == Action::quit || asked_to_stop();
        if (leave) {
            exchange.marks.push({.kind = tasks::EventKind::abandoned});
            quit_ = input.action == Action::quit;
            return false;
        }
        if (screens_.screen != view::Screen::paused)
            stage.steer(input, 1e-3 * window_.cost().frame_ms, exchange);
        return true;
    }

    // With --screenshots: three moments of the demonstration, then on.
    bool shoot(Exchange& exchange) {
        const double now_s = double(exchange.tools_seen.latest().tick) * kTick_s;
        if (now_s < a_.shot_seconds * (shots_ + 1))
            return true;
        ++shots_;
        window_.screenshot(
            (std::filesystem::path(a_.shots) / fmt::format("exercise-{}.png", shots_)).string());
        return shots_ < 3;
    }

    TrainArguments a_;
    view::Window window_;
    tasks::Logbook logbook_;
    std::string log_path_;
    view::Screens screens_;
    view::ViewFrame idle_;
    std::vector<OfferedExercise> offered_;
    std::vector<std::string> trainee_ids_;
    std::vector<tasks::Exercise> exercises_;
    int chosen_ = 0, next_surface_id_ = 1, shots_ = 0;
    Attempt::Outcome outcome_; // of the score page
    bool quit_ = false, replay_shot_ = false;
};

} // namespace

void add_train(CLI::App& app, int&) {
    auto a = std::make_shared<TrainArguments>();
    CLI::App* c = app.add_subcommand("train", "The window: pick an exercise, train, get a score");
    c->add_option("exercise", a->exercise, "Go straight to this exercise's card");
    c->add_option("--scene", a->scene,
                  "Name, directory or file of a scene; default: the exercises' own");
    c->add_option("--log", a->log, "Logbook; default: the user's data directory");
    c->add_option("--font-percent", a->font_percent, "Size of all text; Ctrl + and Ctrl - too")
        ->check(CLI::Range(100, 200));
    c->add_flag("--mute", a->mute, "No sound until M is pressed");
    c->add_option("--width", a->width, "Of the window, pixels")->check(CLI::Range(800, 7680));
    c->add_option("--height", a->height, "Of the window, pixels")->check(CLI::Range(600, 4320));
    c->add_option("--screenshots", a->shots, "Folder: take pictures of every screen and leave");
    c->add_option("--shot-seconds", a->shot_seconds, "Between the exercise's pictures");
    c->callback([a] {
        install_signal_guard();
        leave_cores_to_the_loops();
        if (!a->shots.empty())
            std::filesystem::create_directories(a->shots);
        Trainer trainer(*a);
        if (a->shots.empty())
            trainer.run();
        else
            trainer.take_pictures();
    });
}

} // namespace sim
