// haptics/contact/hold.cpp
// The `hold` coupling: the newest answer as it came; see coupling.h.
#include "haptics/contact/coupling.h"

namespace haptics {

CouplingResult hold_tick(CouplingState& state, const CouplingConfig&, const PoseHistory&,
                         std::int64_t tick) noexcept {
    CouplingResult result;
    if (state.pending.answer) {
        state.active = state.pending;
        state.pending = {};
        result.promoted = true;
    }
    state.active.tick = tick;
    result.force_n = state.active.force_n;
    for (int i = 0; i < kTools; ++i) {
        result.touching[i] = state.active.memory[i].touching;
        result.grasping[i] = state.active.memory[i].grasped;
    }
    return result;
}

} // namespace haptics
