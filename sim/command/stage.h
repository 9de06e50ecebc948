// sim/command/stage.h
// A running session as the window shows it: fills a ViewFrame from what crosses the exchange, and
// turns mouse and keys into places for the tips. Called from the render thread only.
#pragma once

#include "sim/session/steering.h"
#include "sim/view/window.h"

namespace sim {

class Stage {
  public:
    /// `session` must outlive the stage. `by_hand`: mouse and keys move the tools.
    Stage(const Session& session, bool by_hand, int first_surface_id);

    /// The world as the newest messages have it.
    const view::ViewFrame& frame(Exchange& exchange);

    /// A sentence that stands on the picture from now on.
    void say(std::string note) { note_ = std::move(note); }

    /// Moves the active tool's goal by what the person did since the last frame.
    void steer(const view::UserInput& input, double frame_s, Exchange& exchange);

  private:
    void show_tools(const ToolsNow& now);
    void show_scope(const ToolsNow& now);
    void show_targets(const TargetPlaces& target_um, const ProgressNow& progress);
    void show_search(const ToolsNow& now, const TargetPlaces& target_um,
                     const ProgressNow& progress);
    void show_path(const ProgressNow& progress);

    const Session& session_;
    bool by_hand_;
    std::string note_;
    view::ViewFrame frame_;
    std::vector<std::vector<glm::vec3>> rest_m_;
    std::vector<std::vector<glm::vec3>> rest_normal_;
    Steering steering_;
    ProgressNow progress_;
};

/// A software renderer takes every core by default, the 1 kHz loop's too: call before a window.
void leave_cores_to_the_loops();

} // namespace sim
