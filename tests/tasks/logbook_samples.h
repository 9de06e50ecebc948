// tests/tasks/logbook_samples.h
// What the logbook's tests share: a folder of their own, sample rows, seeded motion, and equality
// of trace rows field by field. Tests only.
#pragma once

#include "tasks/logbook/logbook.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <unistd.h>

namespace samples {

/// A fresh folder that is removed with everything in it.
class Folder {
  public:
    Folder() {
        std::string pattern =
            (std::filesystem::temp_directory_path() / "trocar_logbook_XXXXXX").string();
        if (mkdtemp(pattern.data()) == nullptr)
            throw std::runtime_error("no temporary folder");
        path_ = pattern;
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::string file(const std::string& name) const { return (path_ / name).string(); }

  private:
    std::filesystem::path path_;
};

inline tasks::SessionRow session() {
    return {.build = "0.1.0 abc",
            .machine = "x86_64",
            .blas = "OpenBLAS 0.3",
            .dispatch = "AVX2",
            .input_class = "scripted",
            .device_serials_hash = "00ff"};
}

inline tasks::AttemptRow attempt(std::int64_t session_id) {
    tasks::AttemptRow row;
    row.session = session_id;
    row.exercise = "touch-points";
    row.exercise_text = "id = \"touch-points\"\n# with \"quotes\" and \xc3\xbc\n";
    row.scene_text = "[scene]\nname = \"abdomen\"\n";
    row.scene_hash = "5ce4e";
    row.model = "corotated";
    row.coupling = "anchored";
    row.hands = "expert";
    row.seed = 0xfedcba9876543210U; // above the signed range
    row.fem_hz = 100;
    row.started_utc = "2026-01-02T03:04:05Z";
    row.start_counts = {{1, -2, 3}, {4, 5, -6}, {1'000'000'000'000, 0, -1}};
    return row;
}

inline tasks::Metric metric(std::string id, double value, std::string unit) {
    tasks::Metric result;
    result.id = std::move(id);
    result.value = value;
    result.unit = std::move(unit);
    result.last_tick = 999;
    return result;
}

/// Three tools as a person moves them: minimum-jerk reaches of 10-60 mm in about 0.8 s with pauses,
/// 9 Hz tremor of 0.1 mm and one count of jitter, read in 20 um counts; every other second the tip
/// rests on tissue of 50 N/m with 2 mN of force noise. FEM at 100 Hz with 9 moving targets.
class Motion {
  public:
    explicit Motion(unsigned seed) : random_(seed) {
        for (auto& tool : tool_)
            plan(tool, 0);
    }

    void second(std::vector<tasks::TickTrace>& ticks, std::vector<tasks::StepTrace>& steps) {
        ticks.clear();
        steps.clear();
        for (int i = 0; i < 1000; ++i, ++tick_)
            ticks.push_back(next_tick(steps));
    }

  private:
    struct Reach {
        std::int64_t begin = 0, end = 1;
        std::array<double, 3> from_m{}, to_m{};
    };
    double uniform() { return static_cast<double>(random_()) / 4294967296.0; }
    double noise() { return uniform() + uniform() + uniform() + uniform() - 2.0; } // sigma 0.58
    static std::int32_t rounded(double value) {
        return static_cast<std::int32_t>(std::lround(value));
    }

    void plan(Reach& reach, std::int64_t tick) {
        reach.begin = tick + static_cast<std::int64_t>(600.0 * uniform());
        reach.end = reach.begin + 500 + static_cast<std::int64_t>(600.0 * uniform());
        reach.from_m = reach.to_m;
        for (double& coordinate : reach.to_m)
            coordinate = 0.06 * (uniform() - 0.5);
    }

