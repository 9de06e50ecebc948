// sim/session/region_file.cpp
// The text of a painted region: balls of tissue that is held, one a line. Any bytes may come in.
#include "sim/session/anchor.h"

#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

namespace sim {
namespace {

constexpr double kMaxPlace_mm = 1000.0, kMaxRadius_mm = 500.0;

// A line as a person would recognise it: cut, and without bytes that a terminal would obey.
std::string shown(std::string_view line) {
    std::string text(line.substr(0, 40));
    for (char& c : text) {
        if (c < ' ' || c > '~')
            c = '?';
    }
    return line.size() > 40 ? text + "..." : text;
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r";
    const std::size_t first = text.find_first_not_of(kBlank);
    if (first == std::string_view::npos)
        return {};
    return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

// Exactly four numbers between blanks; false for anything else.
bool read_numbers(std::string_view line, std::array<double, 4>& out) {
    for (double& number : out) {
        line = trimmed(line);
        const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
        if (error != std::errc{})
            return false;
        line.remove_prefix(static_cast<std::size_t>(end - line.data()));
        if (!line.empty() && line.front() != ' ' && line.front() != '\t' && line.front() != '\r')
            return false;
    }
    return trimmed(line).empty();
}

// False for what is not finite.
bool in_range(const std::array<double, 4>& v) {
    return std::abs(v[0]) <= kMaxPlace_mm && std::abs(v[1]) <= kMaxPlace_mm &&
           std::abs(v[2]) <= kMaxPlace_mm && v[3] > 0.0 && v[3] <= kMaxRadius_mm;
}

} // namespace

std::vector<AnchorBall> parse_region(std::string_view text, const std::string& file) {
    if (text.size() > kMaxRegionBytes) {
        throw tasks::BadInput({file, 1, "size", fmt::format("{} bytes", text.size())},
                              fmt::format("a region of at most {} bytes", kMaxRegionBytes));
    }
    std::vector<AnchorBall> balls;
    std::size_t line_number = 0;
    while (!text.empty()) {
        ++line_number;
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view whole = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::string_view line = trimmed(whole.substr(0, whole.find('#')));
        if (line.empty())
            continue;
        std::array<double, 4> v{};
        if (!read_numbers(line, v) || !in_range(v)) {
            throw tasks::BadInput(
                {file, line_number, "ball", shown(line)},
                fmt::format("x y z r in millimetres: three numbers from -{0:.0f} to {0:.0f} and a "
                            "radius above 0, at most {1:.0f}",
                            kMaxPlace_mm, kMaxRadius_mm));
        }
        if (balls.size() == kMaxRegionBalls) {
            throw tasks::BadInput({file, line_number, "ball", shown(line)},
                                  fmt::format("at most {} balls", kMaxRegionBalls));
        }
        balls.push_back({1e-3 * glm::dvec3{v[0], v[1], v[2]}, 1e-3 * v[3]});
    }
    if (balls.empty())
        throw tasks::BadInput({file, 1, "ball", {}}, "at least one line x y z r in millimetres");
    return balls;
}

} // namespace sim
