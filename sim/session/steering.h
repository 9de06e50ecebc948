// sim/session/steering.h
// One mouse and its keys as places for three tools and the endoscope, one at a time. What a person
// takes over starts where it is; what he lets go is the assistant's, where there is one.
// Called by the window, in the render thread; pure.
//
// The endoscope turns the way the pointer goes: pointer right, the view turns to the right, and
// what is seen moves to the left; up alike. In the same scale as a tool: 0.15 mm a pixel at 150 mm.
#pragma once

#include "sim/session/session.h"
#include "sim/view/input.h"

namespace sim {

inline constexpr int kScopeActive = kTools; // beside the tools' indices

struct Steering {
    std::array<haptics::Trocar, kTools> trocar{};
    std::optional<haptics::Trocar> scope; // none: the picture is fixed
    glm::dvec3 scope_start{0.0};          // unit, its shaft at first
    tasks::View start_view;
    bool assisted = false; // what the person does not hold has another hand
    int active = kFirstTool;
    PointerGoals goals;
    std::array<bool, kTools> latched{}; // closed when it was left: until pressed and released
    bool pressed_again = false;         // of the active tool, since it was taken
    bool wait_for_release = false;      // the button was down when the tool was changed
};

Steering begin_steering(const Session& session);

/// What the person did since the last frame, with everything as it is now.
void steer(Steering& steering, const view::UserInput& input, const ToolsNow& now,
           double frame_s) noexcept;

} // namespace sim
