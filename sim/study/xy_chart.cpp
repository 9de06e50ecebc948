#include "sim/study/xy_chart.h"

#include "sim/study/svg_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace sim {
namespace {

constexpr double kWidth = 1000.0, kHeight = 620.0, kLeft = 80.0, kRight = 700.0;
constexpr double kBottom = 550.0, kNoteStep = 17.0, kFirstNote = 46.0;
// the first eight stay apart for the colour-blind (Okabe, Ito 2008)
constexpr std::array<const char*, 10> kColour{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                              "#e69f00", "#56b4e9", "#000000", "#8a8a00",
                                              "#7570b3", "#888888"};

struct Place {
    double x = 0.0, y = 0.0;
    bool failed = false;
};

struct Frame {
    const XyChart& chart;
    double top = 0.0;

    static double share(const XyAxis& a, double v) {
        return a.logarithmic ? std::log(v / a.low) / std::log(a.high / a.low)
                             : (v - a.low) / (a.high - a.low);
    }
    double x(double v) const { return kLeft + share(chart.x, v) * (kRight - kLeft); }
    double y(double v) const { return kBottom - share(chart.y, v) * (kBottom - top); }
    Place place(const std::pair<double, double>& p) const {
        const double at = std::clamp(x(p.first), kLeft, kRight);
        if (!(p.second <= chart.y.high))
            return {at, top, true};
        return {at, y(std::max(p.second, chart.y.low)), false};
    }
};

std::vector<double> ticks_of(const XyAxis& a) {
    if (!a.ticks.empty())
        return a.ticks;
    std::vector<double> out;
    if (!a.logarithmic) {
        const double raw = (a.high - a.low) / 6.0;
        const double decade = std::pow(10.0, std::floor(std::log10(raw)));
        double step = 10.0 * decade;
        for (const double digit : {5.0, 2.0, 1.0})
            step = digit * decade >= 0.8 * raw ? digit * decade : step;
        for (double k = std::ceil(a.low / step - 1e-9); k * step <= a.high * (1 + 1e-9); ++k)
            out.push_back(k * step);
        return out;
    }
    for (int decade = static_cast<int>(std::floor(std::log10(a.low))) - 1; decade < 20; ++decade)
        for (const double digit : {1.0, 2.0, 5.0})
            if (const double v = digit * std::pow(10.0, decade);
                v > 0.999 * a.low && v < 1.001 * a.high)
                out.push_back(v);
    return out;
}

std::string rule(double x1, double y1, double x2, double y2, const char* how) {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1,
                       y1, x2, y2, how);
}

const char* colour_of(const XySeries& s) {
    return kColour[static_cast<std::size_t>(s.colour) % kColour.size()];
}

std::string cross_svg(double x, double y, const char* colour) {
    const std::string how = fmt::format("stroke=\"{}\" stroke-width=\"3\"", colour);
    return rule(x - 5, y - 5, x + 5, y + 5, how.c_str()) +
           rule(x - 5, y + 5, x + 5, y - 5, how.c_str());
}

std::string mark_svg(const XySeries& s, double x, double y) {
    const char* c = colour_of(s);
    switch (s.mark) {
    case XyMark::disc:
        return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n", x, y, c);
    case XyMark::square:
        return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"8\" height=\"8\" "
                           "fill=\"{}\"/>\n",
                           x - 4, y - 4, c);
    case XyMark::triangle:
        return fmt::format("<path d=\"M{:.1f} {:.1f} l5 9 h-10 z\" fill=\"{}\"/>\n", x, y - 6, c);
    case XyMark::diamond:
        return fmt::format("<path d=\"M{:.1f} {:.1f} l5.5 5.5 l-5.5 5.5 l-5.5 -5.5 z\" "
                           "fill=\"{}\"/>\n",
                           x, y - 5.5, c);
    case XyMark::ring:
        return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"7\" fill=\"none\" "
                           "stroke=\"{}\" stroke-width=\"2\"/>\n",
                           x, y, c);
    case XyMark::cross:
        return cross_svg(x, y, c);
    case XyMark::none:
        break;
    }
    return "";
}

