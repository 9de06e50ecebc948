// sim/loop/haptic_loop.h
// One millisecond of three instruments: samples in, forces out. The 1 kHz thread calls this on a
// timer, lockstep calls it in its loop; it reads no clock, allocates nothing, locks nothing.
#pragma once

#include "haptics/contact/coupling.h"
#include "haptics/device/device.h"
#include "haptics/safety/limits.h"
#include "sim/bridge/scope.h"
#include "sim/exchange.h"

#include <string>

namespace sim {

enum class Coupling : std::uint8_t { anchored, hold };
/// Throws std::invalid_argument with what would be accepted.
Coupling coupling_named(const std::string& name);

/// One instrument: a device, and the tool that it moves through its trocar.
struct Instrument {
    haptics::Device* device = nullptr; // not owned; nullptr: nobody holds this tool
    haptics::Trocar trocar;
    glm::dvec3 origin_m{0.0}; // world place of the device's zero
    double metres_per_count = 20e-6;
    double roll_rad_per_count = 1e-3;
    double tip_radius_m = 3e-3;
    haptics::JawConfig jaws;
    haptics::JawGrip grip; // as of the last tick
    haptics::LimitConfig limits;
    haptics::LimitState limit_state;
    haptics::EnergyObserver energy;
    haptics::DeviceSample sample; // the newest good one
};

struct HapticRig {
    std::array<Instrument, kTools> instrument;
    Coupling coupling = Coupling::anchored;
    haptics::CouplingConfig coupling_config;
    haptics::CouplingState coupling_state;
    haptics::PoseHistory history;
    bool forces_on = true; // false: positions only, a supported mode
    std::int64_t next_tick = 0;
    TissueSeen seen; // of the newest answer taken
    ScopeInstrument scope;
    // for the rig report
    std::uint64_t slid_off_patch = 0;
    std::uint64_t not_finite = 0;
};

/// Handle, shaft and tip that a sample means. Shared by live runs, replay and re-score.
struct ToolPlace {
    glm::dvec3 handle_m;
    haptics::ShaftPose shaft;
};
ToolPlace place_of(const Instrument& instrument,
                   const std::array<std::int32_t, 3>& counts) noexcept;

/// Advances the rig by one tick and fills `trace`.
void haptic_tick(HapticRig& rig, Exchange& exchange, tasks::TickTrace& trace) noexcept;

} // namespace sim
