// Wavefront OBJ: v and f lines.
#include "assets/bake/import/read_surface.h"
#include "assets/bake/import/text_scan.h"

#include <algorithm>
#include <fmt/format.h>

namespace bake {
namespace {

/// Index in front of the first slash: from 1, or from the end if negative.
std::uint32_t corner(const TextScan& scan, std::string_view word, std::size_t points) {
    const auto count = static_cast<std::int64_t>(points);
    const std::string_view digits = word.substr(0, word.find('/'));
    const std::int64_t index =
        scan.integer(digits.empty() ? word : digits, "a corner", -count, count);
    if (index == 0) {
        scan.refuse("a corner", word, fmt::format("1 to {} or -1 to {}", count, -count));
    }
    return static_cast<std::uint32_t>(index > 0 ? index - 1 : count + index);
}

} // namespace

Soup read_obj(std::span<const std::byte> bytes) {
    Soup soup{.format = "OBJ", .point = {}, .triangles = {}, .remarks = {}};
    TextScan scan(as_text(bytes), '#');
    std::vector<std::string_view> words, more;
    std::vector<std::uint32_t> corners;
    std::size_t skipped = 0;
    while (scan.line_words(words)) {
        while (words.back() == "\\" && scan.line_words(more)) { // the line goes on
            words.pop_back();
            words.insert(words.end(), more.begin(), more.end());
        }
        if (words[0] == "v") {
            glm::dvec3 p{0.0};
            for (std::size_t d = 0; d < 3; ++d) {
                if (d + 1 >= words.size()) {
                    scan.refuse("a vertex with too few numbers", words[0], "v x y z");
                }
                p[static_cast<int>(d)] = scan.number(words[d + 1], "a coordinate");
            }
            soup.point.push_back(p);
        } else if (words[0] == "f") {
            corners.clear();
            for (std::size_t i = 1; i < words.size(); ++i) {
                corners.push_back(corner(scan, words[i], soup.point.size()));
            }
            if (corners.size() < 3) {
                scan.refuse("a face with too few corners", words[0], "f and three corners or more");
            }
            add_polygon(corners, soup);
        } else {
            // binary bytes have no words that OBJ knows
            static constexpr std::string_view kKnown[] = {"vt", "vn",     "vp",     "g",   "o",
                                                          "s",  "usemtl", "mtllib", "l",   "p",
                                                          "mg", "usemap", "maplib", "lod", "bevel"};
            const bool known =
                std::find(std::begin(kKnown), std::end(kKnown), words[0]) != std::end(kKnown);
            if (!known) {
                scan.refuse("the first word of the line", words[0],
                            "v, f, vt, vn, g, o, s, usemtl, mtllib, l, p or a comment");
            }
            skipped += words[0] == "l" || words[0] == "p" ? 1 : 0;
        }
    }
    if (skipped > 0) {
        soup.remarks.push_back(fmt::format("{} lines and points were left out", skipped));
    }
    return soup;
}

} // namespace bake
