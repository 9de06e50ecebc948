// OFF (Geomview): counts, points, polygons, in text.
#include "assets/bake/import/read_surface.h"
#include "assets/bake/import/text_scan.h"

#include <algorithm>
#include <fmt/format.h>

namespace bake {
namespace {

constexpr std::size_t kLeastPointBytes = 6, kLeastFaceBytes = 6; // "0 0 0\n"

/// Points have more numbers after x, y, z in some kinds, which are skipped with the line.
bool known_kind(std::string_view word) {
    static constexpr std::string_view kKinds[] = {"OFF",   "COFF",   "NOFF",   "CNOFF",
                                                  "STOFF", "STCOFF", "STNOFF", "STCNOFF"};
    return std::find(std::begin(kKinds), std::end(kKinds), word) != std::end(kKinds);
}

} // namespace

Soup read_off(std::span<const std::byte> bytes) {
    Soup soup{.format = "OFF", .point = {}, .triangles = {}, .remarks = {}};
    TextScan scan(as_text(bytes), '#');
    std::vector<std::string_view> words;
    if (!scan.line_words(words) || !known_kind(words[0])) {
        scan.refuse("the first word", words.empty() ? "" : words[0], "OFF, COFF, NOFF or STOFF");
    }
    words.erase(words.begin()); // the counts may follow on the same line
    if (!words.empty() && same_word(words[0], "binary")) {
        scan.refuse("the kind", words[0], "OFF as text");
    }
    if (words.empty() && !scan.line_words(words)) {
        scan.refuse("the counts", "", "points, faces, edges");
    }
    if (words.size() < 2) {
        scan.refuse("a line with too few counts", words[0], "points, faces, edges");
    }
    // a point and a face take a few bytes each, so no more of them can follow
    const auto left = static_cast<std::int64_t>(scan.left());
    const std::int64_t points = scan.integer(words[0], "the number of points", 0,
                                             left / std::int64_t{kLeastPointBytes} + 1);
    const std::int64_t faces =
        scan.integer(words[1], "the number of faces", 0, left / std::int64_t{kLeastFaceBytes} + 1);
    for (std::int64_t i = 0; i < points; ++i) {
        if (!scan.line_words(words) || words.size() < 3) {
            scan.refuse(fmt::format("point {} of {}", i + 1, points), words.empty() ? "" : words[0],
                        "x y z");
        }
        glm::dvec3 p{0.0};
        for (std::size_t d = 0; d < 3; ++d) {
            p[static_cast<int>(d)] = scan.number(words[d], "a coordinate");
        }
        soup.point.push_back(p);
    }
    std::vector<std::uint32_t> corners;
    for (std::int64_t f = 0; f < faces; ++f) {
        if (!scan.line_words(words)) {
            scan.refuse(fmt::format("face {} of {}", f + 1, faces), "", "a count and corners");
        }
        const std::int64_t count = scan.integer(words[0], "the number of corners", 0,
                                                static_cast<std::int64_t>(words.size()) - 1);
        corners.clear();
        for (std::int64_t k = 0; k < count; ++k) {
            corners.push_back(static_cast<std::uint32_t>(
                scan.integer(words[static_cast<std::size_t>(k) + 1], "a corner", 0, points - 1)));
        }
        add_polygon(corners, soup);
    }
    return soup;
}

} // namespace bake
