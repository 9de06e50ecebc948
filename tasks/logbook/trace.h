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

/// The endoscope: where its handle is, and how camera head and optic are turned. All zero in a
/// scene whose picture is fixed, and in recordings of before there was one.
struct ScopeTrace {
    std::array<std::int32_t, 3> counts{};
    std::int32_t camera_counts = 0; // camera head, about the shaft
    std::int32_t optic_counts = 0;  // optic, against the camera head
    std::uint8_t flags = 0;         // 2 present, 4 faulted, 8 held by the assistant, 16 by a mount
};

struct TickTrace {
    std::int64_t tick = 0;
    std::int64_t adopted_step = -1; // FEM step whose answer was taken up in this tick
    std::array<ToolTrace, kTools> tool;
    ScopeTrace scope;
};

struct StepTrace {
    std::int64_t step = 0;
    std::int64_t sample_tick = 0; // tool tick that this FEM step read
    std::int32_t duration_us = 0; // not part of the hash
    std::uint8_t flags = 0;       // 1 warped tangent used, 2 inverted elements
    std::int32_t stress_pa = 0;   // largest von Mises stress in any tissue
    int targets = 0;
    std::array<std::array<std::int32_t, 3>, kMaxTargets> target_um{};
    std::array<std::uint8_t, kMaxTargets> clear_rays{}; // from the endoscope to each, of kSightRays
};

/// One second of ticks (and the FEM steps adopted in it), delta-coded and compressed. The bytes
/// give back exactly what went in, except targets beyond `targets`, which come back as 0. Throws
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
