#include "sim/loop/haptic_loop.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace sim {
namespace {

std::array<std::int32_t, 3> millinewtons(const glm::dvec3& force_n) noexcept {
    std::array<std::int32_t, 3> out{};
    for (int axis = 0; axis < 3; ++axis) {
        out[axis] = static_cast<std::int32_t>(std::lround(force_n[axis] * 1e3));
    }
    return out;
}

std::array<std::int32_t, 3> micrometres(const glm::dvec3& place_m) noexcept {
    std::array<std::int32_t, 3> out{};
    for (int axis = 0; axis < 3; ++axis) {
        out[axis] = static_cast<std::int32_t>(std::lround(place_m[axis] * 1e6));
    }
    return out;
}

// Newest samples and the tool poses they mean. A faulty device keeps its last pose.
std::array<haptics::DeviceFault, kTools> read_tools(HapticRig& rig, ToolsNow& now) noexcept {
    std::array<haptics::DeviceFault, kTools> fault{};
    for (int i = 0; i < kTools; ++i) {
        Instrument& instrument = rig.instrument[i];
        fault[i] = instrument.device ? instrument.device->read(instrument.sample)
                                     : haptics::DeviceFault::none;
        const ToolPlace place = place_of(instrument, instrument.sample.counts);
        now.handle_m[i] = place.handle_m;
        now.shaft[i] = place.shaft;
        now.jaw[i] = instrument.sample.jaw_counts * 1e-3;
        instrument.grip =
            haptics::next_grip(instrument.jaws, instrument.grip, now.jaw[i], place.shaft.tip_m);
        now.tip[i] = {place.shaft.tip_m, instrument.tip_radius_m, instrument.grip};
        now.roll_rad[i] = instrument.sample.roll_counts * instrument.roll_rad_per_count;
        now.faulted[i] = fault[i] != haptics::DeviceFault::none;
    }
    return fault;
}

// Takes up a new answer if there is one and none is still catching up.
std::int64_t take_answer(HapticRig& rig, Exchange& exchange) noexcept {
    if (rig.coupling_state.pending.answer)
        return -1;
    const TissueAnswer* answer = exchange.answers.fetch();
    if (!answer)
        return -1;
    haptics::adopt(rig.coupling_state, answer->local);
    rig.seen = answer->seen;
    return answer->local.step;
}

haptics::CouplingResult couple(HapticRig& rig, Exchange& exchange, std::int64_t tick) noexcept {
    const auto step = rig.coupling == Coupling::hold ? haptics::hold_tick : haptics::anchored_tick;
    const haptics::CouplingResult result =
        step(rig.coupling_state, rig.coupling_config, rig.history, tick);
    if (result.promoted)
        exchange.answers.keep();
    return result;
}

// The one place where a number that is not a number could reach a hand or the logbook.
glm::dvec3 finite_or_zero(const glm::dvec3& force_n, std::uint64_t& counter) noexcept {
    const double sum = force_n.x + force_n.y + force_n.z;
    if (std::isfinite(sum) && std::abs(sum) < 1e6)
        return force_n;
    ++counter;
    return glm::dvec3{0.0};
}

// From the force on the tip to the force that the hand may feel, last limits included.
void send_force(Instrument& instrument, const haptics::ShaftPose& shaft, const glm::dvec3& tip_n,
                haptics::DeviceFault fault, bool zero, double& felt_share) noexcept {
    if (zero)
        instrument.limit_state.enabled = false;
    else if (!instrument.limit_state.enabled)
        haptics::resume(instrument.limit_state); // after Esc: back on the ramp
    const glm::dvec3 wanted = haptics::force_at_handle(shaft, tip_n);
    const glm::dvec3 sent =
        haptics::limit_force(instrument.limit_state, instrument.limits, wanted, fault);
    const double length = glm::length(wanted);
    felt_share = length > 0.0 ? glm::length(sent) / length : instrument.limit_state.ramp;
    if (instrument.device)
        instrument.device->write(sent);
}

} // namespace

Coupling coupling_named(const std::string& name) {
    if (name == "anchored")
        return Coupling::anchored;
    if (name == "hold")
        return Coupling::hold;
    throw std::invalid_argument(fmt::format("coupling \"{}\": must be anchored or hold", name));
}

ToolPlace place_of(const Instrument& instrument,
                   const std::array<std::int32_t, 3>& counts) noexcept {
    const glm::dvec3 handle = instrument.origin_m + instrument.metres_per_count *
                                                        glm::dvec3{counts[0], counts[1], counts[2]};
    return {handle, haptics::shaft_pose(instrument.trocar, handle)};
}

void haptic_tick(HapticRig& rig, Exchange& exchange, tasks::TickTrace& trace) noexcept {
    const std::int64_t tick = rig.next_tick++;
    ToolsNow& now = exchange.tools.back();
    now.tick = tick;
    const auto fault = read_tools(rig, now);
    trace.scope = read_scope(rig.scope);
    now.scope = look_through(rig.scope, trace.scope);
    rig.history.push(tick, now.tip);

    trace.tick = tick;
    trace.adopted_step = take_answer(rig, exchange);
    now.clear_rays = rig.seen.clear_rays;
    const haptics::CouplingResult result = couple(rig, exchange, tick);
    rig.slid_off_patch += static_cast<std::uint64_t>(result.slid_off);

    const bool zero = exchange.zero_forces.load(std::memory_order_relaxed) || !rig.forces_on;
    for (int i = 0; i < kTools; ++i) {
        Instrument& instrument = rig.instrument[i];
        const glm::dvec3 force_n = finite_or_zero(result.force_n[i], rig.not_finite);
        now.force_n[i] = force_n;
        now.touching[i] = result.touching[i];
        now.grasping[i] = result.grasping[i];
        send_force(instrument, now.shaft[i], force_n, fault[i], zero, now.felt_share[i]);
        haptics::observe_energy(instrument.energy, now.handle_m[i], instrument.limit_state.last_n);

        tasks::ToolTrace& out = trace.tool[i];
        out.counts = instrument.sample.counts;
        out.roll_counts = instrument.sample.roll_counts;
        out.jaw_counts = instrument.sample.jaw_counts;
        out.force_mn = millinewtons(force_n);
        const double length = glm::length(force_n);
        const glm::dvec3 touch_m =
            length > 0.0 ? now.tip[i].centre_m - instrument.tip_radius_m / length * force_n
                         : now.tip[i].centre_m;
        out.contact_um = micrometres(touch_m);
        out.flags =
            static_cast<std::uint8_t>((result.touching[i] ? 1 : 0) | (instrument.device ? 2 : 0) |
                                      (now.faulted[i] ? 4 : 0) | (result.grasping[i] ? 16 : 0));
    }
    exchange.tools_seen.back() = now;
    exchange.tools_seen.publish();
    exchange.tools.publish();
}

} // namespace sim
