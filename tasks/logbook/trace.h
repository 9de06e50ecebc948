// tasks/logbook/trace.h
// What is recorded of every tick and every FEM step: integers only, so that nothing is lost in
// rounding and live, replayed and re-scored attempts see the same numbers. Poses follow from
// counts; forces are kept at 1 mN, places at 1 um.
#pragma once

#include "tasks/exercise/observation.h"

#include <cstddef>
#include <span>
#include <vector>

namespace tasks {

struct ToolTrace {
    std::array<std::int32_t, 3> counts{};
    std::int32_t roll_counts = 0, jaw_counts = 0;
    std::array<std::int32_t, 3> force_mn{};   // on the tip, as commanded after limits
    std::array<std::int32_t, 3> contact_um{}; // world; where the tip touches
    std::uint8_t flags = 0;                   // 1 touching, 2 present, 4 faulted, 8 limited,
                                              // 16 grasping
};

struct TickTrace {
    std::int64_t tick = 0;
    std::int64_t adopted_step = -1; // FEM step whose answer was taken up in this tick
    std::array<ToolTrace, kTools> tool;
};

struct StepTrace {
    std::int64_t step = 0;
    std::int64_t sample_tick = 0; // tool tick that this FEM step read
    std::int32_t duration_us = 0; // not part of the hash
    std::uint8_t flags = 0;       // 1 warped tangent used, 2 inverted elements
    int targets = 0;
    std::array<std::array<std::int32_t, 3>, kMaxTargets> target_um{};
};

/// One second of ticks (and the FEM steps adopted in it), delta-coded and compressed. The bytes
/// give back exactly what went in, except places beyond `targets`, which come back as 0. Throws
/// std::invalid_argument above 10 000 ticks or steps, or if `targets` is not in 0..kMaxTargets.
std::vector<std::byte> encode_chunk(std::span<const TickTrace> ticks,
                                    std::span<const StepTrace> steps);

struct Chunk {
    std::vector<TickTrace> ticks;
    std::vector<StepTrace> steps;
};
/// Throws std::invalid_argument on damaged bytes, saying what and where. Safe on hostile bytes:
/// takes at most about 15 MB, whatever they claim.
Chunk decode_chunk(std::span<const std::byte> bytes);

} // namespace tasks
