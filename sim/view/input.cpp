// sim/view/input.cpp
// The key table of input.h.
#include "sim/view/input.h"

namespace view {
namespace {

double axis(const KeyFrame& keys, Key less, Key more) noexcept {
    return (keys.is_held(more) ? 1.0 : 0.0) - (keys.is_held(less) ? 1.0 : 0.0);
}

Action action_of(const KeyFrame& keys, Screen screen, bool widgets_have_keys) noexcept {
    const auto on = [&](Key key) { return keys.is_pressed(key); };
    const bool enter = on(Key::enter) && !widgets_have_keys;
    if (keys.is_held(Key::control))
        return on(Key::q) ? Action::quit : Action::none;
    if (on(Key::f) && !on(Key::escape))
        return Action::forces_on;
    switch (screen) {
    case Screen::menu:
        return Action::none;
    case Screen::card:
        if (on(Key::escape))
            return Action::back;
        return enter ? Action::start : on(Key::d) ? Action::demo : Action::none;
    case Screen::demo:
        return on(Key::escape) || on(Key::backspace) ? Action::abandon
               : on(Key::p)                          ? Action::pause
                                                     : Action::none;
    case Screen::replay:
        return on(Key::escape) || on(Key::backspace) ? Action::abandon : Action::none;
    case Screen::run:
        return on(Key::p) ? Action::pause : Action::none;
    case Screen::paused:
        if (on(Key::backspace))
            return Action::abandon;
        return on(Key::p) || enter ? Action::resume : Action::none;
    case Screen::score:
        return on(Key::escape) || enter ? Action::back : Action::none;
    }
    return Action::none;
}

} // namespace

UserInput map_keys(const KeyFrame& keys, Screen screen, bool widgets_have_keys) noexcept {
    UserInput input;
    input.zero_forces = keys.is_pressed(Key::escape);
    input.action = action_of(keys, screen, widgets_have_keys);
    if (keys.is_held(Key::control)) {
        input.text_step =
            (keys.is_pressed(Key::plus) ? 1 : 0) - (keys.is_pressed(Key::minus) ? 1 : 0);
        return input;
    }
    input.toggle_sound = keys.is_pressed(Key::m);
    if (screen != Screen::run)
        return input;
    input.switch_tool = keys.is_pressed(Key::tab);
    input.fine = keys.is_held(Key::shift);
    input.move = {axis(keys, Key::a, Key::d), axis(keys, Key::s, Key::w),
                  axis(keys, Key::q, Key::e)};
    input.roll = axis(keys, Key::r, Key::t);
    input.turn_optic = axis(keys, Key::z, Key::x);
    input.jaw_closed = keys.is_held(Key::space);
    return input;
}

} // namespace view
