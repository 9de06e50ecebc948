// tests/sim/view_window_test.cpp
// The window itself, hidden, on whatever display there is (CTest starts a virtual one).
#include "sim/view/demo_world.h"
#include "sim/view/lens.h"
#include "sim/view/window.h"

#include <cstdlib>
#include <filesystem>
#include <optional>

#include <doctest/doctest.h>
#include <imgui.h>
#include <png.h>

using namespace view;

namespace {

struct Shot {
    int w = 0, h = 0;
    std::vector<std::uint8_t> grey;
};

Shot shot_of(Window& window, const ViewFrame& frame, const Screens& screens) {
    window.draw(frame, screens);
    window.draw(frame, screens); // a page has its final place in its second picture
    const auto path = std::filesystem::temp_directory_path() / "trocar_view_window_test.png";
    window.screenshot(path.string());
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_file(&image, path.c_str()) != 0);
    image.format = PNG_FORMAT_GRAY;
    Shot shot{static_cast<int>(image.width), static_cast<int>(image.height), {}};
    shot.grey.resize(PNG_IMAGE_SIZE(image));
    REQUIRE(png_image_finish_read(&image, nullptr, shot.grey.data(), 0, nullptr) != 0);
    std::filesystem::remove(path);
    return shot;
}

/// Where two pictures differ by more than `least` of 255.
struct Box {
    int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1, count = 0;
};
Box difference(const Shot& a, const Shot& b, int least) {
    REQUIRE(a.grey.size() == b.grey.size());
    Box box;
    for (int y = 0; y < a.h; ++y)
        for (int x = 0; x < a.w; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * a.w + x;
            if (std::abs(int(a.grey[i]) - int(b.grey[i])) <= least)
                continue;
            box = {std::min(box.left, x), std::max(box.right, x), std::min(box.top, y),
                   std::max(box.bottom, y), box.count + 1};
        }
    return box;
}

WindowOptions hidden(int w, int h) {
    WindowOptions options;
    options.width_px = w;
    options.height_px = h;
    options.visible = false;
    options.wait_for_screen = false;
    options.adapt = false; // a busy machine would shrink one picture and not the other
    return options;
}

ViewFrame world_of(const DemoSurface& organ) {
    ViewFrame frame;
    frame.surfaces = {surface_view(organ, 1, Look::liver)};
    return frame;
}

} // namespace

TEST_CASE("Every screen draws a picture of its own") {
    Window window(hidden(800, 600));
    const DemoSurface organ = demo_organ(20, 30);
    const ViewFrame frame = world_of(organ);
    Screens screens;
    screens.menu.exercises = {{"Touch the points", "left, right", "In order."}};
    screens.card.title = "Touch the points";
    screens.score.title = "Score";
    std::vector<Shot> shots;
    for (const Screen screen : {Screen::menu, Screen::card, Screen::demo, Screen::run,
                                Screen::paused, Screen::score, Screen::replay}) {
        screens.screen = screen;
        shots.push_back(shot_of(window, frame, screens));
        CHECK(shots.back().w == 800);
        CHECK(shots.back().h == 600);
        for (std::size_t i = 0; i + 1 < shots.size(); ++i)
            CHECK(difference(shots[i], shots.back(), 40).count > 100);
    }
}

TEST_CASE("What a page is told, it shows") {
    Window window(hidden(800, 600));
    const auto shot = [&](Screen screen, const std::string& words, double time_s) {
        ViewFrame frame;
        frame.time_s = time_s;
        Screens screens;
        screens.screen = screen;
        screens.menu.exercises = {{words, "", ""}};
        screens.card.title = screens.score.title = words;
        return shot_of(window, frame, screens);
    };
    for (const Screen screen : {Screen::menu, Screen::card, Screen::score})
        CHECK(difference(shot(screen, "Path", 0.0), shot(screen, "Tubes", 0.0), 40).count > 30);
    for (const Screen screen : {Screen::demo, Screen::run, Screen::paused})
        CHECK(difference(shot(screen, "", 0.0), shot(screen, "", 83.0), 20).count > 30);
}

