// sim/view/window.h
// The trainee's window: 3-D picture, force bars, menu, card, score. One window per process.
// Everything is called from the thread that made it, which must be the main thread (GLFW), and
// never from a loop: no loop waits for the picture.
#pragma once

#include "sim/view/frame.h"
#include "sim/view/frame_times.h"
#include "sim/view/input.h"
#include "sim/view/screens.h"

#include <memory>
#include <stdexcept>
#include <string>

namespace view {

/// No display, no OpenGL 3.3: what() says what to do, and the way without a window.
struct WindowError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct WindowOptions {
    int width_px = 1280, height_px = 720;
    std::string title = "Trocar";
    bool visible = true;
    bool wait_for_screen = true; // vertical sync; false: draw() returns at once (measurements)
    bool adapt = true;           // false: always full resolution (measurements)
    double text_scale = 1.0;     // 1.0 .. 2.0
    bool sound = false;          // silent anyway where there is no loudspeaker
    bool mute = false;           // silent until the person presses M
};

/// What drawing costs; the first two smoothed over about 20 frames.
struct DrawCost {
    double frame_ms = 0.0;      // wall time between two draws
    double draw_ms = 0.0;       // inside draw(), without waiting for the screen
    double picture_share = 1.0; // side length of the 3-D picture against the window: 0.5 .. 1
    std::string renderer;       // as OpenGL names it
    FrameTimes times;           // of all draw() calls so far
};

class Window {
  public:
    /// Opens the window. Throws WindowError.
    explicit Window(const WindowOptions& options = {});
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Draws one picture and returns what the person did since the last call. On the screens menu,
    /// card and score the frame's world is drawn dimly behind, if it has any surface.
    UserInput draw(const ViewFrame& frame, const Screens& screens);

    /// Writes what draw() last showed as PNG. Throws WindowError with the path.
    void screenshot(const std::string& path);

    void resize(int width_px, int height_px);
    const DrawCost& cost() const noexcept;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// One line about it for people who look for what is slow.
std::string cost_line(const DrawCost& cost);

} // namespace view
