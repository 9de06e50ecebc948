// sim/study/failure_bench.h
// What the failure scenes are made of: a small mesh that may move, a ball led over it by any
// contact method, a free device under a force, and rows. Units: SI, world frame.
#pragma once

#include "sim/study/failures_study.h"

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <random>

namespace sim::failure {

using glm::dvec3;

inline constexpr double kTick_s = 1e-3;
inline constexpr double kPi = 3.14159265358979323846;

/// The rows so far, and the ways to add one.
struct Rows {
    std::vector<FailureRow> row;
    /// Right is `measured <= bound`; a method of which wrong is expected has to exceed it.
    void at_most(std::string scene, std::string_view method, std::string quantity, double measured,
                 double bound, bool wrong_expected);
    /// Theory says `value`: right and wrong behaviour alike have to be within the tolerance.
    void near(std::string scene, std::string_view method, std::string quantity, double measured,
              double value, double tolerance, bool wrong_expected);
};

struct Scene {
    std::vector<dvec3> vertex, before;
    std::vector<haptics::Corners> triangle;
    haptics::CollisionIndex index;
    haptics::ProxyInput input;
    haptics::ProxyState state;

    /// Corners counterclockwise as seen from outside.
    void quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d);
    /// Closed, faces out.
    void box(const dvec3& low, const dvec3& high);
    /// After the last quad, before the first tick.
    void ready();
    /// The mesh jumps there; told to the next tick as the motion of that interval.
    void move_to(const std::vector<dvec3>& vertices);
    const haptics::ProxyState& tick(const ContactMethod& method, const dvec3& device_m);
};

/// Radius to give to a method.
inline double ball_m(const ContactMethod& method, double radius_m) {
    return method.ball ? radius_m : 0.0;
}

/// A device along one axis, m x'' + b x' = force held over a tick: exact.
struct FreeAxis {
    double place_m = 0.0, speed_mps = 0.0;
    double mass_kg = 0.1, damping_nspm = 0.5;
    void step(double force_n);
};

/// The largest value for which `holds` is true, between one for which it is and one for which it
/// is not, to a relative 1e-3.
double bisect(double holds_at, double fails_at, const std::function<bool(double)>& holds);

struct Random {
    std::mt19937_64 engine;
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }
    double normal() { return std::normal_distribution<double>()(engine); }
};

// The scenes, one group per file. Each adds rows for one method; what has none, for itself.
void plate(const ContactMethod& method, std::uint64_t seed, Rows& rows);         // F1
void voronoi(const ContactMethod& method, std::uint64_t seed, Rows& rows);       // F2
void cracks(const ContactMethod& method, std::uint64_t seed, Rows& rows);        // F3
void moving(const ContactMethod& method, std::uint64_t seed, Rows& rows);        // F4
void concave(const ContactMethod& method, std::uint64_t seed, Rows& rows);       // F5
void wedge(const ContactMethod& method, std::uint64_t seed, Rows& rows);         // F6
void friction(const ContactMethod& method, std::uint64_t seed, Rows& rows);      // F7
void membrane(const ContactMethod& method, std::uint64_t seed, Rows& rows);      // F8
void projections(std::uint64_t seed, Rows& rows);                                // F5
void stale_plane(std::uint64_t seed, Rows& rows);                                // F6
void signum_friction(std::uint64_t seed, Rows& rows);                            // F7
void inverted_tets(std::uint64_t seed, Rows& rows);                              // F9
void inverted_baselines(Rows& rows);                                             // F9, its part
void locking(std::uint64_t seed, Rows& rows);                                    // F10
void explicit_steps(std::uint64_t seed, Rows& rows);                             // F11
void taut_strings(std::uint64_t seed, Rows& rows);                               // F12
void stiffness_by_iterations(std::uint64_t seed, Rows& rows);                    // F13
void rigid_turns(std::uint64_t seed, Rows& rows);                                // F14
void pinched_sheet(const ContactMethod& method, std::uint64_t seed, Rows& rows); // F18
void pinched_flap(std::uint64_t seed, Rows& rows);                               // F18
void rigid_clusters(std::uint64_t seed, Rows& rows);                             // F16
void rigid_depths(std::uint64_t seed, Rows& rows);                               // F17

} // namespace sim::failure
