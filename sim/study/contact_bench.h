// sim/study/contact_bench.h
// Times and quality of one contact method over one path: what `trocar bench contact` and the
// scaling study measure. Single-threaded; reads clocks; opens no file. Metres, newtons, world
// frame.
#pragma once

#include "sim/study/contact_quality.h"
#include "sim/study/contact_workload.h"
#include "sim/study/tick_times.h"

namespace sim {

/// A mesh, how it moves, where the device goes, and who knows on which side a place is.
struct ContactScene {
    ContactWorkload work;           // of a mesh file: vertices and triangles only, no cells
    bool built_in = true;           // false: sides by the nearest point's pseudonormal
    Breathing breathing;            // built-in meshes only
    std::vector<glm::dvec3> path_m; // of the ball's centre, one place per millisecond
    int entry_side = 1;
};

/// A built-in mesh with its own path.
ContactScene built_in_scene(const std::string& name, double seconds, std::uint64_t seed,
                            double radius_m, const Breathing& breathing);
/// Any closed mesh wound outward with a recorded path. The entry side is the one on which the path
/// begins. Throws std::invalid_argument for an empty mesh or path, or what is not finite.
ContactScene recorded_scene(std::vector<glm::dvec3> vertex_m,
                            std::vector<haptics::Corners> triangle, std::vector<glm::dvec3> path_m);
/// A built-in mesh under a recorded path.
ContactScene recorded_scene(const std::string& name, std::uint64_t seed,
                            std::vector<glm::dvec3> path_m, const Breathing& breathing);

struct ContactBenchOptions {
    std::string method = "brute-force", contact = "none"; // see bench_method.h
    double radius_m = 0.002;
    double reach_m = 0.010; // of the query alone: what is further is not looked for
    double stiffness_npm = 500.0;
    double static_friction = 0.0, dynamic_friction = 0.0;
    bool cold = false;
    int cold_every = 20; // of the contact ticks
};

struct ContactBench {
    std::size_t triangles = 0;
    /// By what the device did in that tick: contact if its centre is not on the entry side or
    /// within the radius of the skin. cold: contact ticks before which the caches were driven out.
    TickTimes contact, free, cold;
    int preempted = 0; // hot ticks left out of the times, as another got the processor
    double build_ms = 0.0;
    double refit_ms = 0.0; // mean over the frames of the run; at rest: median of nine
    ContactQuality quality;
    double distance_sum_m = 0.0; // query alone: of its answers over the contact ticks
    int missed = 0;              // query alone: contact ticks without an answer
    double clock_overhead_ns = 0.0;
    std::vector<QualityTick> tick; // what was commanded and answered
};

/// The path is run once for the times (a tick of "none" is the query, of others the whole step),
/// once untimed for the quality, so that the judge's queries warm no cache of the timed ones, and
/// once more for the cold times if asked. The query alone is judged as the nearest-point method: a
/// ball that is too deep is put a radius off the nearest skin. The judge's own nearest skin is
/// found by brute force up to 2000 triangles, by "ours" beyond. A method that treats the ball as a
/// point is judged with radius 0. Throws std::invalid_argument on unknown names and bad numbers.
ContactBench run_contact_bench(const ContactScene& scene, const ContactBenchOptions& options);

} // namespace sim
