// tasks/exercise/observation.h
// What an exercise sees of one millisecond, and nothing else. Live, headless, replay and re-score
// all build it from the same recorded integers (tasks/logbook/trace.h), so they agree exactly.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string_view>

namespace tasks {

inline constexpr int kTools = 3;
inline constexpr int kMaxTargets = 16;

enum class Role : std::uint8_t { left, right, assist, scope };
std::string_view role_name(Role role) noexcept;

struct ToolObservation {
    glm::dvec3 tip_m{0.0};            // centre of the tip sphere, world
    glm::dvec3 shaft{0.0, 0.0, -1.0}; // unit, handle to tip
    double insertion_m = 0.0;
    double roll_rad = 0.0;
    double jaw = 0.0;          // 0 open .. 1 closed
    glm::dvec3 force_n{0.0};   // on the tip, by tissue or scenery
    glm::dvec3 contact_m{0.0}; // where the tip touches, world; only if touching
    bool touching = false;
    bool present = true; // a device or hand holds this tool
};

/// The endoscope picture: a pinhole with a vertical field of view.
struct View {
    glm::dvec3 eye_m{0.0}, forward{0.0, 0.0, -1.0}, up{0.0, 1.0, 0.0};
    double field_of_view_rad = 1.2;
    double aspect = 16.0 / 9.0;
};
bool in_view(const View& view, const glm::dvec3& point_m) noexcept;

struct Target {
    glm::dvec3 position_m{0.0};       // on the deformed surface
    glm::dvec3 normal{0.0, 0.0, 1.0}; // of the rest surface there
};

struct Observation {
    std::int64_t tick = 0; // 1 ms each, 0 = start of the attempt
    std::array<ToolObservation, kTools> tool;
    std::array<Target, kMaxTargets> target;
    int targets = 0;
    View view;
};

inline constexpr double kTick_s = 1e-3;

} // namespace tasks
