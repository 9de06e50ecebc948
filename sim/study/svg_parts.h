// sim/study/svg_parts.h
// What every picture of a study begins with and writes: a white sheet, words. Called by the
// charts; pure.
#pragma once

#include <string>
#include <string_view>

namespace sim {

/// A white sheet; the closing </svg> is the caller's.
std::string svg_sheet(double width, double height, int font_size);

/// `anchor`: start, middle or end. The words are escaped; `more`: further attributes, as they are.
std::string svg_text(double x, double y, std::string_view anchor, std::string_view words,
                     std::string_view more = "");

} // namespace sim
