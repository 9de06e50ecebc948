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
    bool grasping = false; // its jaws hold tissue
    bool present = true;   // a device or hand holds this tool
};

/// The endoscope picture: a pinhole with a vertical field of view.
struct View {
    glm::dvec3 eye_m{0.0}, forward{0.0, 0.0, -1.0}, up{0.0, 1.0, 0.0};
    double field_of_view_rad = 1.2;
    double aspect = 16.0 / 9.0;
};
bool in_view(const View& view, const glm::dvec3& point_m) noexcept;

/// Distance of a point from the middle of the picture, as a share of the picture's height; infinite
/// behind the eye.
double off_centre(const View& view, const glm::dvec3& point_m) noexcept;
/// Width of a ball there, as a share of the picture's height; 0 behind the eye.
double size_in_view(const View& view, const glm::dvec3& point_m, double radius_m) noexcept;

/// Rays from the endoscope to a target's mark that are tried for whether something hides it.
inline constexpr int kSightRays = 7;

struct Target {
    glm::dvec3 position_m{0.0};       // on the deformed surface
    glm::dvec3 normal{0.0, 0.0, 1.0}; // of the rest surface there
    int clear_rays = 0;               // of kSightRays: nothing between it and the endoscope
};

struct Observation {
    std::int64_t tick = 0; // 1 ms each, 0 = start of the attempt
    std::array<ToolObservation, kTools> tool;
    std::array<Target, kMaxTargets> target;
    int targets = 0; // find-tubes: the place to lift is one more, after the tubes
    View view;
    bool scope_present = false; // false: the picture is fixed
    double horizon_rad = 0.0;   // turn of the picture against a level one
    double stress_pa = 0.0;     // largest von Mises stress in the tissue
};

inline constexpr double kTick_s = 1e-3;

} // namespace tasks
