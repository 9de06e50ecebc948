// sim/view/input.h
// From keys to intentions: one table, a pure function, no display needed. Called by Window::draw()
// in the render thread; tested without a window.
//
//   Esc            zero all forces, on every screen; where nothing runs, also one screen back
//   F              forces on again
//   P              pause, resume            Backspace  abandon (when paused)
//   Enter          start (card), resume (paused), menu (score)    D  demonstration (card)
//   Backspace      on a replay: back to the score (Esc too)
//   Tab            next tool, then the endoscope            Shift  slow and fine
//   A D, S W, Q E  the active tool left right, down up, away nearer
//   R T            roll left, right         Space or left button  close the jaw
//   the endoscope: A D, S W turn the view, Q E in and out, R T the camera head, Z X the optic
//   Ctrl+Q         quit                     Ctrl + and -  larger and smaller text
//   M              sound off and on
#pragma once

#include "sim/view/screens.h"

#include <array>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace view {

enum class Action {
    none,
    select,         // menu: `index` is the exercise whose card to show
    choose_trainee, // menu: `index`, -1 for nobody
    start,          // card: begin the attempt (score: the same exercise again)
    demo,           // card: show the expert
    pause,
    resume,
    abandon, // run, paused: end the attempt incomplete; demo, replay: end what is shown
    show,    // score: `index` is the moment to see again
    back,    // card, score: to the menu
    forces_on,
    quit // the window was closed, or Ctrl+Q
};

struct UserInput {
    Action action = Action::none;
    int index = -1;
    bool zero_forces = false;     // Esc went down since the last draw: act on it first
    bool switch_tool = false;     // Tab went down
    bool fine = false;            // Shift is held: scale motion down
    glm::dvec3 move{0.0};         // keys held, -1..1 along picture right, picture up, to the camera
    double roll = 0.0;            // keys held, -1..1
    double turn_optic = 0.0;      // keys held, -1..1
    bool jaw_closed = false;      // held
    glm::dvec2 mouse_px{0.0};     // pointer motion since the last draw, y up; 0 over buttons
    double wheel = 0.0;           // notches, positive away from the person
    std::array<bool, 3> button{}; // left, right, middle held
    int text_step = 0;            // Ctrl + and -: done by the window itself, for information
    bool toggle_sound = false;    // M went down: done by the window itself, for information
};

enum class Key {
    escape,
    enter,
    tab,
    space,
    backspace,
    plus,
    minus,
    a,
    d,
    s,
    w,
    q,
    e,
    r,
    t,
    z,
    x,
    f,
    p,
    m,
    shift,
    control,
    count
};

/// Keys of one frame: went down since the last one, and held now.
struct KeyFrame {
    std::array<bool, static_cast<std::size_t>(Key::count)> pressed{};
    std::array<bool, static_cast<std::size_t>(Key::count)> held{};

    bool is_pressed(Key key) const noexcept { return pressed[static_cast<std::size_t>(key)]; }
    bool is_held(Key key) const noexcept { return held[static_cast<std::size_t>(key)]; }
    void press(Key key) noexcept {
        pressed[static_cast<std::size_t>(key)] = held[static_cast<std::size_t>(key)] = true;
    }
};

/// The table above. Esc sets zero_forces on every screen. Tools move on the run screen only.
/// `widgets_have_keys`: a button has the keyboard focus, so Enter and Space are its own.
UserInput map_keys(const KeyFrame& keys, Screen screen, bool widgets_have_keys = false) noexcept;

} // namespace view
