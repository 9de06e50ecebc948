// sim/session/crew.h
// Who holds the tools and the endoscope. In a scripted attempt one scripted person with three
// virtual devices: the hand says where it wants each tip, the device's grip pulls the handle there,
// force pushes back; a second one at the endoscope, if the exercise wants an assistant there. In
// the window one person at mouse and keyboard, and assistants for what he does not hold.
// Runs in the thread that owns the tick, outside the measured haptic tick.
#pragma once

#include "haptics/device/mouse_device.h"
#include "haptics/device/virtual_device.h"
#include "sim/session/scene.h"
#include "tasks/hand/camera_hand.h"
#include "tasks/hand/find_hand.h"
#include "tasks/hand/hand.h"
#include "tasks/hand/script.h"

#include <memory>
#include <variant>

namespace sim {

struct Crew {
    std::array<std::unique_ptr<haptics::VirtualDevice>, kTools> device;
    std::array<std::unique_ptr<haptics::MouseDevice>, kTools> mouse; // instead of the above
    std::variant<std::monostate, tasks::Hand, tasks::FindHand, tasks::ScriptHand> hand;
    std::unique_ptr<haptics::MouseDevice> scope; // null: on its mount
    std::optional<tasks::CameraHand> camera;
    PointerGoals pointer; // of the person, newest
};

/// Three virtual devices with their handles where the scene starts the tips. Connects them to
/// `rig`; the crew must outlive it.
Crew make_crew(const Scene& scene, HapticRig& rig);

/// Three tools moved by mouse and keyboard: places come through Exchange::pointer into
/// Crew::pointer.
Crew make_mouse_crew(const Scene& scene, HapticRig& rig);

/// Where the scene starts the tips.
std::array<glm::dvec3, kTools> start_tips(const Scene& scene);

/// Takes the endoscope off its mount: from now on the hand, the assistant or the person holds it.
void give_scope(Crew& crew, HapticRig& rig);

/// One millisecond of the person and of the devices' physics, before the haptic tick.
void crew_tick(Crew& crew, HapticRig& rig, const tasks::HandSight& sight);

} // namespace sim
