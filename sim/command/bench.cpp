// trocar bench contact MESH: times and quality of one contact method over one path, as one JSON
// object or a table; the force per tick as CSV.
#include "sim/command/commands.h"
#include "sim/io/files.h"
#include "sim/io/mesh_file.h"
#include "sim/io/trajectory_file.h"
#include "sim/study/bench_method.h"
#include "sim/study/contact_bench.h"
#include "sim/study/tick_times_json.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace sim {
namespace {

using nlohmann::ordered_json;

constexpr double kMostRadius_m = 0.1; // millimetres given by mistake are above it

struct BenchArguments {
    ContactBenchOptions options;
    std::string mesh, trajectory, unit = "m", wave = "radial", forces;
    double breathe_mm = 0.0, seconds = 10.0;
    std::uint64_t seed = 1;
    bool json = false;
};

ContactScene scene_of(const BenchArguments& a) {
    const Breathing breathing{1e-3 * a.breathe_mm, wave_of(a.wave)};
    const bool built_in = is_contact_workload(a.mesh);
    if (!built_in && a.trajectory.empty())
        throw std::invalid_argument("bench contact: a mesh file needs --trajectory CSV; organ:10k "
                                    "and sheet:10k have a path of their own");
    if (!built_in && a.breathe_mm != 0.0)
        throw std::invalid_argument("bench contact: --breathe: only organ:COUNT and sheet:COUNT "
                                    "breathe");
    if (a.trajectory.empty())
        return built_in_scene(a.mesh, a.seconds, a.seed, a.options.radius_m, breathing);
    auto path_m = at_ticks(read_trajectory(read_bytes(a.trajectory), a.trajectory));
    if (built_in)
        return recorded_scene(a.mesh, a.seed, std::move(path_m), breathing);
    TriangleMesh mesh = read_mesh(read_bytes(a.mesh), a.mesh, unit_m_of(a.unit));
    return recorded_scene(std::move(mesh.vertex_m), std::move(mesh.triangle), std::move(path_m));
}

ordered_json bench_json(const BenchArguments& a, const ContactBench& b) {
    const ContactQuality& q = b.quality;
    return {{"mesh", a.mesh},
            {"method", a.options.method},
            {"contact_method", a.options.contact},
            {"triangles", b.triangles},
            {"contact", tick_times_json(b.contact)},
            {"free", tick_times_json(b.free)},
            {"cold", tick_times_json(b.cold)},
            {"build_ms", b.build_ms},
            {"refit_ms", b.refit_ms},
            {"lost", q.lost},
            {"stuck", q.stuck},
            {"wrong_side", q.wrong_side},
            {"max_force_step_n", q.max_force_step_n},
            {"sunk", q.sunk},
            {"bad", q.bad},
            {"ticks", q.ticks},
            {"contact_ticks", q.contact_ticks},
            {"deepest_m", q.deepest_m},
            {"largest_lag_m", q.largest_lag_m},
            {"longest_stuck_ms", q.longest_stuck_ticks},
            {"max_force_n", q.max_force_n},
            {"distance_sum_m", b.distance_sum_m},
            {"missed", b.missed},
            {"probe_radius_m", a.options.radius_m},
            {"reach_m", a.options.reach_m},
            {"breathe_m", 1e-3 * a.breathe_mm},
            {"wave", a.wave},
            {"seed", a.seed},
            {"preempted", b.preempted},
            {"clock_overhead_ns", b.clock_overhead_ns}};
}

std::string bench_table(const BenchArguments& a, const ContactBench& b) {
    const ContactQuality& q = b.quality;
    std::string out =
        fmt::format("{}  {} triangles  method {}  contact {}  ball {} mm\n", a.mesh, b.triangles,
                    a.options.method, a.options.contact, 1e3 * a.options.radius_m);
    const auto row = [&](const char* name, const TickTimes& t) {
        out += fmt::format("  {:<8} {:>6} ticks  mean {:>8.0f} ns  p50 {:>8.0f}  p99 {:>8.0f}  "
                           "p99.99 {:>8.0f}  max {:>8.0f}\n",
                           name, t.n, t.mean_ns, t.p50_ns, t.p99_ns, t.p9999_ns, t.max_ns);
    };
    row("contact", b.contact);
    row("free", b.free);
    if (a.options.cold)
        row("cold", b.cold);
    out += fmt::format("  every time includes {:.0f} ns of the clock; {} ticks left out, as others "
                       "got the processor\n  build {:.2f} ms, refit "
                       "{:.3f} ms\n",
                       b.clock_overhead_ns, b.preempted, b.build_ms, b.refit_ms);
    out += fmt::format("  of {} contact ticks: lost {}, sunk {}, wrong side {}, stuck {}\n  "
                       "largest force step {:.3f} N, force {:.2f} N (at 500 N/m)\n",
                       q.contact_ticks, q.lost, q.sunk, q.wrong_side, q.stuck, q.max_force_step_n,
                       q.max_force_n);
    return out;
}

std::string forces_csv(const ContactBench& b) {
    std::string out = "t,x,y,z,proxy_x,proxy_y,proxy_z,force_x,force_y,force_z\n";
    for (std::size_t tick = 0; tick < b.tick.size(); ++tick) {
        const QualityTick& t = b.tick[tick];
        out += fmt::format("{:.3f}", 1e-3 * static_cast<double>(tick));
        for (const glm::dvec3& v : {t.device_m, t.proxy_m, t.force_n})
            out += fmt::format(",{:.9g},{:.9g},{:.9g}", v.x, v.y, v.z);
        out += '\n';
    }
    return out;
}

void bench_contact(BenchArguments& a) {
    if (!(a.options.radius_m >= 0.0 && a.options.radius_m <= kMostRadius_m))
        throw std::invalid_argument(
            fmt::format("bench contact: --probe-radius {}: accepted: metres, from 0 to {}",
                        a.options.radius_m, kMostRadius_m));
    const ContactBench bench = run_contact_bench(scene_of(a), a.options);
    if (!a.forces.empty())
        write_text(a.forces, forces_csv(bench));
    fmt::print("{}", a.json ? bench_json(a, bench).dump() + "\n" : bench_table(a, bench));
}

} // namespace

