// sim/view/keyboard.h
// Collects GLFW's key, pointer and wheel events between two pictures. Used by Window, in its
// thread. Made before Dear ImGui's backend, which calls on to what was there first.
#pragma once

#include "sim/view/input.h"

struct GLFWwindow;

namespace view {

class Keyboard {
  public:
    /// Takes the window's user pointer and key and scroll callbacks.
    explicit Keyboard(GLFWwindow* window);
    Keyboard(const Keyboard&) = delete;
    Keyboard& operator=(const Keyboard&) = delete;

    /// What happened since the last call; held keys stay held. `pointer_captured`: on the run
    /// screen the pointer is taken so that it cannot leave the window while it moves a tool.
    KeyFrame take_keys() noexcept;
    /// Pointer motion, wheel and buttons into `input`. `over_widgets`: they keep the pointer.
    void take_pointer(bool captured, bool over_widgets, UserInput& input);

    void on_key(int glfw_key, int glfw_action) noexcept;
    void on_wheel(double notches) noexcept { wheel_ += notches; }
    bool enter_held() const noexcept { return keys_.is_held(Key::enter); }

  private:
    GLFWwindow* window_;
    KeyFrame keys_;
    double wheel_ = 0.0;
    glm::dvec2 pointer_px_{0.0};
    bool pointer_known_ = false, captured_ = false;
};

} // namespace view
