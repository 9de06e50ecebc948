// haptics/safety/limits.h
// The last thing between a computed force and a hand: what is not finite becomes zero, length and
// slew are bounded, and force comes back on a ramp after start, resume and every fault. (Stiffness
// is bounded where it is made: by the floor of the contact's compliance.) Device frame. Real-time
// safe.
#pragma once

#include "haptics/device/device.h"

namespace haptics {

struct LimitConfig {
    double max_force_n = 8.0;
    double max_slew_n_per_tick = 1.0;
    double ramp_s = 0.75; // 0 to full force
    double tick_s = 1e-3;
    int clean_reads_to_resume = 50; // after a fault
};

struct LimitState {
    glm::dvec3 last_n{0.0};
    double ramp = 0.0; // 0..1
    int clean_reads = 0;
    bool faulted = false;
    bool enabled = true;          // false: Esc was pressed; zero force until resume()
    std::uint32_t not_finite = 0; // counters for the rig report
    std::uint32_t saturated = 0;
    std::uint32_t slewed = 0;
};

/// Force to send now. `fault` is this tick's read result.
/// A fault, a force that is not finite or `enabled == false` gives exactly zero in the same tick,
/// and what follows comes back on the ramp.
glm::dvec3 limit_force(LimitState& state, const LimitConfig& config, const glm::dvec3& wanted_n,
                       DeviceFault fault) noexcept;

/// Start the ramp again from zero (start of an attempt, resume after pause or Esc).
void resume(LimitState& state) noexcept;

/// Energy the port has taken in minus given out, J; below zero it has been a source. For a force
/// held between ticks W_k = W_{k-1} - F_{k-1}.(x_k - x_{k-1}) (Hannaford & Ryu 2002). Observer
/// only.
struct EnergyObserver {
    double energy_j = 0.0;
    double min_j = 0.0;
    glm::dvec3 last_x_m{0.0}, last_f_n{0.0};
    bool started = false;
};
void observe_energy(EnergyObserver& observer, const glm::dvec3& x_m,
                    const glm::dvec3& force_n) noexcept;

} // namespace haptics
