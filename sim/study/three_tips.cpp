// See the header.
#include "sim/study/three_tips.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>

namespace sim {
namespace {

ToolsNow tools_at(const TipSeats& seats, const ThreeTipsOptions& o, double step_s, int step) {
    ToolsNow tools;
    tools.tick = std::lround(step_s / kTick_s) * step;
    constexpr double kRound_m = 5e-3, kAbove_m = 1e-3, kLap_s = 1.0;
    for (int i = 0; i < kTools; ++i) {
        const TipSeat& seat = seats[i];
        const double phase = 2.0 * std::numbers::pi * (step_s * step / kLap_s - 0.1 * i);
        const double down_m = 0.5 * (1.0 - std::cos(phase)) * (o.depth_m + kAbove_m) - kAbove_m;
        tools.tip[i].radius_m = o.radius_m;
        tools.tip[i].centre_m = seat.place_m +
                                kRound_m * (std::cos(phase) * seat.across +
                                            std::sin(phase) * glm::cross(seat.out, seat.across)) +
                                (o.radius_m - down_m) * seat.out;
    }
    return tools;
}

} // namespace

double process_cpu_s() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

StepTimes time_three_tips(TissueRig& rig, const TipSeats& seats, const ThreeTipsOptions& o) {
    StepTimes times;
    const auto answer = std::make_unique<TissueAnswer>();
    ToolsNow away = tools_at(seats, o, rig.config.step_s, 0);
    constexpr double kAway_m = 0.5;
    for (int i = 0; i < kTools; ++i)
        away.tip[i].centre_m += kAway_m * seats[i].out;
    const double before_s = process_cpu_s();
    constexpr int kResting = 20;
    for (int s = 0; s < kResting; ++s)
        tissue_step(rig, away, *answer);
    times.resting_ms = 1e3 * (process_cpu_s() - before_s) / kResting;
    std::vector<double> ms;
    for (int s = 0; s < o.steps; ++s) {
        const ToolsNow tools = tools_at(seats, o, rig.config.step_s, s);
        const double from_s = process_cpu_s();
        const StepOutcome outcome = tissue_step(rig, tools, *answer);
        ms.push_back(1e3 * (process_cpu_s() - from_s));
        times.linear_residual = std::max(times.linear_residual, outcome.linear_residual);
        times.residual = std::max(times.residual, outcome.residual);
        for (const FemContact& contact : rig.contact)
            times.force_n = std::max(times.force_n, glm::length(contact.force_n));
        times.mean_ms += ms.back() / o.steps;
    }
    std::ranges::sort(ms);
    const auto at = [&](double share) { // nearest rank
        return ms[static_cast<std::size_t>(std::ceil(share * static_cast<double>(ms.size()))) - 1];
    };
    times.p50_ms = at(0.5);
    times.p99_ms = at(0.99);
    times.max_ms = ms.back();
    return times;
}

} // namespace sim
