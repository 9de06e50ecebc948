#include "haptics/safety/limits.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace haptics {
namespace {

bool finite(const glm::dvec3& v) noexcept {
    return std::isfinite(v.x + v.y + v.z);
}

glm::dvec3 no_force(LimitState& state) noexcept {
    state.ramp = 0.0;
    state.last_n = glm::dvec3{0.0};
    return state.last_n;
}

} // namespace

glm::dvec3 limit_force(LimitState& state, const LimitConfig& config, const glm::dvec3& wanted_n,
                       DeviceFault fault) noexcept {
    // what is not finite becomes zero, now, and force comes back on the ramp
    const bool sound = finite(wanted_n);
    state.not_finite += sound ? 0 : 1;

    // a fault takes the force away in the same tick and holds it until reads are clean again
    if (fault != DeviceFault::none) {
        state.faulted = true;
        state.clean_reads = 0;
    } else if (state.faulted && ++state.clean_reads >= config.clean_reads_to_resume) {
        state.faulted = false;
    }
    if (state.faulted || !state.enabled || !sound)
        return no_force(state);

    state.ramp =
        config.ramp_s > 0.0 ? std::min(1.0, state.ramp + config.tick_s / config.ramp_s) : 1.0;
    glm::dvec3 force_n = state.ramp * wanted_n;

    // too long: the direction stays. Scaled first, so that the length itself cannot overflow.
    const double size = std::max({std::abs(force_n.x), std::abs(force_n.y), std::abs(force_n.z)});
    const glm::dvec3 scaled = size > 0.0 ? force_n / size : glm::dvec3{0.0};
    if (glm::length(scaled) * size > config.max_force_n) {
        ++state.saturated;
        force_n = scaled * (config.max_force_n / glm::length(scaled));
    }

    const glm::dvec3 change_n = force_n - state.last_n;
    if (glm::length(change_n) > config.max_slew_n_per_tick) {
        ++state.slewed;
        force_n = state.last_n + change_n * (config.max_slew_n_per_tick / glm::length(change_n));
    }
    state.last_n = force_n;
    return force_n;
}

void resume(LimitState& state) noexcept {
    state.enabled = true;
    no_force(state);
}

void observe_energy(EnergyObserver& observer, const glm::dvec3& x_m,
                    const glm::dvec3& force_n) noexcept {
    if (observer.started)
        observer.energy_j -= glm::dot(observer.last_f_n, x_m - observer.last_x_m);
    observer.min_j = std::min(observer.min_j, observer.energy_j);
    observer.last_x_m = x_m;
    observer.last_f_n = force_n;
    observer.started = true;
}

} // namespace haptics
