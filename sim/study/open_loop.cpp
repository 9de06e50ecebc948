#include "sim/study/open_loop.h"

#include "sim/loop/tissue_loop.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <random>

namespace sim {
namespace {

std::array<glm::dvec3, kTools> forces_of(const TissueRig& rig) {
    std::array<glm::dvec3, kTools> out;
    for (int i = 0; i < kTools; ++i)
        out[i] = rig.contact[i].force_n;
    return out;
}

struct Flight {
    std::int64_t arrives;
    std::unique_ptr<TissueAnswer> answer;
};

} // namespace

// Tools held without a lever: the tip is the handle. Jaws are open or fully closed.
ToolsNow tools_at(std::int64_t tick, const Motion& motion,
                  const std::array<glm::dvec3, kTools>& tip_m, double tip_radius_m) {
    ToolsNow now;
    now.tick = tick;
    for (int i = 0; i < kTools; ++i)
        now.tip[i] = {tip_m[i], tip_radius_m};
    if (motion.jaw_closes >= 0 && tick >= motion.jaw_closes && tick < motion.jaw_opens) {
        const auto closed = static_cast<std::size_t>(motion.jaw_closes);
        now.tip[0].grip = haptics::next_grip({}, {}, 1.0, motion.tip_m[closed][0]);
    }
    return now;
}

ForceTrack run_monolithic(const std::function<TissueRig(const TissueConfig&)>& make_rig,
                          const Motion& motion, double tip_radius_m, int substeps) {
    TissueConfig config;
    config.step_s = kTick_s / substeps;
    config.basis = false;
    config.relinearise_m = 0.0;
    TissueRig rig = make_rig(config);
    auto answer = std::make_unique<TissueAnswer>();
    ForceTrack track(motion.tip_m.size());
    for (std::size_t i = 0; i < motion.tip_m.size(); ++i) {
        for (int s = 1; s <= substeps; ++s) {
            const double part = static_cast<double>(s) / substeps;
            std::array<glm::dvec3, kTools> tip = motion.tip_m[i];
            for (int t = 0; t < kTools && i > 0; ++t) {
                tip[t] = motion.tip_m[i - 1][t] + part * (tip[t] - motion.tip_m[i - 1][t]);
            }
            tissue_step(rig, tools_at(static_cast<std::int64_t>(i), motion, tip, tip_radius_m),
                        *answer);
        }
        track[i] = forces_of(rig);
    }
    return track;
}

ForceTrack run_coupled(const std::function<TissueRig(const TissueConfig&)>& make_rig,
                       const Motion& motion, double tip_radius_m, const OpenLoopOptions& options) {
    const int period = static_cast<int>(std::lround(1.0 / (options.fem_hz * kTick_s)));
    TissueConfig config;
    config.step_s = period * kTick_s;
    TissueRig rig = make_rig(config);
    haptics::CouplingState state;
    haptics::CouplingConfig coupling;
    coupling.period_ticks = period;
    if (!options.ease)
        coupling.ease_above_n = 1e9;
    haptics::PoseHistory history;
    std::mt19937_64 random(options.seed);

    std::deque<Flight> flights;
    std::unique_ptr<TissueAnswer> active, pending; // what the coupling still looks at
    ForceTrack track(motion.tip_m.size());
    for (std::size_t i = 0; i < motion.tip_m.size(); ++i) {
        const auto tick = static_cast<std::int64_t>(i);
        const ToolsNow now = tools_at(tick, motion, motion.tip_m[i], tip_radius_m);
        history.push(tick, now.tip);
        if (!flights.empty() && flights.front().arrives <= tick && !pending) {
            pending = std::move(flights.front().answer);
            flights.pop_front();
            haptics::adopt(state, pending->local);
        }
        const auto step =
            options.coupling == Coupling::hold ? haptics::hold_tick : haptics::anchored_tick;
        const haptics::CouplingResult result = step(state, coupling, history, tick);
        if (result.promoted)
            active = std::move(pending);
        track[i] = result.force_n;
        if ((tick + options.phase_ticks) % period == 0) {
            Flight flight{tick + period + options.late_ticks, std::make_unique<TissueAnswer>()};
            if (options.jitter_ticks > 0) {
                flight.arrives += static_cast<std::int64_t>(
                    random() % static_cast<std::uint64_t>(options.jitter_ticks + 1));
            }
            if (!flights.empty())
                flight.arrives = std::max(flight.arrives, flights.back().arrives);
            tissue_step(rig, now, *flight.answer);
            flights.push_back(std::move(flight));
        }
    }
    return track;
}

ForceError compare(const ForceTrack& track, const ForceTrack& reference, int tools) {
    ForceError out;
    const std::size_t n = reference.size();
    for (int t = 0; t < tools; ++t) {
        for (const auto& f : reference)
            out.peak_n = std::max(out.peak_n, glm::length(f[t]));
    }
    std::vector<double> steps;
    double square = 0.0;
    for (int t = 0; t < tools; ++t) {
        std::vector<char> event(n, 0);
        for (std::size_t i = 1; i < n; ++i) {
            const bool begins =
                (glm::length(reference[i][t]) > 0) != (glm::length(reference[i - 1][t]) > 0);
            const bool ours = (glm::length(track[i][t]) > 0) != (glm::length(track[i - 1][t]) > 0);
            if (!begins && !ours)
                continue;
            out.events += begins;
            for (std::size_t k = i >= 2 ? i - 2 : 0; k < std::min(n, i + 7); ++k)
                event[k] = 1;
        }
        for (std::size_t i = 0; i < n; ++i) {
            const glm::dvec3 f = track[i][t], r = reference[i][t];
            if (!std::isfinite(f.x + f.y + f.z)) {
                out.finite = false;
                continue;
            }
            const double error_n = glm::distance(f, r);
            const double length = glm::length(r);
            square += error_n * error_n;
            out.worst_mn = std::max(out.worst_mn, 1e3 * error_n);
            if (length == 0.0)
                out.ghost_mn = std::max(out.ghost_mn, 1e3 * glm::length(f));
            if (glm::length(f) == 0.0)
                out.lost_mn = std::max(out.lost_mn, 1e3 * length);
            if (event[i])
                continue;
            if (length > 0.5) {
                out.worst_relative_percent =
                    std::max(out.worst_relative_percent, 100.0 * error_n / length);
            } else {
                out.worst_small_mn = std::max(out.worst_small_mn, 1e3 * error_n);
            }
            if (length > 0.1 && glm::length(f) > 0.1) {
                const double c = glm::dot(f, r) / (length * glm::length(f));
                out.direction_deg =
                    std::max(out.direction_deg, glm::degrees(std::acos(std::clamp(c, -1.0, 1.0))));
            }
        }
        for (std::size_t i = 1; i < n; ++i) {
            const double step_mn = 1e3 * glm::length((track[i][t] - track[i - 1][t]) -
                                                     (reference[i][t] - reference[i - 1][t]));
            if (event[i]) {
                out.step_event_mn = std::max(out.step_event_mn, step_mn);
            } else {
                steps.push_back(step_mn);
            }
        }
    }
    out.rms_percent = 100.0 * std::sqrt(square / static_cast<double>(n * tools)) / out.peak_n;
    if (!steps.empty()) {
        std::sort(steps.begin(), steps.end());
        out.step_max_mn = steps.back();
        out.step_p999_mn = steps[static_cast<std::size_t>(0.999 * double(steps.size() - 1))];
    }
    return out;
}

} // namespace sim
