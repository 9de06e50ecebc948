#include "sim/study/bar_chart.h"

#include "sim/study/svg_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace sim {
namespace {

// Told apart with any colour vision (Okabe, Ito 2008).
constexpr std::array<const char*, 8> kColour{"#0072b2", "#56b4e9", "#d55e00", "#e69f00",
                                             "#009e73", "#8fd9c0", "#333333", "#999999"};
constexpr double kName = 170.0; // of a series, in the legend
constexpr double kLeft = 60.0, kTop = 40.0, kHeight = 260.0, kBar = 17.0, kBetween = 34.0;

/// 1, 2 or 5 times a power of ten; about five of them up to `most`.
double tick_step(double most) {
    const double power = std::pow(10.0, std::floor(std::log10(most / 5.0)));
    for (const double k : {1.0, 2.0, 5.0})
        if (most / (k * power) <= 6.0)
            return k * power;
    return 10.0 * power;
}

} // namespace

std::string bar_chart_svg(const std::string& title, const std::string& axis,
                          const std::vector<std::string>& series,
                          const std::vector<BarGroup>& groups) {
    double most = 1e-9;
    for (const BarGroup& g : groups)
        for (const double v : g.value)
            most = std::max(most, v);
    const double group_width = kBar * static_cast<double>(series.size()) + kBetween;
    const double width = group_width * static_cast<double>(groups.size());
    const double bottom = kTop + kHeight, legend = bottom + 50.0;
    const auto names = static_cast<std::size_t>(std::max(1.0, std::floor(width / kName)));
    const double rows = std::ceil(static_cast<double>(series.size()) / static_cast<double>(names));
    std::string svg = svg_sheet(kLeft + width + 20.0, legend + 20.0 * rows, 12);
    svg += svg_text(kLeft, 20.0, "start", title + ", " + axis);
    for (double tick = 0.0; tick <= most; tick += tick_step(most)) {
        const double y = bottom - kHeight * tick / most;
        svg += fmt::format("<line x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{:.1f}\" y2=\"{:.1f}\" "
                           "stroke=\"#ddd\"/>\n",
                           kLeft, kLeft + width, y, y);
        svg += svg_text(kLeft - 6.0, y + 4.0, "end", fmt::format("{:g}", tick));
    }
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const double left = kLeft + group_width * static_cast<double>(g) + 0.5 * kBetween;
        for (std::size_t s = 0; s < groups[g].value.size(); ++s) {
            const double height = kHeight * groups[g].value[s] / most;
            svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
                               "fill=\"{}\"/>\n",
                               left + kBar * static_cast<double>(s), bottom - height, kBar - 2.0,
                               height, kColour[s % kColour.size()]);
        }
        svg += svg_text(left + 0.5 * (group_width - kBetween), bottom + 18.0, "middle",
                        groups[g].name);
    }
    for (std::size_t s = 0; s < series.size(); ++s) {
        const double x = kLeft + kName * static_cast<double>(s % names),
                     y = legend + 20.0 * static_cast<double>(s / names);
        svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"11\" height=\"11\" "
                           "fill=\"{}\"/>\n",
                           x, y - 10.0, kColour[s % kColour.size()]);
        svg += svg_text(x + 16.0, y, "start", series[s]);
    }
    return svg + "</svg>\n";
}

} // namespace sim
