// sim/study/bar_chart.h
// Bars in groups as an SVG picture for a study's page.
#pragma once

#include <string>
#include <vector>

namespace sim {

struct BarGroup {
    std::string name;
    std::vector<double> value; // one for each series
};

/// `series`: names in the legend. Values from 0 up, in what `axis` says.
std::string bar_chart_svg(const std::string& title, const std::string& axis,
                          const std::vector<std::string>& series,
                          const std::vector<BarGroup>& groups);

} // namespace sim
