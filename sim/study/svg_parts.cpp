#include "sim/study/svg_parts.h"

#include <fmt/format.h>

namespace sim {
namespace {

std::string escaped(std::string_view words) {
    std::string out;
    for (const char c : words)
        switch (c) {
        case '<':
            out += "&lt;";
            break;
        case '&':
            out += "&amp;";
            break;
        default:
            out += c;
        }
    return out;
}

} // namespace

std::string svg_sheet(double width, double height, int font_size) {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
        "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\" font-size=\"{2}\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        width, height, font_size);
}

std::string svg_text(double x, double y, std::string_view anchor, std::string_view words,
                     std::string_view more) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}{}>{}</text>\n", x, y,
                       anchor, more.empty() ? "" : " ", more, escaped(words));
}

} // namespace sim
