// sim/view/keyboard.cpp
// A key pressed and released between two pictures still counts as pressed.
#include "sim/view/keyboard.h"

#include <optional>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace view {
namespace {

std::optional<Key> key_of(int glfw_key) noexcept {
    constexpr std::pair<int, Key> kTable[] = {{GLFW_KEY_ESCAPE, Key::escape},
                                              {GLFW_KEY_ENTER, Key::enter},
                                              {GLFW_KEY_KP_ENTER, Key::enter},
                                              {GLFW_KEY_TAB, Key::tab},
                                              {GLFW_KEY_SPACE, Key::space},
                                              {GLFW_KEY_BACKSPACE, Key::backspace},
                                              {GLFW_KEY_EQUAL, Key::plus},
                                              {GLFW_KEY_KP_ADD, Key::plus},
                                              {GLFW_KEY_MINUS, Key::minus},
                                              {GLFW_KEY_KP_SUBTRACT, Key::minus},
                                              {GLFW_KEY_A, Key::a},
                                              {GLFW_KEY_D, Key::d},
                                              {GLFW_KEY_S, Key::s},
                                              {GLFW_KEY_W, Key::w},
                                              {GLFW_KEY_Q, Key::q},
                                              {GLFW_KEY_E, Key::e},
                                              {GLFW_KEY_R, Key::r},
                                              {GLFW_KEY_T, Key::t},
                                              {GLFW_KEY_Z, Key::z},
                                              {GLFW_KEY_X, Key::x},
                                              {GLFW_KEY_F, Key::f},
                                              {GLFW_KEY_P, Key::p},
                                              {GLFW_KEY_M, Key::m},
                                              {GLFW_KEY_LEFT_SHIFT, Key::shift},
                                              {GLFW_KEY_RIGHT_SHIFT, Key::shift},
                                              {GLFW_KEY_LEFT_CONTROL, Key::control},
                                              {GLFW_KEY_RIGHT_CONTROL, Key::control}};
    for (const auto& [from, to] : kTable)
        if (from == glfw_key)
            return to;
    return std::nullopt;
}

Keyboard& keyboard_of(GLFWwindow* window) {
    return *static_cast<Keyboard*>(glfwGetWindowUserPointer(window));
}

} // namespace

Keyboard::Keyboard(GLFWwindow* window) : window_(window) {
    glfwSetWindowUserPointer(window, this);
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
        keyboard_of(w).on_key(key, action);
    });
    glfwSetScrollCallback(
        window, [](GLFWwindow* w, double, double notches) { keyboard_of(w).on_wheel(notches); });
}

void Keyboard::on_key(int glfw_key, int glfw_action) noexcept {
    const std::optional<Key> key = key_of(glfw_key);
    if (!key || glfw_action == GLFW_REPEAT)
        return;
    if (glfw_action == GLFW_PRESS)
        keys_.press(*key);
    else
        keys_.held[static_cast<std::size_t>(*key)] = false;
}

KeyFrame Keyboard::take_keys() noexcept {
    const KeyFrame now = keys_;
    keys_.pressed.fill(false);
    return now;
}

void Keyboard::take_pointer(bool captured, bool over_widgets, UserInput& input) {
    if (captured != captured_) {
        glfwSetInputMode(window_, GLFW_CURSOR,
                         captured ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
        captured_ = captured;
        pointer_known_ = false; // the pointer jumps: that is no motion
    }
    glm::dvec2 now(0.0);
    glfwGetCursorPos(window_, &now.x, &now.y);
    if (pointer_known_ && !over_widgets)
        input.mouse_px = {now.x - pointer_px_.x, pointer_px_.y - now.y};
    pointer_px_ = now;
    pointer_known_ = true;
    if (!over_widgets) {
        input.wheel = wheel_;
        for (int i = 0; i < 3; ++i)
            input.button[i] = glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_LEFT + i) == GLFW_PRESS;
    }
    wheel_ = 0.0;
    if (captured)
        input.jaw_closed = input.jaw_closed || input.button[0];
}

} // namespace view
