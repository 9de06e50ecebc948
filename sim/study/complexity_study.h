// sim/study/complexity_study.h
// trocar study complexity: what a FEM step costs as an organ gets more nodes, and what it holds in
// memory. A block of tissue, three tools that press and slide on it, whole steps of the tissue loop
// with the local models of the tools; nothing of it is left out. Any thread; absolute times are
// this machine's, exponents are the model's.
#pragma once

#include "sim/study/three_tips.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace sim {

struct ComplexityOptions {
    std::vector<tissue::Tier> tiers{tissue::Tier::linear, tissue::Tier::corotated,
                                    tissue::Tier::quadratic};
    std::vector<int> nodes{500, 1000, 2000, 5000, 10000, 20000, 50000}; // asked for
    int steps = 100;                                                    // of 10 ms, timed
    double young_pa = 5.4e3, poisson = 0.45;
    double depth_m = 4e-3; // most of each tool
};

struct ComplexityRow {
    tissue::Tier tier{};
    std::size_t nodes = 0, tets = 0; // that there are; of the tier's own shapes
    StepTimes times{};
    double setup_s = 0.0;   // CPU: matrices, the first factor
    double megabytes = 0.0; // on the heap, of the body with all that steps need
};

/// y = c nodes^exponent, by least squares of the logarithms.
struct Growth {
    double exponent = 0.0, at_1000 = 0.0;
};
/// Throws std::invalid_argument with fewer than two points, or one that is not above 0.
Growth growth(std::span<const std::pair<double, double>> nodes_and_y);

/// `progress` hears of each row. Throws std::invalid_argument naming what is wrong.
std::vector<ComplexityRow>
run_complexity(const ComplexityOptions& options,
               const std::function<void(const ComplexityRow&)>& progress);

/// Names and texts of complexity.csv, complexity.svg (time), complexity_memory.svg, complexity.md.
std::vector<std::pair<std::string, std::string>>
complexity_files(const ComplexityOptions& options, const std::vector<ComplexityRow>& rows);

} // namespace sim
