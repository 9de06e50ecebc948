// sim/study/xy_chart.h
// A chart with one linear or logarithmic axis each way as SVG text, with gates, and with failures
// at its upper border: what the solid studies draw beside their CSV. Called by studies; pure.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace sim {

struct XyAxis {
    std::string title{};
    double low = 0.0, high = 1.0; // what is beyond `high` in y has failed
    bool logarithmic = false;     // then both above 0
    std::vector<double> ticks{};  // labelled; empty: 1, 2, 5 of decades, or five to ten round steps
};

enum class XyMark { none, disc, square, triangle, diamond, ring, cross };

struct XySeries {
    std::string name; // empty: not in the legend
    int colour = 0;   // ten there are
    XyMark mark = XyMark::disc;
    bool line = true, dashed = false;
    /// x, y. Where y is no number or beyond its axis: a cross at the upper border, and no line.
    /// Below: a mark at its lower border.
    std::vector<std::pair<double, double>> point{};
};

/// Where y should be, shaded.
struct XyGate {
    double low = 0.0, high = 0.0;
    std::string name;
};

struct XyChart {
    std::string title;
    std::vector<std::string> notes{}; // lines below the title: parameters, reference, machine
    XyAxis x{}, y{};
    std::vector<XySeries> series{};
    std::vector<XyGate> gates{};
};

/// 1000 points wide; the legend at the right, and in it what a cross means if there is one.
std::string xy_svg(const XyChart& chart);

} // namespace sim
