// tests/sim/view_input_test.cpp
// The key table of sim/view/input.h, without a display.
#include "sim/view/input.h"

#include <doctest/doctest.h>

using namespace view;

namespace {

constexpr Screen kScreens[] = {Screen::menu,   Screen::card,  Screen::demo,  Screen::run,
                               Screen::paused, Screen::score, Screen::replay};

KeyFrame down(std::initializer_list<Key> keys) {
    KeyFrame frame;
    for (const Key key : keys)
        frame.press(key);
    return frame;
}

Action action(Key key, Screen screen) {
    return map_keys(down({key}), screen).action;
}

} // namespace

TEST_CASE("Esc zeroes all forces on every screen, whatever else is held") {
    for (const Screen screen : kScreens)
        for (int other = 0; other < static_cast<int>(Key::count); ++other) {
            CHECK(map_keys(down({Key::escape, static_cast<Key>(other)}), screen).zero_forces);
            if (static_cast<Key>(other) != Key::escape)
                CHECK_FALSE(map_keys(down({static_cast<Key>(other)}), screen).zero_forces);
        }
}

TEST_CASE("Esc does not end a running attempt, and never brings forces back") {
    CHECK(action(Key::escape, Screen::run) == Action::none);
    CHECK(action(Key::escape, Screen::paused) == Action::none);
    for (const Screen screen : kScreens)
        CHECK(map_keys(down({Key::escape, Key::f}), screen).action != Action::forces_on);
}

TEST_CASE("Every screen is left by a key alone") {
    CHECK(action(Key::enter, Screen::card) == Action::start);
    CHECK(action(Key::d, Screen::card) == Action::demo);
    CHECK(action(Key::escape, Screen::card) == Action::back);
    CHECK(action(Key::backspace, Screen::demo) == Action::abandon);
    CHECK(action(Key::p, Screen::run) == Action::pause);
    CHECK(action(Key::p, Screen::paused) == Action::resume);
    CHECK(action(Key::enter, Screen::paused) == Action::resume);
    CHECK(action(Key::backspace, Screen::paused) == Action::abandon);
    CHECK(action(Key::enter, Screen::score) == Action::back);
    CHECK(action(Key::backspace, Screen::replay) == Action::abandon);
    CHECK(action(Key::escape, Screen::replay) == Action::abandon);
    for (const Screen screen : kScreens)
        CHECK(map_keys(down({Key::control, Key::q}), screen).action == Action::quit);
}

TEST_CASE("An attempt is not abandoned from the run screen by a slip of one key") {
    for (int key = 0; key < static_cast<int>(Key::count); ++key) {
        CHECK(action(static_cast<Key>(key), Screen::run) != Action::abandon);
        CHECK(action(static_cast<Key>(key), Screen::run) != Action::quit);
    }
}

TEST_CASE("A button with the keyboard keeps Enter to itself") {
    CHECK(map_keys(down({Key::enter}), Screen::card, true).action == Action::none);
    CHECK(map_keys(down({Key::enter}), Screen::score, true).action == Action::none);
}

TEST_CASE("Held keys move the tool along the picture's axes, opposite keys cancel") {
    const auto move = [](std::initializer_list<Key> keys) {
        return map_keys(down(keys), Screen::run).move;
    };
    CHECK(move({Key::d}) == glm::dvec3(1, 0, 0));
    CHECK(move({Key::a}) == glm::dvec3(-1, 0, 0));
    CHECK(move({Key::w}) == glm::dvec3(0, 1, 0));
    CHECK(move({Key::s}) == glm::dvec3(0, -1, 0));
    CHECK(move({Key::e}) == glm::dvec3(0, 0, 1));
    CHECK(move({Key::q}) == glm::dvec3(0, 0, -1));
    CHECK(move({Key::a, Key::d, Key::w, Key::s, Key::q, Key::e}) == glm::dvec3(0));
    CHECK(map_keys(down({Key::t}), Screen::run).roll == 1.0);
    CHECK(map_keys(down({Key::r}), Screen::run).roll == -1.0);
    CHECK(map_keys(down({Key::x}), Screen::run).turn_optic == 1.0);
    CHECK(map_keys(down({Key::z}), Screen::run).turn_optic == -1.0);
    CHECK(map_keys(down({Key::z, Key::x}), Screen::run).turn_optic == 0.0);
    CHECK(map_keys(down({Key::space}), Screen::run).jaw_closed);
    CHECK(map_keys(down({Key::shift}), Screen::run).fine);
}

TEST_CASE("Tools move and change on the run screen only") {
    const KeyFrame keys = down({Key::w, Key::tab, Key::space, Key::t, Key::x});
    for (const Screen screen : kScreens) {
        const UserInput input = map_keys(keys, screen);
        const bool runs = screen == Screen::run;
        CHECK(input.switch_tool == runs);
        CHECK(input.jaw_closed == runs);
        CHECK((input.move != glm::dvec3(0)) == runs);
        CHECK((input.roll != 0.0) == runs);
        CHECK((input.turn_optic != 0.0) == runs);
    }
}

TEST_CASE("Ctrl with plus and minus asks for larger and smaller text and moves nothing") {
    CHECK(map_keys(down({Key::control, Key::plus}), Screen::run).text_step == 1);
    CHECK(map_keys(down({Key::control, Key::minus}), Screen::menu).text_step == -1);
    CHECK(map_keys(down({Key::plus}), Screen::run).text_step == 0);
    CHECK(map_keys(down({Key::control, Key::w}), Screen::run).move == glm::dvec3(0));
}
