#include "sim/study/coupling_study.h"

#include "sim/io/files.h"

#include <fmt/format.h>

namespace sim {
namespace {

LoadedScene scene_with(const CouplingStudyOptions& o) {
    LoadedScene loaded = load_scene(o.scene);
    loaded.organ.resize(1); // open loop: the organ under the tools, nothing else
    tissue::Material& m = loaded.scene.organ[0].material;
    if (o.friction >= 0.0)
        m.friction = o.friction;
    if (o.young_kpa > 0.0)
        m.young_pa = 1e3 * o.young_kpa;
    if (o.damping_stiffness_ms >= 0.0)
        m.damping_stiffness_s = 1e-3 * o.damping_stiffness_ms;
    return loaded;
}

std::string error_cells(const ForceError& e) {
    return fmt::format(
        "{:.3f},{:.2f},{:.1f},{:.2f},{:.1f},{:.2f},{:.2f},{:.1f},{:.1f},{:.1f},{:.1f},{},{}",
        e.peak_n, e.rms_percent, e.worst_mn, e.worst_relative_percent, e.worst_small_mn,
        e.direction_deg, e.step_p999_mn, e.step_max_mn, e.step_event_mn, e.ghost_mn, e.lost_mn,
        e.events, e.finite ? 1 : 0);
}

// The gates of the error budget: A1 force, A3 direction, A4 step.
std::string gates(const ForceError& e) {
    if (!e.finite)
        return "FAILS: not finite";
    std::string failed;
    if (e.worst_relative_percent > 7.0 || e.worst_small_mn > 35.0)
        failed += " A1";
    if (e.direction_deg > 10.0)
        failed += " A3";
    if (e.step_p999_mn > 25.0 || e.step_max_mn > 80.0)
        failed += " A4";
    return failed.empty() ? "holds" : "misses" + failed;
}

} // namespace

std::vector<CouplingRow> run_coupling_study(const CouplingStudyOptions& o,
                                            void (*progress)(const CouplingRow&)) {
    const LoadedScene loaded = scene_with(o);
    const double radius_m = loaded.scene.tool[0].tip_radius_m;
    const auto make_rig = [&](const TissueConfig& config) {
        return make_tissue(loaded, {}, config);
    };
    const TissueRig rest = make_rig({});
    std::vector<CouplingRow> rows;
    const auto note = [&](const Motion& motion, const std::string& coupling, int hz,
                          const ForceTrack& track, const ForceTrack& reference) {
        rows.push_back({motion.name, coupling, 1e3 * motion.speed_mps, hz,
                        compare(track, reference, motion.tools)});
        progress(rows.back());
    };
    for (const std::string& name : o.motions) {
        for (const double speed : o.speeds_mmps) {
            const Motion motion = make_motion(name, 1e-3 * speed, rest.bodies[0], 1e-3 * o.place_mm,
                                              o.heading, radius_m, o.depth_scale);
            const ForceTrack reference = run_monolithic(make_rig, motion, radius_m, 1);
            if (o.halve) {
                note(motion, "monolithic/2", 0, reference,
                     run_monolithic(make_rig, motion, radius_m, 2));
            }
            for (const std::string& coupling : o.couplings) {
                for (const int hz : o.fem_hz) {
                    OpenLoopOptions options;
                    options.coupling = coupling_named(coupling);
                    options.fem_hz = hz;
                    options.phase_ticks = hz >= 200 ? 2 : 7; // never in step with the motion
                    options.late_ticks = o.late_ticks;
                    options.jitter_ticks = o.jitter_ticks;
                    options.seed = o.seed;
                    note(motion, coupling, hz, run_coupled(make_rig, motion, radius_m, options),
                         reference);
                }
            }
        }
    }
    return rows;
}

void write_coupling_study(const CouplingStudyOptions& o, const std::vector<CouplingRow>& rows,
                          const std::filesystem::path& out) {
    std::filesystem::create_directories(out);
    std::string csv =
        "motion,speed_mmps,coupling,fem_hz,peak_n,rms_percent,worst_mn,worst_relative_percent,"
        "worst_small_mn,direction_deg,step_p999_mn,step_max_mn,step_event_mn,ghost_mn,lost_mn,"
        "events,finite\n";
    std::string page = fmt::format(
        "# Coupling study\n\nScene `{}`, place ({:.0f}, {:.0f}, {:.0f}) mm, depth scale {:.2f}, "
        "friction {}, answers one period + {} to {} ms late, seed {}.\nReference: the same tissue "
        "stepped in every 1 ms tick (`monolithic`); rows `monolithic/2` compare it with itself at "
        "0.5 ms.\nGates: A1 force 7 % (35 mN below 0.5 N), A3 direction 10 degrees, A4 step per "
        "tick 25 mN p99.9 and 80 mN, all outside events (contact begins or ends).\n\n"
        "| motion | mm/s | coupling | FEM Hz | peak N | rms % | worst mN | A1: % / mN | direction "
        "deg | step p99.9 / max / in events mN | ghost / lost mN | gates |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        o.scene, o.place_mm.x, o.place_mm.y, o.place_mm.z, o.depth_scale,
        o.friction < 0.0 ? "of the scene" : fmt::format("{:.2f}", o.friction), o.late_ticks,
        o.late_ticks + o.jitter_ticks, o.seed);
    for (const CouplingRow& r : rows) {
        const ForceError& e = r.error;
        csv += fmt::format("{},{:.0f},{},{},{}\n", r.motion, r.speed_mmps, r.coupling, r.fem_hz,
                           error_cells(e));
        page += fmt::format("| {} | {:.0f} | {} | {} | {:.2f} | {:.2f} | {:.0f} | {:.1f} / {:.0f} "
                            "| {:.1f} | {:.1f} "
                            "/ {:.0f} / {:.0f} | {:.0f} / {:.0f} | {} |\n",
                            r.motion, r.speed_mmps, r.coupling,
                            r.fem_hz ? fmt::format("{}", r.fem_hz) : "-", e.peak_n, e.rms_percent,
                            e.worst_mn, e.worst_relative_percent, e.worst_small_mn, e.direction_deg,
                            e.step_p999_mn, e.step_max_mn, e.step_event_mn, e.ghost_mn, e.lost_mn,
                            gates(e));
    }
    write_text(out / "coupling.csv", csv);
    write_text(out / "coupling.md", page);
}

} // namespace sim
