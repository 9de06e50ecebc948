// sim/session/crew.h
// Or, in the window, one person at mouse and keyboard.
// Who holds the tools in a scripted attempt: one scripted person with three virtual devices. The
// hand says where it wants each tip, the device's grip pulls the handle there, force pushes back.
// Runs in the thread that owns the tick, outside the measured haptic tick.
#pragma once

#include "haptics/device/mouse_device.h"
#include "haptics/device/virtual_device.h"
#include "sim/session/scene.h"
#include "tasks/hand/hand.h"
#include "tasks/hand/script.h"

#include <memory>
#include <variant>

namespace sim {

struct Crew {
    std::array<std::unique_ptr<haptics::VirtualDevice>, kTools> device;
    std::array<std::unique_ptr<haptics::MouseDevice>, kTools> mouse; // instead of the above
    std::variant<std::monostate, tasks::Hand, tasks::ScriptHand> hand;
};

/// Three virtual devices with their handles where the scene starts the tips. Connects them to
/// `rig`; the crew must outlive it.
Crew make_crew(const Scene& scene, HapticRig& rig);

/// Three tools moved by mouse and keyboard: places come through Exchange::pointer.
Crew make_mouse_crew(HapticRig& rig);
void move_mouse_crew(Crew& crew, const HapticRig& rig, const PointerGoals& goals) noexcept;

/// One millisecond of the person and of the devices' physics, before the haptic tick.
void crew_tick(Crew& crew, const HapticRig& rig, const tasks::HandSight& sight);

} // namespace sim
