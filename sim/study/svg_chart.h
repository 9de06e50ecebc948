// sim/study/svg_chart.h
// A line chart with logarithmic axes as SVG text: what studies draw beside their CSV. Called by
// studies; pure.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace sim {

struct ChartLine {
    std::string name; // in the legend; lines of one colour number share a colour
    int colour = 0;
    bool dashed = false;
    std::vector<std::pair<double, double>> point; // x, y; those not above 0 are left out
};

struct ChartText {
    std::string title, x, y; // escaped here
};

/// 1000 x 560 points; decades with their 2s and 5s labelled; the legend at the right. Without any
/// point above 0: axes of one decade, and nothing in them.
std::string log_log_svg(const ChartText& text, std::span<const ChartLine> lines);

} // namespace sim
