// tests/bake/import/surface_files.h
// Surfaces as files, made by code: good ones in every format, and ways to break them.
#pragma once

#include "assets/bake/surface.h"

#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <string>

namespace bake_tests {

using bake::Surface;

inline Surface globe(double radius, int around, int down, glm::dvec3 centre = {0, 0, 0}) {
    Surface s;
    s.point_m.push_back(centre + glm::dvec3{0, 0, radius});
    for (int i = 1; i < down; ++i) {
        for (int j = 0; j < around; ++j) {
            const double a = std::numbers::pi * i / down, b = 2.0 * std::numbers::pi * j / around;
            s.point_m.push_back(centre + radius * glm::dvec3{std::sin(a) * std::cos(b),
                                                             std::sin(a) * std::sin(b),
                                                             std::cos(a)});
        }
    }
    s.point_m.push_back(centre - glm::dvec3{0, 0, radius});
    const auto at = [&](int i, int j) {
        return static_cast<std::uint32_t>(1 + (i - 1) * around + j % around);
    };
    const auto last = static_cast<std::uint32_t>(s.point_m.size() - 1);
    for (int j = 0; j < around; ++j) {
        s.triangles.push_back({0, at(1, j), at(1, j + 1)});
        for (int i = 1; i + 1 < down; ++i) {
            s.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            s.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
        s.triangles.push_back({at(down - 1, j), last, at(down - 1, j + 1)});
    }
    return s;
}

inline Surface brick(glm::dvec3 low, glm::dvec3 high) {
    Surface s;
    for (int i = 0; i < 8; ++i) {
        s.point_m.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y,
                               i & 4 ? high.z : low.z);
    }
    s.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return s;
}

inline Surface both(const Surface& a, const Surface& b) {
    Surface s = a;
    const auto first = static_cast<std::uint32_t>(a.point_m.size());
    s.point_m.insert(s.point_m.end(), b.point_m.begin(), b.point_m.end());
    for (const auto& t : b.triangles) {
        s.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    return s;
}

/// A band with half a turn in it.
inline Surface moebius_strip() {
    Surface s;
    constexpr int kAround = 60;
    for (int i = 0; i < kAround; ++i) {
        const double a = 2.0 * std::numbers::pi * i / kAround;
        for (const double w : {-10.0, 10.0}) {
            const double r = 40.0 + w * std::cos(0.5 * a);
            s.point_m.emplace_back(r * std::cos(a), r * std::sin(a), w * std::sin(0.5 * a));
        }
    }
    for (std::uint32_t i = 0; i < kAround; ++i) {
        const bool last = i + 1 == kAround;
        const std::uint32_t a = 2 * i, b = 2 * i + 1, c = last ? 1 : 2 * i + 2,
                            d = last ? 0 : 2 * i + 3;
        s.triangles.push_back({a, c, b});
        s.triangles.push_back({b, c, d});
    }
    return s;
}

inline std::string binary_stl(const Surface& s) {
    std::string bytes(84 + 50 * s.triangles.size(), '\0');
    const auto put = [&](std::size_t at, std::uint32_t word) {
        for (std::size_t k = 0; k < 4; ++k) {
            bytes[at + k] = static_cast<char>(word >> (8 * k) & 0xFF);
        }
    };
    put(80, static_cast<std::uint32_t>(s.triangles.size()));
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 9; ++k) {
            const double v = s.point_m[s.triangles[t][k / 3]][static_cast<int>(k % 3)];
            put(84 + 50 * t + 12 + 4 * k, std::bit_cast<std::uint32_t>(static_cast<float>(v)));
        }
    }
    return bytes;
}

inline std::string ascii_stl(const Surface& s) {
    std::string text = "solid made by a test\n";
    for (const auto& t : s.triangles) {
        text += " facet normal 0 0 0\n  outer loop\n";
        for (const auto v : t) {
            const auto& p = s.point_m[v];
            text += fmt::format("   vertex {} {} {}\n", p.x, p.y, p.z);
        }
        text += "  endloop\n endfacet\n";
    }
    return text + "endsolid made by a test\n";
}

inline std::string obj(const Surface& s) {
    std::string text = "# a test\no thing\n";
    for (const auto& p : s.point_m) {
        text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    }
    for (const auto& t : s.triangles) {
        text += fmt::format("f {}/1/2 {} {}//3\n", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    return text;
}

inline std::string off(const Surface& s) {
    std::string text = fmt::format("OFF # a test\n{} {} 0\n", s.point_m.size(), s.triangles.size());
    for (const auto& p : s.point_m) {
        text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
    }
    for (const auto& t : s.triangles) {
        text += fmt::format("3 {} {} {} 255 0 0\n", t[0], t[1], t[2]);
    }
    return text;
}

/// `coding`: "ascii", "binary_little_endian" or "binary_big_endian".
inline std::string ply(const Surface& s, const std::string& coding) {
    std::string bytes = fmt::format(
        "ply\nformat {} 1.0\ncomment a test\nelement vertex {}\nproperty double x\nproperty double "
        "y\nproperty uchar red\nproperty double z\nelement face {}\nproperty list uchar int "
        "vertex_indices\nend_header\n",
        coding, s.point_m.size(), s.triangles.size());
    const auto put = [&](std::uint64_t word, int size) {
        for (int k = 0; k < size; ++k) {
            const int from = coding == "binary_big_endian" ? size - 1 - k : k;
            bytes += static_cast<char>(word >> (8 * from) & 0xFF);
        }
    };
    for (const auto& p : s.point_m) {
        if (coding == "ascii") {
            bytes += fmt::format("{} {} 7 {}\n", p.x, p.y, p.z);
            continue;
        }
        put(std::bit_cast<std::uint64_t>(p.x), 8);
        put(std::bit_cast<std::uint64_t>(p.y), 8);
        put(7, 1);
        put(std::bit_cast<std::uint64_t>(p.z), 8);
    }
    for (const auto& t : s.triangles) {
        if (coding == "ascii") {
            bytes += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
            continue;
        }
        put(3, 1);
        for (const auto v : t) {
            put(v, 4);
        }
    }
    return bytes;
}

inline std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
}

} // namespace bake_tests
