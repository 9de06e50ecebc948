#include "assets/bake/import/raster.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <png.h>
#include <stdexcept>

namespace bake {
namespace {

constexpr double kLineWidth_px = 1.2;

/// 3 x 5 pixels each, rows from the top, three bits a row.
std::uint16_t glyph(char c) {
    static constexpr std::uint16_t kDigits[10] = {0x7B6F, 0x2C97, 0x73E7, 0x73CF, 0x5BC9,
                                                  0x79CF, 0x79EF, 0x7249, 0x7BEF, 0x7BCF};
    static constexpr std::uint16_t kLetters[26] = {
        0x7BED, 0x6BAE, 0x3923, 0x6B6E, 0x79A7, 0x79A4, 0x396B, 0x5BED, 0x7497,
        0x126A, 0x5BAD, 0x4927, 0x5FED, 0x6B6D, 0x2B6A, 0x6BA4, 0x2B73, 0x6BAD,
        0x388E, 0x7492, 0x5B6F, 0x5B6A, 0x5BFD, 0x5AAD, 0x5A92, 0x72A7};
    if (c >= '0' && c <= '9') {
        return kDigits[c - '0'];
    }
    if (c >= 'a' && c <= 'z') {
        return kLetters[c - 'a'];
    }
    if (c >= 'A' && c <= 'Z') {
        return kLetters[c - 'A'];
    }
    return c == '.'               ? 0x0002
           : c == '-' || c == '_' ? 0x01C0
           : c == '/'             ? 0x12A4
           : c == '%'             ? 0x52A5
           : c == '+'             ? 0x05D0
                                  : 0;
}

void append(png_structp png, png_bytep data, png_size_t size) {
    static_cast<std::string*>(png_get_io_ptr(png))
        ->append(reinterpret_cast<const char*>(data), size);
}

} // namespace

Raster::Raster(int width_px, int height_px, const Colour& background)
    : width_(width_px), height_(height_px),
      pixel_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), background),
      depth_(pixel_.size(), std::numeric_limits<double>::max()) {}

void Raster::triangle(const std::array<glm::dvec3, 3>& p, const Colour& colour, double light,
                      double line) {
    const auto turn = [](const glm::dvec3& a, const glm::dvec3& b, double x, double y) {
        return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
    };
    const double twice = turn(p[0], p[1], p[2].x, p[2].y);
    if (twice == 0.0) {
        return;
    }
    const int x0 = std::max(0, static_cast<int>(std::min({p[0].x, p[1].x, p[2].x})));
    const int x1 = std::min(width_ - 1, static_cast<int>(std::max({p[0].x, p[1].x, p[2].x})) + 1);
    const int y0 = std::max(0, static_cast<int>(std::min({p[0].y, p[1].y, p[2].y})));
    const int y1 = std::min(height_ - 1, static_cast<int>(std::max({p[0].y, p[1].y, p[2].y})) + 1);
    std::array<double, 3> length{};
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 d = p[(k + 1) % 3] - p[k];
        length[k] = std::hypot(d.x, d.y);
    }
    for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
            std::array<double, 3> side{};
            bool in = true;
            double nearest_px = std::numeric_limits<double>::max();
            for (std::size_t k = 0; k < 3; ++k) {
                side[k] = turn(p[k], p[(k + 1) % 3], x + 0.5, y + 0.5) / twice;
                in = in && side[k] >= 0.0;
                nearest_px = std::min(nearest_px, side[k] * std::abs(twice) / length[k]);
            }
            const double z = side[1] * p[0].z + side[2] * p[1].z + side[0] * p[2].z;
            const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                   static_cast<std::size_t>(x);
            if (!in || z >= depth_[at]) {
                continue;
            }
            depth_[at] = z;
            const double ink = nearest_px < kLineWidth_px ? line : 0.0;
            pixel_[at] = colour * light * (1.0 - ink);
        }
    }
}

void Raster::dot(const glm::dvec3& c, double radius_px, const Colour& colour) {
    const int r = static_cast<int>(std::ceil(radius_px));
    const int cx = static_cast<int>(c.x), cy = static_cast<int>(c.y);
    for (int y = std::max(0, cy - r); y <= std::min(height_ - 1, cy + r); ++y) {
        for (int x = std::max(0, cx - r); x <= std::min(width_ - 1, cx + r); ++x) {
            const double away = std::hypot(x - c.x, y - c.y) / radius_px;
            const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                   static_cast<std::size_t>(x);
            if (away <= 1.0 && c.z - 2.0 * radius_px < depth_[at]) {
                depth_[at] = c.z - 2.0 * radius_px;
                pixel_[at] = colour * (1.0 - 0.5 * away * away);
            }
        }
    }
}

void Raster::words(int x, int y, std::string_view text, int scale, const Colour& colour) {
    for (const char c : text) {
        const std::uint16_t bits = glyph(c);
        for (int row = 0; row < 5; ++row) {
            for (int column = 0; column < 3; ++column) {
                if (bits >> (14 - 3 * row - column) & 1) {
                    box(x + column * scale, y + row * scale, scale, scale, colour);
                }
            }
        }
        x += 4 * scale;
    }
}

void Raster::box(int x, int y, int width, int height, const Colour& colour) {
    for (int j = std::max(0, y); j < std::min(height_, y + height); ++j) {
        for (int i = std::max(0, x); i < std::min(width_, x + width); ++i) {
            set(i, j, colour);
        }
    }
}

std::string Raster::png() const {
    const int w = width_ / 2, h = height_ / 2;
    std::vector<std::uint8_t> rgb;
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) {
            Colour sum{0.0};
            for (int k = 0; k < 4; ++k) {
                sum += pixel_[static_cast<std::size_t>((2 * y + k / 2) * width_ + 2 * x + k % 2)];
            }
            for (int d = 0; d < 3; ++d) {
                rgb.push_back(static_cast<std::uint8_t>(
                    std::lround(255.0 * std::clamp(sum[d] / 4.0, 0.0, 1.0))));
            }
        }
    }
    std::string bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    if (info == nullptr) {
        throw std::runtime_error("libpng does not start");
    }
    png_set_write_fn(png, &bytes, append, nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(w), static_cast<png_uint_32>(h), 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (int y = 0; y < h; ++y) {
        png_write_row(png,
                      rgb.data() + static_cast<std::size_t>(3 * w) * static_cast<std::size_t>(y));
    }
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

} // namespace bake
