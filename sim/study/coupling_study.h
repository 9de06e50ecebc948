// sim/study/coupling_study.h
// trocar study coupling: force error and tick step of each coupling against FEM rate and speed, on
// a scene's first organ, with the error of the reference itself beside it.
#pragma once

#include "sim/session/scene.h"
#include "sim/study/open_loop.h"

#include <filesystem>

namespace sim {

struct CouplingStudyOptions {
    std::string scene = "basic";
    std::vector<std::string> motions{kMotionNames.begin(), kMotionNames.end()};
    std::vector<double> speeds_mmps{20.0, 50.0, 100.0};
    std::vector<int> fem_hz{50, 100, 200};
    std::vector<std::string> couplings{"anchored", "hold"};
    glm::dvec3 place_mm{0.0, 0.0, 40.0}, heading{1.0, 0.0, 0.0};
    double depth_scale = 1.0;
    double friction = -1.0; // below 0: the scene's own
    double young_kpa = 0.0; // 0: the scene's own
    double damping_stiffness_ms = -1.0;
    int late_ticks = 0, jitter_ticks = 0;
    bool halve = true; // also run the reference at half its step
    std::uint64_t seed = 1;
};

struct CouplingRow {
    std::string motion, coupling;
    double speed_mmps = 0.0;
    int fem_hz = 0; // 0: the reference against itself at half its step
    ForceError error;
};

/// Runs all cells; `progress` hears of each. Throws on unknown names.
std::vector<CouplingRow> run_coupling_study(const CouplingStudyOptions& options,
                                            void (*progress)(const CouplingRow&));

/// CSV and a Markdown page with the table, parameters and machine.
void write_coupling_study(const CouplingStudyOptions& options, const std::vector<CouplingRow>& rows,
                          const std::filesystem::path& out);

} // namespace sim