TEST_CASE("A bar of the profile is as long as its share, and its mark is another shape") {
    Window window(hidden(1280, 720));
    Screens screens;
    screens.screen = Screen::score;
    const auto shot = [&](double share, ProfileBar::Mark mark) {
        screens.score.profile = {{"Time", "1 s", "", "", mark, share}};
        return shot_of(window, {}, screens);
    };
    using Mark = ProfileBar::Mark;
    // 13 letters of 16 px; the fill is brighter than its track
    const Box longer = difference(shot(0.1, Mark::pass), shot(0.4, Mark::pass), 40);
    CHECK(std::abs((longer.right - longer.left + 1) - 0.3 * 13 * 16) <= 3.0);
    std::vector<Shot> marks;
    for (const Mark mark : {Mark::good, Mark::pass, Mark::missed, Mark::not_judged})
        marks.push_back(shot(0.0, mark));
    for (std::size_t i = 0; i < marks.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            CHECK(difference(marks[i], marks[j], 40).count > 10);
}

TEST_CASE("The arrow keys reach every moment's button, and Space shows it") {
    Window window(hidden(1280, 720));
    Screens screens;
    screens.screen = Screen::score;
    screens.score.moments = {{1.0, "One."}, {2.0, "Two."}, {3.0, "Three."}};
    screens.score.moments_can_be_shown = true;
    const auto press = [&](ImGuiKey key) {
        bool& down = ImGui::GetIO().KeysDown[ImGui::GetIO().KeyMap[key]];
        down = true;
        UserInput input = window.draw({}, screens);
        down = false;
        const UserInput after = window.draw({}, screens);
        return after.action == Action::none ? input : after;
    };
    for (int i = 0; i < 3; ++i)
        window.draw({}, screens);
    std::vector<int> shown;
    for (int up = 0; up < 3; ++up) { // from the menu button, the last one is the nearest
        press(ImGuiKey_UpArrow);
        const UserInput input = press(ImGuiKey_Space);
        CHECK(input.action == Action::show);
        shown.push_back(input.index);
    }
    CHECK(shown == std::vector<int>{2, 1, 0});
    screens.score.moments_can_be_shown = false; // nothing was recorded: no buttons
    window.draw({}, screens);
    press(ImGuiKey_UpArrow);
    CHECK(press(ImGuiKey_Space).action != Action::show);
}

TEST_CASE("A waiting target in the picture is as wide as its 3 mm project, and 12 px at least") {
    Window window(hidden(800, 600));
    ViewFrame frame; // in empty space, so that nothing else changes
    frame.camera.eye_m = {0.0, 0.0, 0.2};
    frame.camera.look_at_m = {0.0, 0.0, 0.0};
    frame.camera.field_of_view_deg = 70.0;
    Screens screens;
    screens.screen = Screen::run;
    TargetView target;
    target.number = 7;
    target.state = TargetState::waiting;
    target.normal = {0.0, 0.0, 1.0};
    target.position_m = {0.0, 0.0, 5.0}; // behind the camera: the HUD says the same
    frame.targets = {target};
    const Shot without = shot_of(window, frame, screens);
    frame.targets[0].position_m.z = 0.0;
    const Shot with = shot_of(window, frame, screens);
    const Box box = difference(without, with, 20);
    const double expected_px = 600.0 * 0.003 / (0.2 * std::tan(35.0 * std::numbers::pi / 180.0));
    CHECK(box.right - box.left + 1 >= 12);
    CHECK(std::abs(box.right - box.left + 1 - expected_px) <= 2.0); // one soft edge on either side
    CHECK(std::abs(box.bottom - box.top + 1 - expected_px) <= 2.0);
    CHECK(std::abs(0.5 * (box.left + box.right) - 399.5) <= 1.0); // in the middle
    CHECK(std::abs(0.5 * (box.top + box.bottom) - 299.5) <= 1.0);
}

TEST_CASE("A mark under tissue is not seen through it, and is seen when the tissue is away") {
    Window window(hidden(800, 600));
    const DemoSurface cover = demo_wall(8);
    ViewFrame frame;
    frame.camera.eye_m = {0.0, 0.0, 0.2};
    frame.camera.look_at_m = {0.0, 0.0, 0.0};
    Screens screens;
    screens.screen = Screen::run;
    TargetView target;
    target.position_m = {0.0, 0.0, -0.061}; // the cover is at -0.060 there, and faces the camera
    const auto seen = [&](bool covered, bool buried) {
        frame.surfaces.clear();
        if (covered)
            frame.surfaces = {surface_view(cover, 1, Look::fat)};
        target.buried = buried;
        target.position_m.z = 5.0; // behind the camera: the HUD says the same
        frame.targets = {target};
        const Shot without = shot_of(window, frame, screens);
        frame.targets[0].position_m.z = -0.061;
        return difference(without, shot_of(window, frame, screens), 12).count;
    };
    CHECK(seen(true, true) == 0);
    CHECK(seen(true, false) > 100); // on soft ground a mark is lifted in depth
    CHECK(seen(false, true) > 100);
}

TEST_CASE("The ring lies where the lens shows the exercise's share of the picture's height") {
    for (const auto& [w, h] : {std::pair{800, 600}, std::pair{1280, 720}}) {
        Window window(hidden(w, h));
        Screens screens;
        screens.screen = Screen::run;
        ViewFrame frame;
        const Shot without = shot_of(window, frame, screens);
        frame.ring_share = 0.15;
        const Box box = difference(without, shot_of(window, frame, screens), 60);
        const double radius_px = 0.5 * (box.right - box.left + 1);
        const double seen = pinhole_place(lens_of(w, h), {radius_px / (0.5 * h), 0.0}).x;
        CHECK(std::abs(seen - 2.0 * frame.ring_share) * 0.5 * h <= 2.0); // half a line's width
        CHECK(std::abs(0.5 * (box.top + box.bottom) - 0.5 * h) <= 1.0);
    }
}

TEST_CASE("The endoscope's panel says who holds it and how level it is, in its own place") {
    for (const auto& [w, h, scale] : {std::tuple{1280, 720, 1.0}, std::tuple{800, 600, 2.0}}) {
        WindowOptions options = hidden(w, h);
        options.text_scale = scale;
        Window window(options);
        Screens screens;
        screens.screen = Screen::run;
        ViewFrame frame;
        for (ToolView& tool : frame.tools)
            tool.present = true;
        const auto shot = [&](ScopeView scope) {
            scope.present = true;
            frame.scope = scope;
            return shot_of(window, frame, screens);
        };
        const Shot mount = shot({}), you = shot({.active = true}),
                   assistant = shot({.assistant = true}), faulted = shot({.faulted = true});
        const std::vector<const Shot*> all{&mount, &you, &assistant, &faulted};
        for (std::size_t i = 0; i < all.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                CHECK(difference(*all[i], *all[j], 40).count > 30);
        // left and right are told apart, and 16 degrees from 14 by more than their two degrees
        const auto turned = [&](double degrees) {
            return shot({.horizon_rad = degrees * std::numbers::pi / 180.0});
        };
        CHECK(difference(turned(10.0), turned(-10.0), 40).count > 10);
        CHECK(difference(turned(14.0), turned(16.0), 40).count >
              2 * difference(turned(12.0), turned(14.0), 40).count);
        const Box box = difference(turned(-40.0), turned(40.0), 40);
        CHECK(box.left > w / 2);
        CHECK(box.top > h / 2);
    }
}

TEST_CASE("Without a band a force bar shows its limit and nothing else") {
    Window window(hidden(800, 600));
    Screens screens;
    screens.screen = Screen::run;
    ViewFrame frame;
    frame.tools[1].present = true;
    const Shot banded = shot_of(window, frame, screens);
    frame.force.band_min_n = frame.force.band_max_n = 0.0;
    const Shot free = shot_of(window, frame, screens);
    CHECK(difference(banded, free, 20).count > 100);
    frame.force.limit_n = 2.5; // the bar is as long as 1.25 limits, so the mark stays
    CHECK(difference(free, shot_of(window, frame, screens), 20).count == 0);
}

TEST_CASE("A surface that moves moves in the picture, and only there") {
    Window window(hidden(800, 600));
    DemoSurface organ = demo_organ(40, 60);
    const ViewFrame frame = world_of(organ);
    Screens screens;
    screens.screen = Screen::run;
    const Shot rest = shot_of(window, frame, screens);
    CHECK(difference(rest, shot_of(window, frame, screens), 0).count == 0);
    for (std::size_t i = 0; i < organ.position_m.size(); ++i) // a dent at the right
        if (glm::length(organ.rest_m[i] - glm::vec3(0.05F, 0.0F, 0.03F)) < 0.02F)
            organ.position_m[i].z -= 0.02F;
    const Box box = difference(rest, shot_of(window, frame, screens), 8);
    CHECK(box.count > 50);
    CHECK(box.left > 400); // x of the dent is 30 to 70 mm, right of the middle
}

TEST_CASE("Without a display the error says what to do and how to go on without a window") {
    const char* const was = std::getenv("DISPLAY");
    const std::optional<std::string> display = was != nullptr ? std::optional(was) : std::nullopt;
    unsetenv("DISPLAY");
    std::string words;
    try {
        Window window(hidden(64, 64));
    } catch (const WindowError& problem) {
        words = problem.what();
    }
    if (display)
        setenv("DISPLAY", display->c_str(), 1);
    CHECK(words.find("DISPLAY") != std::string::npos);
    CHECK(words.find("trocar run") != std::string::npos);
}