void add_bench(CLI::App& app, int&) {
    CLI::App* bench = app.add_subcommand("bench", "How fast and how well something works");
    bench->require_subcommand(1);
    CLI::App* c = bench->add_subcommand("contact", "Contact of a ball with a triangle mesh");
    auto a = std::make_shared<BenchArguments>();
    ContactBenchOptions& o = a->options;
    c->add_option(
         "mesh", a->mesh,
         "STL, OBJ, PLY or OFF file, closed and wound outward; or organ:COUNT, sheet:COUNT "
         "(10k, 1M, ...)")
        ->required();
    c->add_option("--trajectory", a->trajectory, "CSV with t, x, y, z (s, m) of the ball's centre");
    c->add_option("--method", o.method,
                  fmt::format("{}", fmt::join(haptics::kCollisionNames, ", ")));
    c->add_option("--contact", o.contact, fmt::format("{}", fmt::join(kContactNames, ", ")));
    c->add_option("--probe-radius", o.radius_m, "Of the ball, m");
    c->add_option("--unit", a->unit, "Of a mesh file: mm, cm, m");
    c->add_option("--reach", o.reach_m, "Of the query alone, m: its initial radius");
    c->add_option("--stiffness", o.stiffness_npm, "N/m");
    c->add_option("--static-friction", o.static_friction, "Coulomb coefficient");
    c->add_option("--dynamic-friction", o.dynamic_friction, "Coulomb coefficient");
    c->add_option("--breathe", a->breathe_mm, "Amplitude of a built-in mesh at 1 Hz, mm");
    c->add_option("--wave", a->wave, "How it breathes: radial, travelling");
    c->add_option("--seconds", a->seconds, "Of the built-in path");
    c->add_option("--seed", a->seed, "Of built-in mesh and path");
    c->add_flag("--cold", o.cold, "Also times with the caches driven out before");
    c->add_option("--cold-every", o.cold_every, "Before every how manyth contact tick");
    c->add_option("--forces", a->forces, "CSV of device, proxy and force in every tick");
    c->add_flag("--json", a->json, "One JSON object instead of a table");
    c->callback([a] { bench_contact(*a); });
}

} // namespace sim
