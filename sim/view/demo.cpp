// sim/view/demo.cpp
// view_demo [FOLDER]: every page at 1280 x 720 and 800 x 600, letters of 100 and 200 %, as PNG into
// the folder; then what a picture costs.
#include "sim/view/demo_world.h"
#include "sim/view/window.h"

#include <fmt/format.h>

namespace {

using namespace view;

struct World {
    DemoSurface organ = demo_organ(52, 76), wall = demo_wall(40);
    ViewFrame frame;

    World() {
        frame.surfaces = {surface_view(organ, 1, Look::liver), surface_view(wall, 2, Look::wall)};
        const std::array<glm::dvec2, 9> at{{{0.044, 0.022},
                                            {-0.048, 0.006},
                                            {0.014, 0.026},
                                            {-0.006, 0.002},
                                            {-0.026, 0.028},
                                            {0.058, 0.010},
                                            {0.014, -0.012},
                                            {-0.058, -0.02},
                                            {-0.034, -0.014}}};
        const std::array<int, 9> role{1, 0, 1, 2, 0, 1, 2, 0, 2};
        for (std::size_t i = 0; i < at.size(); ++i) {
            TargetView target;
            target.number = static_cast<int>(i) + 1;
            target.role = static_cast<Role>(role[i]);
            target.position_m = demo_front_m(at[i].x, at[i].y);
            target.normal =
                glm::normalize(target.position_m / glm::dvec3(0.0081, 0.0036, 0.0325 * 0.0325));
            target.state = i < 3   ? TargetState::done
                           : i > 3 ? TargetState::waiting
                                   : TargetState::next;
            frame.targets.push_back(target);
        }
        frame.targets[3].hold_share = 0.6;
        const glm::dvec3 tip_at[3]{
            {-0.05, -0.02, 0.06}, {0.03, -0.01, 0.040}, {-0.002, 0.004, 0.034}};
        frame.tools[0] = demo_tool(Role::left, {-0.10, -0.07, 0.16}, tip_at[0]);
        frame.tools[1] = demo_tool(Role::right, {0.10, -0.07, 0.16}, tip_at[1]);
        frame.tools[2] = demo_tool(Role::assist, {0.13, 0.04, 0.15}, tip_at[2]);
        frame.tools[1].jaw = 1.0;
        frame.tools[0].active = true;
        frame.tools[1].force_n = {0.0, 0.0, 2.13};
        frame.tools[2].force_n = {0.1, 0.2, 0.42};
        frame.tools[2].touching = frame.tools[2].assistant = true;
        frame.scope = {.present = true, .assistant = true, .horizon_rad = -0.35};
        frame.time_s = 65.4;
        frame.time_limit_s = 180.0;
        frame.errors = 2;
        frame.recorder = Recorder::recording;
        frame.messages = {"Left and right: these drivers have never run on hardware."};
    }
};

Screens pages() {
    Screens s;
    s.menu.exercises = {
        {"Touch the points", "left, right, assist",
         "Nine targets in order, each gently and with its own tool."},
        {"Follow the path", "one tool", "Along a curve on the liver, without leaving it."},
        {"Find the tubes", "lift, point, look", "Hidden under a flap: lift, look and point."}};
    s.menu.trainees = {"A. Novice", "B. Resident"};
    s.menu.trainee = 1;
    s.menu.devices = "No haptic device: mouse and keys, forces are not felt.";
    s.card = {
        "Touch the points",
        "Touch the numbered points in order. Colour and letter name the tool. Press gently and "
        "hold until the point is marked, then go on to the next. Keep the tips in the picture, "
        "touch nothing else, and do not press hard.",
        {},
        {"Force 0.1 to 1.0 N, held for 0.3 s", "An error above 2.0 N", "Three minutes"},
        true};
    s.card.roles = {Role::left, Role::right, Role::assist, Role::scope};
    s.score.title = "Touch the points: B. Resident";
    s.score.completed = true;
    s.score.valid = true;
    s.score.metrics = {{"Time", 82.4, "s", true, true, true, 1},
                       {"Path length", 1.92, "m"},
                       {"Economy", 0.61, "", false},
                       {"Peak force", 2.13, "N", true, true, false},
                       {"Bimanual correlation", 0.21, "", true, false}};
    using Mark = ProfileBar::Mark;
    s.score.profile = {
        {"Time", "82.4 s", "pass: at most 60 s", "missed", Mark::missed, 0.2},
        {"Economy of path", "0.61", "pass: at least 0.50", "passed", Mark::pass, 0.7},
        {"Errors", "2", "pass: at most 3", "expert level", Mark::good, 0.95},
        {"Peak force", "not felt", "pass: at most 1.2 N", "not judged", Mark::not_judged, 0.0}};
    s.score.moments = {{31.2, "The right tool pressed with 2.1 N. The limit is 2.0 N."},
                       {48.0, "The left tool touched the tissue away from every point."},
                       {70.5, "No tool moved for 6.2 s."}};
    s.score.moments_can_be_shown = true;
    s.score.errors = {{31.2, "right: 2.13 N at target 3"},
                      {48.0, "left: touched away from any target"}};
    s.score.saved = "Kept in the logbook as attempt 17.";
    return s;
}

/// Every page at both sizes of the window and of the letters.
void take_pictures(const std::string& folder, World& world, Screens& screens, int percent) {
    WindowOptions options;
    options.wait_for_screen = false;
    options.text_scale = 0.01 * percent;
    Window window(options);
    const std::pair<Screen, const char*> all[] = {
        {Screen::menu, "menu"},    {Screen::card, "card"},     {Screen::demo, "demo"},
        {Screen::run, "run"},      {Screen::paused, "paused"}, {Screen::score, "score"},
        {Screen::replay, "replay"}};
    for (const auto& [w, h] : {std::pair{1280, 720}, std::pair{800, 600}}) {
        window.resize(w, h);
        for (const auto& [screen, name] : all) {
            screens.screen = screen;
            world.frame.forces_on = screen != Screen::demo;
            for (int i = 0; i < 4; ++i)
                window.draw(world.frame, screens);
            window.screenshot(fmt::format("{}/{}_{}_{}.png", folder, name, h, percent));
        }
    }
}

/// At full resolution, each size in a window of its own so that its times are its own.
void measure(World& world, Screens& screens) {
    screens.screen = Screen::run;
    for (const auto& [w, h] : {std::pair{1280, 720}, std::pair{800, 600}}) {
        WindowOptions options{.width_px = w, .height_px = h};
        options.wait_for_screen = options.adapt = false;
        Window window(options);
        for (int i = 0; i < 200; ++i) {
            world.frame.time_s += 1.0 / 60.0;
            window.draw(world.frame, screens);
        }
        fmt::print("{} x {}: {}\n", w, h, cost_line(window.cost()));
    }
}

} // namespace

int main(int argc, char** argv) try {
    World world;
    Screens screens = pages();
    if (argc > 1)
        for (const int percent : {100, 200})
            take_pictures(argv[1], world, screens, percent);
    measure(world, screens);
    return 0;
} catch (const std::exception& problem) {
    fmt::print(stderr, "view_demo: {}\n", problem.what());
    return 1;
}
