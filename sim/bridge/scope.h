// sim/bridge/scope.h
// The endoscope between its device, the record and the picture: counts are all that is kept, and
// live, replay and re-score make the same view from them. Pure but for hold_scope.
#pragma once

#include "haptics/device/device.h"
#include "haptics/device/endoscope.h"
#include "sim/exchange.h"
#include "tasks/hand/sight.h"

namespace haptics {
class MouseDevice;
}

namespace sim {

/// How the scene's endoscope is held at first; its counts are 0 there.
struct SceneScope {
    haptics::Endoscope optics;
    haptics::EndoscopeAim start;
};

struct ScopeInstrument {
    bool fitted = false; // false: the scene's picture is fixed
    ScopeHolder holder = ScopeHolder::mount;
    haptics::Device* device = nullptr; // not owned; nullptr: stays as the scene starts
    SceneScope scene;
    glm::dvec3 origin_m{0.0}; // world place of the handle at the start
    double metres_per_count = 20e-6;
    double rad_per_count = 1e-3;
    tasks::View view; // its field of view; all of it if the picture is fixed
    haptics::DeviceSample sample;
};

ScopeInstrument make_scope(const std::optional<SceneScope>& scope, const tasks::View& view);

/// Reads the device; never waits. A faulty one keeps its last place.
tasks::ScopeTrace read_scope(ScopeInstrument& scope) noexcept;

/// Who held it, as its flags say.
ScopeHolder holder_of(const tasks::ScopeTrace& counts) noexcept;

/// What is seen through it.
ScopeNow look_through(const ScopeInstrument& scope, const tasks::ScopeTrace& counts) noexcept;

/// Moves a positioning device to where the scope is held like that.
void hold_scope(const ScopeInstrument& scope, const tasks::ScopeGoal& goal,
                haptics::MouseDevice& device) noexcept;
void hold_scope(const ScopeInstrument& scope, const haptics::EndoscopeAim& aim,
                haptics::MouseDevice& device) noexcept;

/// The goal that the scene starts with: what it looks at, from how far.
tasks::ScopeGoal start_goal(const tasks::View& view, const glm::dvec3& look_at_m) noexcept;

} // namespace sim
