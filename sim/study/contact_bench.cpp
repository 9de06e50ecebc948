#include "sim/study/contact_bench.h"

#include "sim/study/bench_method.h"
#include "sim/study/mesh_sides.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace sim {
namespace {

using glm::dvec3;
using haptics::MeshView;
using haptics::SurfaceHit;

constexpr double kJudgeReach_m = 0.050; // further is free
constexpr double kSunkShare = 0.05;     // of the radius
constexpr double kSunkLeast_m = 2e-5;
constexpr int kRefitsAtRest = 9;
constexpr std::size_t kJudgedByBruteForce = 2000; // triangles

bool finite(const dvec3& v) noexcept {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void check(const ContactScene& scene) {
    if (scene.work.triangle.empty() || scene.path_m.empty())
        throw std::invalid_argument("contact bench: a mesh with triangles and a path are needed");
    for (const dvec3& p : scene.path_m)
        if (!finite(p))
            throw std::invalid_argument("contact bench: a place of the path is not finite");
}

/// One mesh in motion with one method on it.
struct Run {
    const ContactScene& scene;
    const ContactBenchOptions& options;
    const TickClock& clock;
    BenchMethod method;
    MovingSkin skin;
    MeshView mesh;
    haptics::ProxyState state;
    std::vector<double> refit_ns;
    PreemptionWatch watch;

    void begin() {
        state = {};
        refit_ns.clear();
    }
    /// The mesh of a tick; whether an index must be refitted to it.
    bool move_mesh(int tick) {
        follow(scene.work, scene.breathing, tick, skin);
        mesh = skin.view(scene.work);
        return tick == 0 || skin.moved;
    }
    void move_to(int tick) {
        if (move_mesh(tick))
            refit();
    }
    void refit() {
        const std::uint64_t from = clock.start();
        method.refit(mesh);
        refit_ns.push_back(clock.ns(from, clock.stop()));
    }
};

struct Answer {
    SurfaceHit hit; // of the query alone
    dvec3 proxy_m{0.0}, force_n{0.0};
    double ns = 0.0;
    bool preempted = false;
};

Answer timed_tick(Run& run, const dvec3& device_m) {
    const ContactBenchOptions& o = run.options;
    Answer out;
    if (!run.method.step) {
        const std::uint64_t from = run.clock.start();
        out.hit = run.method.closest(run.mesh, device_m, o.reach_m);
        out.ns = run.clock.ns(from, run.clock.stop());
        out.preempted = run.watch.preempted(out.ns);
        return out;
    }
    const haptics::ProxyInput input{device_m, o.radius_m, o.stiffness_npm, o.static_friction,
                                    o.dynamic_friction};
    const std::uint64_t from = run.clock.start();
    run.method.step(run.mesh, input, run.state);
    out.ns = run.clock.ns(from, run.clock.stop());
    out.preempted = run.watch.preempted(out.ns);
    out.proxy_m = run.state.proxy_m;
    out.force_n = run.state.force_n;
    return out;
}

/// What the nearest-point method makes of an answer.
void put_off(const ContactBenchOptions& o, const SurfaceHit& hit, const dvec3& device_m,
             bool outside, Answer& answer) {
    answer.proxy_m = device_m;
    if (!hit.hit() || hit.distance_m == 0.0)
        return;
    const dvec3 out = (outside ? 1.0 : -1.0) / hit.distance_m * (device_m - hit.place_m);
    if (outside && hit.distance_m >= o.radius_m)
        return;
    answer.proxy_m = hit.place_m + o.radius_m * out;
    answer.force_n = o.stiffness_npm * (answer.proxy_m - device_m);
}

QualityLimits limits_of(const ContactScene& scene, const ContactBenchOptions& o, bool point) {
    QualityLimits limits;
    limits.radius_m = point ? 0.0 : o.radius_m;
    limits.stiffness_npm = o.stiffness_npm;
    limits.sunk_m = std::max(kSunkShare * limits.radius_m, kSunkLeast_m);
    limits.entry_side = scene.entry_side;
    return limits;
}

/// Fills quality, ticks and sums; returns which ticks are contact ticks.
std::vector<char> judge(Run& run, std::vector<Answer>& answers, ContactBench& out) {
    const ContactScene& scene = run.scene;
    const MeshSides mesh_sides(scene.work.triangle, scene.work.rest_m.size());
    ContactJudge judge(limits_of(scene, run.options, run.method.point));
    const bool few = scene.work.triangle.size() <= kJudgedByBruteForce;
    const BenchMethod index = make_bench_method(few ? "brute-force" : "ours", "none", run.mesh);
    const NearestSkin nearest = [&](const dvec3& place_m) {
        return index.closest(run.mesh, place_m, kJudgeReach_m);
    };
    const auto side = [&](const dvec3& place_m) {
        return scene.built_in ? side_of(scene.work, run.skin.now_m, place_m)
                              : mesh_sides.side_of(run.mesh, nearest(place_m), place_m);
    };
    std::vector<char> is_contact(answers.size());
    for (std::size_t tick = 0; tick < answers.size(); ++tick) {
        if (run.move_mesh(static_cast<int>(tick)))
            index.refit(run.mesh);
        Answer& a = answers[tick];
        const dvec3& device_m = scene.path_m[tick];
        const SurfaceHit hit = nearest(device_m);
        QualityTick q{.device_m = device_m};
        q.device_side = side(device_m);
        is_contact[tick] = q.device_side != scene.entry_side ||
                           (hit.hit() && hit.distance_m <= run.options.radius_m);
        if (!run.method.step) {
            put_off(run.options, a.hit, device_m,
                    mesh_sides.side_of(run.mesh, a.hit, device_m) == 1, a);
            out.missed += is_contact[tick] && !a.hit.hit();
            out.distance_sum_m += is_contact[tick] && a.hit.hit() ? a.hit.distance_m : 0.0;
        }
        q.proxy_m = a.proxy_m;
        q.force_n = a.force_n;
        q.proxy_side = side(q.proxy_m);
        judge.add(q, nearest);
        out.tick.push_back(q);
    }
    out.quality = judge.quality();
    return is_contact;
}

/// Only ticks before which the caches were driven out are kept.
TickTimes cold_times(Run& run, const std::vector<char>& is_contact) {
    CacheEvictor evictor;
    std::vector<double> ns;
    int contacts = 0;
    run.begin();
    for (std::size_t tick = 0; tick < is_contact.size(); ++tick) {
        run.move_to(static_cast<int>(tick));
        const bool keep = is_contact[tick] && contacts++ % run.options.cold_every == 0;
        if (keep)
            evictor.evict();
        const Answer answer = timed_tick(run, run.scene.path_m[tick]);
        if (keep && !answer.preempted)
            ns.push_back(answer.ns);
    }
    return tick_times(std::move(ns));
}

} // namespace

ContactScene built_in_scene(const std::string& name, double seconds, std::uint64_t seed,
                            double radius_m, const Breathing& breathing) {
    ContactScene scene;
    scene.work = make_contact_workload(name, seed);
    scene.breathing = breathing;
    scene.path_m = contact_path(scene.work, seconds, seed, radius_m);
    return scene;
}

ContactScene recorded_scene(std::vector<dvec3> vertex_m, std::vector<haptics::Corners> triangle,
                            std::vector<dvec3> path_m) {
    ContactScene scene;
    scene.built_in = false;
    scene.work.rest_m = std::move(vertex_m);
    scene.work.triangle = std::move(triangle);
    scene.path_m = std::move(path_m);
    check(scene);
    const MeshView mesh{scene.work.rest_m, scene.work.triangle, {}};
    const auto index = haptics::make_index("brute-force", mesh);
    const dvec3& first = scene.path_m.front();
    scene.entry_side = MeshSides(mesh.triangle, mesh.vertex_m.size())
                           .side_of(mesh, haptics::closest_within(index, mesh, first, 1e3), first);
    return scene;
}

ContactScene recorded_scene(const std::string& name, std::uint64_t seed, std::vector<dvec3> path_m,
                            const Breathing& breathing) {
    ContactScene scene;
    scene.work = make_contact_workload(name, seed);
    scene.breathing = breathing;
    scene.path_m = std::move(path_m);
    check(scene);
    scene.entry_side = side_of(scene.work, scene.work.rest_m, scene.path_m.front());
    return scene;
}

ContactBench run_contact_bench(const ContactScene& scene, const ContactBenchOptions& o) {
    check(scene);
    if (!(o.reach_m > 0.0) || o.cold_every < 1)
        throw std::invalid_argument("contact bench: the reach must be above 0, cold every >= 1");
    ContactJudge(limits_of(scene, o, false)); // refuses the other numbers
    const TickClock clock;
    ContactBench out;
    out.triangles = scene.work.triangle.size();
    out.clock_overhead_ns = clock.overhead_ns();

    Run run{scene, o, clock, {}, {}, {}, {}, {}, {}};
    follow(scene.work, scene.breathing, 0, run.skin);
    run.mesh = run.skin.view(scene.work);
    const std::uint64_t from = clock.start();
    run.method = make_bench_method(o.method, o.contact, run.mesh);
    out.build_ms = 1e-6 * clock.ns(from, clock.stop());
    for (int i = 0; i < kRefitsAtRest; ++i)
        run.refit();
    out.refit_ms = 1e-6 * tick_times(run.refit_ns).p50_ns;

    std::vector<Answer> answers;
    answers.reserve(scene.path_m.size());
    run.begin();
    for (std::size_t tick = 0; tick < scene.path_m.size(); ++tick) {
        run.move_to(static_cast<int>(tick));
        answers.push_back(timed_tick(run, scene.path_m[tick]));
    }
    if (run.refit_ns.size() > 1) // it breathed
        out.refit_ms = 1e-6 * tick_times(run.refit_ns).mean_ns;

    const std::vector<char> is_contact = judge(run, answers, out);
    std::vector<double> contact_ns, free_ns;
    for (std::size_t tick = 0; tick < answers.size(); ++tick) {
        out.preempted += answers[tick].preempted;
        if (!answers[tick].preempted)
            (is_contact[tick] ? contact_ns : free_ns).push_back(answers[tick].ns);
    }
    out.contact = tick_times(std::move(contact_ns));
    out.free = tick_times(std::move(free_ns));
    if (o.cold)
        out.cold = cold_times(run, is_contact);
    return out;
}

} // namespace sim