    tasks::TickTrace next_tick(std::vector<tasks::StepTrace>& steps) {
        tasks::TickTrace row;
        row.tick = tick_;
        row.adopted_step = tick_ / 10 - 1;
        if (tick_ % 10 == 0)
            steps.push_back(step());
        const double t_s = static_cast<double>(tick_) * 1e-3;
        for (std::size_t k = 0; k < tasks::kTools; ++k) {
            Reach& reach = tool_[k];
            if (tick_ > reach.end)
                plan(reach, tick_);
            const double u = std::clamp(static_cast<double>(tick_ - reach.begin) /
                                            static_cast<double>(reach.end - reach.begin),
                                        0.0, 1.0);
            const double s = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
            const bool touching = (tick_ / 1000 + static_cast<std::int64_t>(k)) % 2 == 0;
            tasks::ToolTrace& tool = row.tool[k];
            for (std::size_t a = 0; a < 3; ++a) {
                const double phase = static_cast<double>(3 * k + a);
                const double tremor_m = 1e-4 * std::sin(2.0 * std::numbers::pi * 9.0 * t_s + phase);
                const double at_m =
                    reach.from_m[a] + s * (reach.to_m[a] - reach.from_m[a]) + tremor_m;
                tool.counts[a] = rounded(at_m / 20e-6 + noise());
                if (touching) {
                    tool.force_mn[a] = rounded(50.0 * at_m * 1e3 + 3.5 * noise());
                    tool.contact_um[a] = rounded(at_m * 1e6 + 5.0 * noise());
                }
            }
            tool.roll_counts = rounded(200.0 * std::sin(0.5 * t_s) + noise());
            tool.jaw_counts = rounded(100.0 * std::sin(0.3 * t_s));
            tool.flags = touching ? 3 : 2;
        }
        return row;
    }

    tasks::StepTrace step() {
        tasks::StepTrace row;
        row.step = tick_ / 10;
        row.sample_tick = tick_ - 1;
        row.duration_us = 4000 + rounded(300.0 * noise());
        row.targets = 9;
        for (std::size_t t = 0; t < 9; ++t)
            for (std::size_t a = 0; a < 3; ++a)
                row.target_um[t][a] = rounded(
                    10000.0 * static_cast<double>(t) +
                    2000.0 * std::sin(1e-3 * static_cast<double>(tick_) + static_cast<double>(a)) +
                    noise());
        return row;
    }

    std::mt19937 random_;
    std::array<Reach, tasks::kTools> tool_{};
    std::int64_t tick_ = 0;
};

inline bool same(const tasks::ToolTrace& a, const tasks::ToolTrace& b) {
    return a.counts == b.counts && a.roll_counts == b.roll_counts && a.jaw_counts == b.jaw_counts &&
           a.force_mn == b.force_mn && a.contact_um == b.contact_um && a.flags == b.flags;
}
inline bool same(const tasks::TickTrace& a, const tasks::TickTrace& b) {
    for (std::size_t k = 0; k < tasks::kTools; ++k)
        if (!same(a.tool[k], b.tool[k]))
            return false;
    const tasks::ScopeTrace &s = a.scope, &z = b.scope;
    return a.tick == b.tick && a.adopted_step == b.adopted_step && s.counts == z.counts &&
           s.camera_counts == z.camera_counts && s.optic_counts == z.optic_counts &&
           s.flags == z.flags;
}
inline bool same(const tasks::StepTrace& a, const tasks::StepTrace& b) {
    return a.step == b.step && a.sample_tick == b.sample_tick && a.duration_us == b.duration_us &&
           a.flags == b.flags && a.stress_pa == b.stress_pa && a.targets == b.targets &&
           a.target_um == b.target_um && a.clear_rays == b.clear_rays;
}
template <class Row> bool same(std::span<const Row> a, std::span<const Row> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Row& x, const Row& y) { return same(x, y); });
}

inline bool same(const tasks::Chunk& chunk, std::span<const tasks::TickTrace> ticks,
                 std::span<const tasks::StepTrace> steps) {
    return same(std::span<const tasks::TickTrace>(chunk.ticks), ticks) &&
           same(std::span<const tasks::StepTrace>(chunk.steps), steps);
}

} // namespace samples
