// haptics/contact/safe_tools.h
// Our contact method for whole instruments: shafts as well as tips, up to three of them, on a
// triangle mesh that may move under them and on each other, with Coulomb friction. It is
// safe_proxy.h grown from a ball to what pivots about a trocar. For whoever feels a mesh with
// instruments at 1 kHz; nothing is allocated, thrown or waited for.
//
// A tool pivots about a fixed point P. Its state is its tip's centre c: three unknowns. The shaft
// is a capsule from P to c, the tip a ball at c. If a plane n . x = h has all of a triangle, grown
// by the shaft's radius, behind it, and P and c in front of it, the whole shaft is in front of it,
// and so it is on every straight way of c that stays there: P, the start and the end of c span a
// triangle, and all three corners are in front. At the touch P is in front, so what is left is a
// half-space for c, as for a ball. Planes of tips and of shafts then go into the same problem
// (plane_qp.h), and a path is taken only if swept capsules and balls meet nothing on it.
//
// Another tool is a triangle without area, as thick as its shaft or tip; while one tool moves the
// others are at rest, so no state in between overlaps. Where two touch and are pressed together,
// the contact moves to where both springs push equally: displacements w along the normal, with
// stiffness k / lever^2 there, give the mean weighted by stiffness. The tool that gives way goes
// first, to there, the other follows. With more contacts than one this is one pass of
// Gauss-Seidel in a tick, from the forces of the last.
// The mesh moves one tool at a time as well: a tool that it squeezes against another, which stands
// still in that tick, goes where it is least in the way, and may be passed there. Nothing gives
// way at a pivot: tissue that comes at a shaft nearer to it than a tenth may get in.
//
// Of a contact at `lever` the tip feels lever times the force (virtual work). Friction acts in the
// tip's space: across the shaft that is Coulomb's cone, along it, by 1 / lever inside it.
// Subgoals and planes: Ruspini, Kolarov and Khatib 1997.
#pragma once

#include "haptics/collision/index.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

namespace haptics {

inline constexpr int kMostTools = 3;
inline constexpr int kMostToolContacts = 8;

/// P, tip and shaft; a tool that is started keeps them.
struct ToolShape {
    glm::dvec3 pivot_m{0.0};
    double tip_radius_m = 0.0;   // from 0
    double shaft_radius_m = 0.0; // 0: the tip only
};

struct ToolInput {
    glm::dvec3 device_m{0.0}; // where the tip would be if nothing were in the way
    ToolShape shape;
    double stiffness_npm = 500.0;
    double static_friction = 0.0, dynamic_friction = 0.0; // Coulomb coefficients
};

enum class ToolPart : std::uint8_t { tip, shaft };

struct ToolTouch {
    ToolPart part = ToolPart::tip;
    double lever = 1.0;                  // where on the shaft: 0 the pivot, 1 the tip
    int tool = -1;                       // the other one; -1: the mesh, and there
    std::uint32_t triangle = kNoSurface; // which triangle
    glm::dvec3 weight{0.0};              // and where on it
    glm::dvec3 normal{0.0};              // unit, to this tool
};

struct ToolState {
    bool started = false; // false: the next tick sets the tip where the device is
    bool touching = false;
    bool sliding = false; // touching and beyond static friction
    glm::dvec3 tip_m{0.0};
    glm::dvec3 force_n{0.0}; // on the device, at the tip
    int contacts = 0;
    std::array<ToolTouch, kMostToolContacts> contact{};
    // how far it came in the last tick, how far off a surface it rests, where the device was
    double step_m = 0.0, hover_m = 0.0;
    double room_m = HUGE_VAL; // this far around there was room for all that it may meet
    glm::dvec3 device_m{0.0};
    ToolShape shape;
};

struct ToolsState {
    std::array<ToolState, kMostTools> tool;
};

/// One tick. At most kMostTools; those of the state for which there is no input are forgotten.
/// They have to start apart from the mesh and from each other. A tool whose input is not finite
/// gets no force and stays where it is, in the way of the others.
void step_safe_tools(const CollisionIndex& index, const MeshView& mesh,
                     std::span<const ToolInput> in, ToolsState& state) noexcept;

} // namespace haptics
