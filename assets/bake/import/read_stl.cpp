// STL: 80 bytes of anything, a count, 50 bytes a triangle (little endian); or text.
#include "assets/bake/import/read_surface.h"
#include "assets/bake/import/text_scan.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

namespace bake {
namespace {

constexpr std::size_t kHeader = 84, kPerTriangle = 50, kNormal = 12;

std::uint32_t little_u32(const std::byte* at) {
    std::uint32_t value = 0;
    for (int k = 3; k >= 0; --k) {
        value = value << 8 | std::to_integer<std::uint32_t>(at[k]);
    }
    return value;
}

Soup read_binary(std::span<const std::byte> bytes, std::size_t count) {
    Soup soup{.format = "binary STL", .point = {}, .triangles = {}, .remarks = {}};
    soup.point.reserve(3 * count);
    soup.triangles.reserve(count);
    for (std::size_t t = 0; t < count; ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t offset = kHeader + kPerTriangle * t + kNormal + 12 * k;
            glm::dvec3 p{0.0};
            for (std::size_t d = 0; d < 3; ++d) {
                const auto bits = little_u32(bytes.data() + offset + 4 * d);
                p[static_cast<int>(d)] = std::bit_cast<float>(bits);
                if (!std::isfinite(p[static_cast<int>(d)])) {
                    throw ReadError(fmt::format(
                        "byte {}: coordinate {} of corner {} of triangle {} is {}: accepted: a "
                        "finite number",
                        offset + 4 * d, "xyz"[d], k + 1, t + 1, p[static_cast<int>(d)]));
                }
            }
            soup.point.push_back(p);
        }
        const auto first = static_cast<std::uint32_t>(3 * t);
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    return soup;
}

void expect(TextScan& scan, std::string_view word, const char* wanted) {
    if (!same_word(word, wanted)) {
        scan.refuse("the word here", word, wanted);
    }
}

void read_facet(TextScan& scan, Soup& soup) {
    expect(scan, scan.word(), "normal");
    for (int d = 0; d < 3; ++d) {
        if (scan.word().empty()) {
            scan.refuse("the normal", "", "three numbers");
        }
    }
    expect(scan, scan.word(), "outer");
    expect(scan, scan.word(), "loop");
    const auto first = static_cast<std::uint32_t>(soup.point.size());
    for (int k = 0; k < 3; ++k) {
        expect(scan, scan.word(), "vertex");
        glm::dvec3 p{0.0};
        for (int d = 0; d < 3; ++d) {
            p[d] = scan.number(scan.word(), "a coordinate");
        }
        soup.point.push_back(p);
    }
    expect(scan, scan.word(), "endloop");
    expect(scan, scan.word(), "endfacet");
    soup.triangles.push_back({first, first + 1, first + 2});
}

Soup read_text(std::string_view text) {
    Soup soup{.format = "ascii STL", .point = {}, .triangles = {}, .remarks = {}};
    TextScan scan(text);
    bool open = false;
    for (std::string_view word = scan.word(); !word.empty(); word = scan.word()) {
        if (!open) {
            expect(scan, word, "solid");
            scan.skip_line(); // a name
            open = true;
        } else if (same_word(word, "facet")) {
            read_facet(scan, soup);
        } else if (same_word(word, "endsolid")) {
            scan.skip_line();
            open = false;
        } else {
            scan.refuse("the word here", word, "facet or endsolid");
        }
    }
    if (open) {
        scan.refuse("endsolid", "", "facet or endsolid");
    }
    return soup;
}

} // namespace

Soup read_stl(std::span<const std::byte> bytes) {
    const std::string_view text = as_text(bytes);
    const std::size_t count = bytes.size() >= kHeader ? little_u32(bytes.data() + 80) : 0;
    const bool whole = bytes.size() >= kHeader && bytes.size() == kHeader + kPerTriangle * count;
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (!whole && first != std::string_view::npos && same_word(text.substr(first, 5), "solid")) {
        return read_text(text);
    }
    if (bytes.size() < kHeader) {
        throw ReadError(fmt::format("byte {}: the file ends in its header: accepted: text that "
                                    "begins with \"solid\", or 84 bytes and 50 for each triangle",
                                    bytes.size()));
    }
    if (bytes.size() < kHeader + kPerTriangle * count) {
        throw ReadError(fmt::format("byte 80: it counts {} triangles, which takes {} bytes, but "
                                    "the file ends at byte {}: accepted: 84 bytes and 50 for each "
                                    "triangle",
                                    count, kHeader + kPerTriangle * count, bytes.size()));
    }
    if (count > kMaxTriangles) {
        throw ReadError(fmt::format("byte 80: it counts {} triangles: accepted: up to {}", count,
                                    kMaxTriangles));
    }
    Soup soup = read_binary(bytes, count);
    if (!whole) {
        soup.remarks.push_back(fmt::format("{} bytes after the last triangle were left out",
                                           bytes.size() - kHeader - kPerTriangle * count));
    }
    return soup;
}

} // namespace bake
