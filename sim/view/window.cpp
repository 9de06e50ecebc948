// sim/view/window.cpp
// Opens GLFW, OpenGL and Dear ImGui, and puts one picture together: world, HUD, page.
// Everything is drawn into a target of our own and copied to the window last, so that a hidden
// window shows the same picture and a screenshot needs no luck with buffer swaps.
#include "sim/view/window.h"

#include "sim/view/gl_objects.h"
#include "sim/view/hud.h"
#include "sim/view/keyboard.h"
#include "sim/view/optics.h"
#include "sim/view/pages.h"
#include "sim/view/picture.h"
#include "sim/view/png.h"
#include "sim/view/resolution.h"
#include "sim/view/sound.h"

#include <chrono>
#include <optional>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace view {
namespace {

using Clock = std::chrono::steady_clock;

constexpr float kBody_px = 16.0F;
constexpr const char* kWithout =
    " Without a window: `trocar run EXERCISE` does a scripted attempt and prints its score.";

std::string last_glfw_words; // GLFW reports through a plain function

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// The GLFW library and our one window.
class Frame {
  public:
    explicit Frame(const WindowOptions& options) {
        glfwSetErrorCallback([](int, const char* words) { last_glfw_words = words; });
        if (glfwInit() != GLFW_TRUE)
            throw WindowError("There is no display (" + last_glfw_words +
                              "). Start from a desktop session, or set DISPLAY, or use xvfb-run." +
                              kWithout);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_VISIBLE, options.visible ? GLFW_TRUE : GLFW_FALSE);
        glfwWindowHint(GLFW_DEPTH_BITS, 0);
        window = glfwCreateWindow(options.width_px, options.height_px, options.title.c_str(),
                                  nullptr, nullptr);
        if (window == nullptr) {
            glfwTerminate();
            throw WindowError("This display offers no OpenGL 3.3 (" + last_glfw_words +
                              "). Update the graphics driver, or draw in software: "
                              "LIBGL_ALWAYS_SOFTWARE=1 with the package libgl1-mesa-dri." +
                              kWithout);
        }
        glfwMakeContextCurrent(window);
        glfwSwapInterval(options.wait_for_screen ? 1 : 0);
    }
    ~Frame() {
        glfwDestroyWindow(window);
        glfwTerminate();
    }
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;

    GLFWwindow* window = nullptr;
};

/// Dear ImGui's context and its two backends.
struct Widgets {
    explicit Widgets(GLFWwindow* window) {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr; // remembers nothing on disk
        ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
        ImGui_ImplGlfw_InitForOpenGL(window, true);
        ImGui_ImplOpenGL3_Init("#version 330 core");
    }
    ~Widgets() {
        ImGui_ImplOpenGL3_Shutdown();
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    Widgets(const Widgets&) = delete;
    Widgets& operator=(const Widgets&) = delete;
};

} // namespace

struct Window::Parts {
    explicit Parts(const WindowOptions& options)
        : frame(options), keyboard(frame.window), widgets(frame.window),
          text_scale(std::clamp(options.text_scale, 1.0, 2.0)), adapt(options.adapt),
          speaker(options.sound, options.mute) {
        const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
        cost.renderer = name != nullptr ? name : "unknown";
        // smooth edges cost a software renderer most of its time
        const bool software = cost.renderer.find("llvmpipe") != std::string::npos ||
                              cost.renderer.find("softpipe") != std::string::npos;
        samples = software ? 0 : 4;
    }

    void fit_text();
    void draw_world(const ViewFrame& shown);
    void sound(const ViewFrame& shown, Screen screen);
    UserInput draw_widgets(const ViewFrame& shown, const Screens& screens);

    Frame frame; // first in, last out
    Keyboard keyboard;
    Widgets widgets;
    Picture picture;
    Optics optics;
    Target world, smooth, page;
    Fonts fonts;
    Digits digits;
    double text_scale;
    float loaded_px = 0.0F;
    int samples = 0, width_px = 0, height_px = 0;
    bool adapt = true;
    Listener listener;
    Speaker speaker;
    Resolution resolution;
    std::optional<Screen> last_screen;
    Clock::time_point last_draw = Clock::now();
    DrawCost cost;
};

/// Letters follow the window's height a little, the display's own scale and the person's wish.
void Window::Parts::fit_text() {
    float display_scale = 1.0F;
    glfwGetWindowContentScale(frame.window, &display_scale, nullptr);
    const float grown = std::clamp(static_cast<float>(height_px) / 720.0F, 0.85F, 1.6F);
    const float fits = static_cast<float>(width_px) / 28.0F; // the force bars need 28 letters
    const float wish =
        kBody_px * std::max(1.0F, display_scale) * grown * static_cast<float>(text_scale);
    const float body_px = std::round(std::clamp(wish, 8.0F, std::max(12.0F, fits)));
    if (body_px == loaded_px)
        return;
    loaded_px = body_px;
    fonts = load_fonts(body_px);
    digits = digits_of(fonts);
    set_look(body_px);
}

