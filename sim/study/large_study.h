// sim/study/large_study.h
// trocar study large: slender cantilevers under an end load of all sizes beside the elastica.
// Models that are right for small rotations only fall out of the gates, and are drawn so.
#pragma once

#include "sim/study/elastica.h"
#include "sim/study/solid_run.h"

#include <functional>

namespace sim {

struct LargeOptions {
    SolidCase bar; // statics; nu = 0, as the theory has it; model and load are set per point
    std::vector<double> alphas{0.25, 0.5, 1.0, 2.0, 3.0, 5.0, 7.5, 10.0}; // P L^2/(E I)
    std::vector<std::string> models{"linear", "corotated", "quadratic", "reference"};
    double gate_deflection = 0.02, gate_shortening = 0.03; // relative
    LargeOptions();
};

struct LargeRow {
    std::string model;
    double alpha = 0.0, load_n = 0.0;
    double deflection = 0.0, shortening = 0.0; // of the length; of the middle of the end face
    double deflection_error = 0.0, shortening_error = 0.0; // relative to the elastica's
    bool within = false;                                   // the gates, both
    std::string failure;
};

/// `progress` hears of each row. Throws std::invalid_argument as check(SolidCase) and elastica().
std::vector<LargeRow> run_large_study(const LargeOptions& options,
                                      const std::function<void(const LargeRow&)>& progress);

/// Names and texts of large.csv, large.svg (where the tip is), large_error.svg and large.md.
std::vector<std::pair<std::string, std::string>> large_files(const LargeOptions& options,
                                                             const std::vector<LargeRow>& rows);

} // namespace sim
