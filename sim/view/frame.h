// sim/view/frame.h
// One picture of the running world: what the render loop fills in and Window::draw() shows.
// Pure data; the view knows no tissue model, no thread of ours, no clock and no log.
// World frame: x to the picture's right, y up, z towards the camera. Called in the render thread.
#pragma once

#include "sim/view/tissue_look.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace view {

/// In the order of tool indices everywhere else. Colour, shape and letter on the screen:
/// left: blue circle L, right: orange triangle R, assist: teal square A, scope: violet diamond E.
enum class Role : std::uint8_t { left, right, assist, scope };
inline constexpr int kTools = 3;

/// A deforming surface; triangles are counter-clockwise seen from outside, their backs not drawn.
/// `triangles` and `rest_m` must stay the same (address and content) for as long as `id` does: they
/// are uploaded once. The other two are read in every draw() and may be gone afterwards. All vertex
/// arrays have the same length; an empty surface draws nothing.
struct SurfaceView {
    int id = 0; // unique per surface and attempt: give new ids to a new scene
    Look look = Look::tissue;
    std::span<const std::array<std::uint32_t, 3>> triangles;
    std::span<const glm::vec3> rest_m;     // undeformed: carries the colour pattern
    std::span<const glm::vec3> position_m; // now
    std::span<const glm::vec3> normal;     // outward, unit
};

struct ToolView {
    Role role = Role::left;
    bool present = false;   // false: not drawn, no force bar
    bool active = false;    // the one that mouse and keys move
    bool assistant = false; // moved by the scripted assistant
    bool faulted = false;   // device fault: no force
    glm::dvec3 tip_m{0.0};  // centre of the tip sphere
    glm::dvec3 fulcrum_m{0.0};
    glm::dvec3 direction{0.0, 0.0, -1.0}; // unit, handle to tip
    double roll_rad = 0.0;
    double jaw = 0.0; // 0 open .. 1 closed
    double tip_radius_m = 3e-3;
    bool touching = false;
    glm::dvec3 force_n{0.0}; // on the tip, world
    double felt_share = 1.0; // 0 limp .. 1 full force reaches the hand
};

/// The endoscope, through which the picture is seen; if it is not held it is on a mount.
struct ScopeView {
    bool present = false;   // false: the picture is fixed, no panel
    bool active = false;    // mouse and keys move it
    bool assistant = false; // moved by the scripted assistant
    bool faulted = false;
    double horizon_rad = 0.0; // turn of the picture against a level one
};

enum class TargetState : std::uint8_t { waiting, next, done };

struct TargetView {
    int number = 1; // ignored by a place to lift
    Role role = Role::left;
    TargetState state = TargetState::waiting;
    glm::dvec3 position_m{0.0}; // on the surface now
    glm::dvec3 normal{0.0, 0.0, 1.0};
    double radius_m = 3e-3;  // tolerance of the exercise; drawn never smaller than 3 mm
    double hold_share = 0.0; // 0..1 of the holding time, for the next target
    bool lift = false;       // a place to lift: the role's letter below an arrow, not a number
    bool buried = false;     // lies under tissue that will be moved: nothing shows it through
};

/// A curve on the surface that has to be drawn along: places in order, close enough to each other
/// to look smooth. Empty: none.
struct PathView {
    Role role = Role::right;
    std::vector<glm::dvec3> place_m, normal; // on the surface now; unit
    double radius_m = 4e-3;                  // the exercise's corridor
    double done = 0.0;                       // share of the places, 0..1
};

struct Camera {
    glm::dvec3 eye_m{0.0, -0.075, 0.19};
    glm::dvec3 look_at_m{0.0, 0.0, 0.01};
    glm::dvec3 up{0.0, 1.0, 0.0};
    double field_of_view_deg = 55.0; // vertical
};

/// What the exercise allows; the force bars show it. A band of no width is none.
struct ForceLimits {
    double band_min_n = 0.1;
    double band_max_n = 1.0;
    double limit_n = 2.0;
};

enum class Recorder : std::uint8_t { off, recording, fault };

/// Counters only: while an attempt is live no score is shown.
struct ViewFrame {
    std::vector<SurfaceView> surfaces;
    std::array<ToolView, kTools> tools;
    ScopeView scope;
    std::vector<TargetView> targets;
    PathView path;
    Camera camera;
    ForceLimits force;
    double ring_share = 0.0;   // radius of the zone that counts, of the picture's height; 0: none
    std::string hint;          // what to do now, beside the next target; empty: its tool
    double time_s = 0.0;       // of the attempt: the timer, and the beat of the pulsing ring
    double time_limit_s = 0.0; // 0: none shown
    int errors = 0;
    bool forces_on = true; // false: says so in large letters, with the key that brings them back
    bool felt = true;      // false: nobody at these tools can feel (mouse): bars read "not felt"
    Recorder recorder = Recorder::off;
    std::string trainee;               // shown as is; empty: nobody
    std::vector<std::string> messages; // faults, "never run on hardware", ...; newest last
};

} // namespace view