void Window::Parts::draw_world(const ViewFrame& shown) {
    const Lens lens = lens_of(width_px, height_px);
    const double half_px = 0.5 * resolution.share() * height_px;
    const auto side = [&](double reach) { // even like most windows: then the middle stays sharp
        return 2 * std::max(1, static_cast<int>(std::ceil(half_px * reach)));
    };
    world.resize(side(lens.reach.x), side(lens.reach.y), samples, true);
    page.resize(width_px, height_px, 0, false);
    world.bind();
    picture.draw(shown, digits, lens, height_px);
    if (samples > 0) {
        smooth.resize(world.width_px(), world.height_px(), 0, false);
        world.blit_to(smooth);
    }
    page.bind();
    optics.draw(samples > 0 ? smooth : world, lens,
                static_cast<double>(width_px) / std::max(1, height_px));
}

/// Only what runs sounds.
void Window::Parts::sound(const ViewFrame& shown, Screen screen) {
    if (screen == Screen::run || screen == Screen::demo)
        speaker.play(listener.hear(shown));
    else if (screen != Screen::paused)
        listener.forget();
}

UserInput Window::Parts::draw_widgets(const ViewFrame& shown, const Screens& screens) {
    const bool fresh = last_screen != screens.screen;
    last_screen = screens.screen;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGuiIO& io = ImGui::GetIO();
    if (keyboard.enter_held()) // Enter presses a button as Space does
        io.NavInputs[ImGuiNavInput_Activate] = 1.0F;
    const KeyFrame keys = keyboard.take_keys();
    ImGui::NewFrame();
    const bool on_widgets = io.NavVisible && screens.screen != Screen::run;
    UserInput input = map_keys(keys, screens.screen, on_widgets);
    if (screens.screen == Screen::menu && keys.is_pressed(Key::enter) && !on_widgets &&
        !screens.menu.exercises.empty()) {
        input.action = Action::select; // nothing chosen yet: the first one
        input.index = 0;
    }
    const bool live = screens.screen == Screen::run || screens.screen == Screen::demo ||
                      screens.screen == Screen::replay;
    if (live || screens.screen == Screen::paused)
        draw_hud(shown, screens.screen, fonts);
    if (!live) // what lies behind a page steps back
        ImGui::GetBackgroundDrawList()->AddRectFilled({0, 0}, io.DisplaySize,
                                                      IM_COL32(6, 9, 12, 150));
    ImGui::PushFont(fonts.body);
    draw_page(screens, fonts, fresh, input);
    ImGui::PopFont();
    keyboard.take_pointer(screens.screen == Screen::run, !live || io.WantCaptureMouse, input);
    ImGui::Render();
    page.bind();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    return input;
}

Window::Window(const WindowOptions& options) : parts_(std::make_unique<Parts>(options)) {}
Window::~Window() = default;

UserInput Window::draw(const ViewFrame& frame, const Screens& screens) {
    Parts& p = *parts_;
    const double between_ms = ms_since(p.last_draw);
    p.last_draw = Clock::now();
    p.cost.frame_ms += (between_ms - p.cost.frame_ms) / 20.0;
    glfwPollEvents();
    glfwGetFramebufferSize(p.frame.window, &p.width_px, &p.height_px);
    UserInput input;
    if (p.width_px > 0 && p.height_px > 0) { // else iconified: keys still count
        p.fit_text();
        p.draw_world(frame);
        input = p.draw_widgets(frame, screens);
        p.page.blit_to_window(p.width_px, p.height_px);
        glFinish(); // measures the drawing, and keeps the picture no more than one behind
        const double draw_ms = ms_since(p.last_draw);
        p.cost.draw_ms += (draw_ms - p.cost.draw_ms) / 20.0;
        p.cost.times.record(draw_ms);
        if (p.adapt)
            p.resolution.observe(draw_ms, p.width_px, p.height_px);
        p.cost.picture_share = p.resolution.share();
        glfwSwapBuffers(p.frame.window);
    } else {
        input = map_keys(p.keyboard.take_keys(), screens.screen);
    }
    p.sound(frame, screens.screen);
    if (input.toggle_sound)
        p.speaker.toggle();
    p.text_scale = std::clamp(p.text_scale + 0.1 * input.text_step, 1.0, 2.0);
    if (glfwWindowShouldClose(p.frame.window) == GLFW_TRUE)
        input.action = Action::quit;
    return input;
}

void Window::screenshot(const std::string& path) {
    const Target& page = parts_->page;
    const int w = page.width_px(), h = page.height_px();
    std::vector<std::uint8_t> rgb(static_cast<std::size_t>(3) * w * h);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, page.frame_id());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, w, h, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
    write_png(path, rgb, w, h);
}

void Window::resize(int width_px, int height_px) {
    glfwSetWindowSize(parts_->frame.window, width_px, height_px);
}

const DrawCost& Window::cost() const noexcept {
    return parts_->cost;
}

std::string cost_line(const DrawCost& cost) {
    return fmt::format("{} pictures, drawn in {:.1f} ms (p50), {:.1f} ms (p99), share {:.2f}, {}",
                       cost.times.pictures(), cost.times.percentile_ms(0.50),
                       cost.times.percentile_ms(0.99), cost.picture_share, cost.renderer);
}

} // namespace view
