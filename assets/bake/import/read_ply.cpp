// PLY (Turk 1994): a header that describes elements and their properties, then rows, in text or
// in binary of either byte order.
#include "assets/bake/import/read_surface.h"
#include "assets/bake/import/text_scan.h"

#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace bake {
namespace {

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };
enum class Coding { text, little, big };

struct Property {
    std::string name;
    Type type = Type::f32;
    std::optional<Type> count; // of a list
};
struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};
struct Header {
    Coding coding = Coding::text;
    std::vector<Element> elements;
};

std::size_t size_of(Type t) {
    constexpr std::size_t kSize[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return kSize[static_cast<std::size_t>(t)];
}

Type type_of(const TextScan& scan, std::string_view word) {
    static constexpr std::string_view kNames[][2] = {
        {"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
        {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};
    for (std::size_t i = 0; i < std::size(kNames); ++i) {
        if (word == kNames[i][0] || word == kNames[i][1]) {
            return static_cast<Type>(i);
        }
    }
    scan.refuse("the type", word, "char, uchar, short, ushort, int, uint, float or double");
}

Coding coding_of(const TextScan& scan, std::string_view word) {
    if (word == "ascii") {
        return Coding::text;
    }
    if (word == "binary_little_endian" || word == "binary_big_endian") {
        return word == "binary_little_endian" ? Coding::little : Coding::big;
    }
    scan.refuse("the format", word, "ascii, binary_little_endian or binary_big_endian");
}

void read_property(const TextScan& scan, const std::vector<std::string_view>& words,
                   Header& header) {
    if (header.elements.empty()) {
        scan.refuse("what comes before the first element", words[0], "element NAME COUNT");
    }
    Property p;
    const bool list = words.size() == 5 && words[1] == "list";
    if (!list && words.size() != 3) {
        scan.refuse("a property", words[0], "property TYPE NAME or property list TYPE TYPE NAME");
    }
    if (list) {
        p.count = type_of(scan, words[2]);
        if (*p.count == Type::f32 || *p.count == Type::f64) {
            scan.refuse("the type of a count", words[2], "a whole-number type");
        }
    }
    p.type = type_of(scan, words[words.size() - 2]);
    p.name = words.back();
    header.elements.back().properties.push_back(std::move(p));
}

/// Leaves `scan` behind the line end_header.
Header read_header(TextScan& scan) {
    std::vector<std::string_view> words;
    Header header;
    if (!scan.line_words(words) || words[0] != "ply") {
        scan.refuse("the first word", words.empty() ? "" : words[0], "ply");
    }
    bool has_format = false;
    for (;;) {
        if (!scan.line_words(words)) {
            scan.refuse("end_header", "", "format, element, property, comment, end_header");
        }
        if (words[0] == "end_header") {
            break;
        }
        if (words[0] == "format" && words.size() == 3) {
            header.coding = coding_of(scan, words[1]);
            has_format = true;
        } else if (words[0] == "element" && words.size() == 3) {
            const auto count = scan.integer(words[2], "the number of elements", 0,
                                            static_cast<std::int64_t>(scan.left()));
            header.elements.push_back({std::string(words[1]), static_cast<std::size_t>(count), {}});
        } else if (words[0] == "property") {
            read_property(scan, words, header);
        } else if (words[0] != "comment" && words[0] != "obj_info") {
            scan.refuse("the line's first word", words[0],
                        "format, element, property, comment, obj_info, end_header");
        }
    }
    if (!has_format) {
        scan.refuse("a header without its format", words[0],
                    "format ascii|binary_little_endian|binary_big_endian 1.0");
    }
    return header;
}

/// Values one after the other, in either coding, with where they are.
class Values {
  public:
    Values(TextScan& scan, std::span<const std::byte> bytes, std::size_t first, Coding coding)
        : scan_(scan), bytes_(bytes), at_(first), coding_(coding) {}

    double next(Type type, const char* what) {
        if (coding_ == Coding::text) {
            const std::string_view word = scan_.word();
            return word.empty() ? (scan_.refuse(what, "", "a number"), 0.0)
                                : scan_.number(word, what);
        }
        const std::size_t size = size_of(type);
        if (size > bytes_.size() - at_) {
            throw ReadError(fmt::format("byte {}: the file ends before {}: accepted: as many rows "
                                        "as the header counts",
                                        bytes_.size(), what));
        }
        std::uint64_t bits = 0;
        for (std::size_t k = 0; k < size; ++k) {
            const std::size_t from = coding_ == Coding::little ? size - 1 - k : k;
            bits = bits << 8 | std::to_integer<std::uint64_t>(bytes_[at_ + from]);
        }
        at_ += size;
        return value(type, bits);
    }

    [[nodiscard]] std::size_t left() const {
        return coding_ == Coding::text ? scan_.left() : bytes_.size() - at_;
    }
    [[noreturn]] void refuse(const char* what, double value, const std::string& accepted) const {
        const std::string where = coding_ == Coding::text ? fmt::format("line {}", scan_.line())
                                                          : fmt::format("byte {}", at_);
        throw ReadError(fmt::format("{}: {} is {}: accepted: {}", where, what, value, accepted));
    }

  private:
    static double value(Type type, std::uint64_t bits) {
        switch (type) {
        case Type::i8:
            return static_cast<std::int8_t>(bits);
        case Type::i16:
            return static_cast<std::int16_t>(bits);
        case Type::i32:
            return static_cast<std::int32_t>(bits);
        case Type::f32:
            return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
        case Type::f64:
            return std::bit_cast<double>(bits);
        default:
            return static_cast<double>(bits);
        }
    }

    TextScan& scan_;
    std::span<const std::byte> bytes_;
    std::size_t at_;
    Coding coding_;
};

std::size_t whole(const Values& values, const char* what, double value, std::size_t most) {
    if (!(value >= 0.0) || value > static_cast<double>(most) || value != std::floor(value)) {
        values.refuse(what, value, fmt::format("a whole number from 0 to {}", most));
    }
    return static_cast<std::size_t>(value);
}

/// A value takes at least one byte (in text two, but for the last).
void check_rows(const Values& values, const Element& element) {
    std::size_t least = 0;
    for (const auto& p : element.properties) {
        least += p.count ? size_of(*p.count) : 1;
    }
    if (least > 0 && element.count > values.left() / least + 1) {
        values.refuse("the number of rows", static_cast<double>(element.count),
                      fmt::format("no more than the {} bytes left can hold", values.left()));
    }
}

void read_vertices(Values& values, const Element& element, Soup& soup) {
    int seen = 0;
    for (const auto& p : element.properties) {
        seen |= p.name == "x" ? 1 : p.name == "y" ? 2 : p.name == "z" ? 4 : 0;
    }
    if (seen != 7) {
        throw ReadError("the element vertex lacks a coordinate: accepted: properties x, y, z");
    }
    for (std::size_t i = 0; i < element.count; ++i) {
        glm::dvec3 at{0.0};
        for (const auto& p : element.properties) {
            const std::size_t n =
                p.count ? whole(values, "a list's length", values.next(*p.count, "a list's length"),
                                values.left())
                        : 1;
            for (std::size_t k = 0; k < n; ++k) {
                const double v = values.next(p.type, "a property of a vertex");
                if (p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z') {
                    if (!std::isfinite(v)) {
                        values.refuse("a coordinate", v, "a finite number");
                    }
                    at[p.name[0] - 'x'] = v;
                }
            }
        }
        soup.point.push_back(at);
    }
}

void read_faces(Values& values, const Element& element, Soup& soup) {
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < element.count; ++i) {
        for (const auto& p : element.properties) {
            const bool is_corners = p.name == "vertex_indices" || p.name == "vertex_index";
            const std::size_t n = p.count ? whole(values, "a face's number of corners",
                                                  values.next(*p.count, "a face"), values.left())
                                          : 1;
            corners.clear();
            for (std::size_t k = 0; k < n; ++k) {
                const double v = values.next(p.type, "a property of a face");
                if (is_corners) {
                    const std::size_t most = soup.point.empty() ? 0 : soup.point.size() - 1;
                    corners.push_back(
                        static_cast<std::uint32_t>(whole(values, "a corner", v, most)));
                }
            }
            if (is_corners && !soup.point.empty()) {
                add_polygon(corners, soup);
            }
        }
    }
}

void skip_rows(Values& values, const Element& element) {
    for (std::size_t i = 0; i < element.count && !element.properties.empty(); ++i) {
        for (const auto& p : element.properties) {
            const std::size_t n = p.count ? whole(values, "a list's length",
                                                  values.next(*p.count, "a list"), values.left())
                                          : 1;
            for (std::size_t k = 0; k < n; ++k) {
                values.next(p.type, "a property");
            }
        }
    }
}

} // namespace

Soup read_ply(std::span<const std::byte> bytes) {
    Soup soup;
    TextScan scan(as_text(bytes));
    const Header header = read_header(scan);
    const std::size_t line_end = as_text(bytes).find('\n', scan.offset());
    const std::size_t first = line_end == std::string_view::npos ? bytes.size() : line_end + 1;
    constexpr const char* kFormats[] = {"ascii PLY", "binary PLY (little endian)",
                                        "binary PLY (big endian)"};
    soup.format = kFormats[static_cast<std::size_t>(header.coding)];
    Values values(scan, bytes, first, header.coding);
    for (const Element& element : header.elements) {
        check_rows(values, element);
        if (element.name == "vertex") {
            read_vertices(values, element, soup);
        } else if (element.name == "face") {
            read_faces(values, element, soup);
        } else {
            skip_rows(values, element);
        }
    }
    return soup;
}

} // namespace bake
