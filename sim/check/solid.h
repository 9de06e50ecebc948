// sim/check/solid.h
// The bodies of a scene at rest, for questions of geometry: inside or not, how near, what is in
// the way. Called when a scene or an exercise is checked; not real time.
#pragma once

#include "haptics/device/trocar.h"
#include "sim/session/scene.h"

namespace sim {

struct Solid {
    tissue::BoundaryTree skin;
    bool closed = true; // false: scenery with an inner and an outer side, the wall
    // of an open surface: vertices on its rim, and per triangle which edges are (bit k: opposite
    // corner k)
    std::vector<std::uint8_t> rim_vertex, rim_edges;
    glm::dvec3 low_m{0.0}, high_m{0.0};
    std::vector<glm::dvec3> sample_m; // vertices of the skin, middles of the tetrahedra
};

/// One for each organ. A soft organ whose skin is open is seen by the boundary of its tetrahedra.
std::vector<Solid> make_solids(const LoadedScene& scene);

/// How far a place is inside a body, or behind an open surface; 0 outside.
double depth_in_m(const Solid& solid, const glm::dvec3& place_m);

/// The deepest that the samples of `a` lie in `b` or those of `b` in `a`: what pokes through
/// between the vertices of a skin, a few millimetres apart, is not seen.
struct Overlap {
    double depth_m = 0.0; // 0: none
    glm::dvec3 place_m{0.0};
};
Overlap overlap_of(const Solid& a, const Solid& b);

/// Instruments of 5 mm.
inline constexpr double kShaftRadius_m = 2.5e-3;

/// What a shaft meets on its way from the port to a tip whose centre is at `tip_m`: its axis and
/// 2.5 mm around it against other bodies, the axis alone against the body `touched` (-1: none),
/// which it may lie along. The first 20 mm are in the port and free. Body `lifted` is out of the
/// way.
struct Obstacle {
    int body = -1; // -1: none
    glm::dvec3 place_m{0.0};
};
Obstacle shaft_obstacle(std::span<const Solid> solids, const haptics::Trocar& trocar,
                        const glm::dvec3& tip_m, int touched, int lifted = -1);

/// What hides a place on a skin, with outward normal `normal`, from the eye: any body, its own too,
/// but one that is `lifted` out of the way.
Obstacle sight_obstacle(std::span<const Solid> solids, const glm::dvec3& eye_m,
                        const glm::dvec3& place_m, const glm::dvec3& normal, int lifted = -1);

} // namespace sim