std::string axes_svg(const Frame& f) {
    std::string out;
    constexpr const char* kGrid = "stroke=\"#dddddd\"";
    for (const XyGate& g : f.chart.gates) {
        const double high = f.y(std::min(g.high, f.chart.y.high)),
                     low = f.y(std::max(g.low, f.chart.y.low));
        out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
                           "fill=\"#e4f2e4\"/>\n",
                           kLeft, high, kRight - kLeft, low - high);
    }
    for (const double v : ticks_of(f.chart.x)) {
        out += rule(f.x(v), f.top, f.x(v), kBottom, kGrid);
        out += svg_text(f.x(v), kBottom + 20.0, "middle", fmt::format("{:.4g}", v));
    }
    for (const double v : ticks_of(f.chart.y)) {
        out += rule(kLeft, f.y(v), kRight, f.y(v), kGrid);
        out += svg_text(kLeft - 10.0, f.y(v) + 4.0, "end",
                        fmt::format("{:.4g}", std::abs(v) < 1e-12 ? 0.0 : v));
    }
    out += svg_text(kLeft, 24.0, "start", f.chart.title, "font-size=\"16\"");
    double y = kFirstNote;
    for (const std::string& note : f.chart.notes) {
        out += svg_text(kLeft, y, "start", note, "font-size=\"12\" fill=\"#444444\"");
        y += kNoteStep;
    }
    out += svg_text(0.5 * (kLeft + kRight), kBottom + 46.0, "middle", f.chart.x.title);
    const double middle = 0.5 * (f.top + kBottom);
    return out + svg_text(22.0, middle, "middle", f.chart.y.title,
                          fmt::format("transform=\"rotate(-90 22 {:.1f})\"", middle));
}

std::string line_svg(const XySeries& s, const std::string& places) {
    return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" "
                       "stroke-width=\"2\"{}/>\n",
                       places, colour_of(s), s.dashed ? " stroke-dasharray=\"6 4\"" : "");
}

// The line ends before what failed and begins again after it.
std::string series_svg(const Frame& f, const XySeries& s) {
    std::string places, lines, marks;
    const auto end_line = [&] {
        if (s.line && !places.empty())
            lines += line_svg(s, places);
        places.clear();
    };
    for (const auto& point : s.point) {
        const Place p = f.place(point);
        marks += p.failed ? cross_svg(p.x, p.y, colour_of(s)) : mark_svg(s, p.x, p.y);
        if (p.failed)
            end_line();
        else
            places += fmt::format("{:.1f},{:.1f} ", p.x, p.y);
    }
    end_line();
    return lines + marks;
}

std::string legend_svg(const Frame& f) {
    std::string out;
    double y = f.top + 8.0;
    bool failed = false;
    for (const XySeries& s : f.chart.series) {
        for (const auto& p : s.point)
            failed = failed || f.place(p).failed;
        if (s.name.empty())
            continue;
        const double from = kRight + 16.0, to = kRight + 44.0;
        if (s.line)
            out += line_svg(s, fmt::format("{:.1f},{:.1f} {:.1f},{:.1f}", from, y, to, y));
        out += mark_svg(s, 0.5 * (from + to), y) + svg_text(to + 8.0, y + 4.0, "start", s.name);
        y += 20.0;
    }
    for (const XyGate& g : f.chart.gates) {
        out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"28\" height=\"12\" "
                           "fill=\"#e4f2e4\"/>\n",
                           kRight + 16.0, y - 6.0) +
               svg_text(kRight + 52.0, y + 4.0, "start", g.name);
        y += 20.0;
    }
    if (failed)
        out += cross_svg(kRight + 30.0, y, "#666666") +
               svg_text(kRight + 52.0, y + 4.0, "start", "failed, or beyond the axis");
    return out;
}

} // namespace

std::string xy_svg(const XyChart& chart) {
    const Frame frame{chart,
                      kFirstNote + kNoteStep * static_cast<double>(chart.notes.size()) + 4.0};
    std::string out = svg_sheet(kWidth, kHeight, 13) + axes_svg(frame);
    for (const XySeries& s : chart.series)
        out += series_svg(frame, s);
    return out + legend_svg(frame) + "</svg>\n";
}

} // namespace sim
