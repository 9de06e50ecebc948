#include "sim/study/svg_chart.h"

#include "sim/study/svg_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace sim {
namespace {

constexpr double kWidth = 1000.0, kHeight = 560.0;
constexpr double kLeft = 80.0, kRight = 640.0, kTop = 50.0, kBottom = 490.0;
// the first eight stay apart for the colour-blind (Okabe, Ito 2008)
constexpr std::array<const char*, 12> kColour{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                              "#e69f00", "#56b4e9", "#000000", "#8a8a00",
                                              "#7570b3", "#a50026", "#888888", "#66c2a5"};

/// From a 1, 2 or 5 of a decade to another, around all values.
struct LogAxis {
    double low = 1.0, high = 10.0;

    void fit(double least, double most) {
        low = step(least, false);
        high = step(most, true);
        if (!(high > low))
            high = 2.0 * low;
    }
    double share(double value) const {
        return (std::log10(value) - std::log10(low)) / (std::log10(high) - std::log10(low));
    }
    std::vector<double> ticks() const {
        std::vector<double> out;
        for (int decade = static_cast<int>(std::floor(std::log10(low))) - 1; decade < 20; ++decade)
            for (const double digit : {1.0, 2.0, 5.0})
                if (const double v = digit * std::pow(10.0, decade);
                    v > 0.999 * low && v < 1.001 * high)
                    out.push_back(v);
        return out;
    }
    static double step(double value, bool up) {
        const double decade = std::pow(10.0, std::floor(std::log10(value)));
        double below = decade;
        for (const double digit : {1.0, 2.0, 5.0, 10.0}) {
            if (digit * decade > 0.999 * value)
                return up || digit * decade < 1.001 * value ? digit * decade : below;
            below = digit * decade;
        }
        return 10.0 * decade;
    }
};

std::string short_number(double v) {
    if (v >= 0.999e6)
        return fmt::format("{:g}M", v / 1e6);
    return v >= 0.999e3 ? fmt::format("{:g}k", v / 1e3) : fmt::format("{:g}", v);
}

std::string line_svg(const std::string& places, const ChartLine& line) {
    return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{}/>"
                       "\n",
                       places, kColour[static_cast<std::size_t>(line.colour) % kColour.size()],
                       line.dashed ? " stroke-dasharray=\"6 4\"" : "");
}

struct Frame {
    LogAxis x, y;
    double at_x(double v) const { return kLeft + x.share(v) * (kRight - kLeft); }
    double at_y(double v) const { return kBottom - y.share(v) * (kBottom - kTop); }
};

Frame frame_of(std::span<const ChartLine> lines) {
    std::vector<double> xs, ys;
    for (const ChartLine& line : lines)
        for (const auto& [x, y] : line.point)
            if (x > 0.0 && y > 0.0) {
                xs.push_back(x);
                ys.push_back(y);
            }
    Frame out;
    if (!xs.empty()) {
        out.x.fit(std::ranges::min(xs), std::ranges::max(xs));
        out.y.fit(std::ranges::min(ys), std::ranges::max(ys));
    }
    return out;
}

std::string axes_svg(const Frame& frame, const ChartText& text) {
    std::string out;
    const auto rule = [&](double x1, double y1, double x2, double y2) {
        out += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" "
                           "stroke=\"#cccccc\"/>\n",
                           x1, y1, x2, y2);
    };
    for (const double v : frame.x.ticks()) {
        rule(frame.at_x(v), kTop, frame.at_x(v), kBottom);
        out += svg_text(frame.at_x(v), kBottom + 20.0, "middle", short_number(v));
    }
    for (const double v : frame.y.ticks()) {
        rule(kLeft, frame.at_y(v), kRight, frame.at_y(v));
        out += svg_text(kLeft - 8.0, frame.at_y(v) + 4.0, "end", short_number(v));
    }
    out += svg_text(0.5 * (kLeft + kRight), 28.0, "middle", text.title, "font-size=\"16\"");
    out += svg_text(0.5 * (kLeft + kRight), kBottom + 48.0, "middle", text.x);
    const double middle = 0.5 * (kTop + kBottom);
    out += svg_text(22.0, middle, "middle", text.y,
                    fmt::format("transform=\"rotate(-90 22 {:.1f})\"", middle));
    return out;
}

} // namespace

std::string log_log_svg(const ChartText& text, std::span<const ChartLine> lines) {
    const Frame frame = frame_of(lines);
    std::string out = svg_sheet(kWidth, kHeight, 13);
    out += axes_svg(frame, text);
    double legend_y = kTop + 10.0;
    for (const ChartLine& line : lines) {
        std::string places, dots;
        for (const auto& [x, y] : line.point) {
            if (!(x > 0.0 && y > 0.0))
                continue;
            places += fmt::format("{:.1f},{:.1f} ", frame.at_x(x), frame.at_y(y));
            dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n",
                                frame.at_x(x), frame.at_y(y),
                                kColour[static_cast<std::size_t>(line.colour) % kColour.size()]);
        }
        out += line_svg(places, line) + dots;
        out += line_svg(fmt::format("{:.1f},{:.1f} {:.1f},{:.1f}", kRight + 16.0, legend_y,
                                    kRight + 46.0, legend_y),
                        line);
        out += svg_text(kRight + 52.0, legend_y + 4.0, "start", line.name);
        legend_y += 20.0;
    }
    return out + "</svg>\n";
}

} // namespace sim
