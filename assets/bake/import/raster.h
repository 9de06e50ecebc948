// assets/bake/import/raster.h
// A small software rasteriser: lit triangles with lines along their edges, dots and words, into a
// PNG, without a display. Called by picture.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace bake {

using Colour = glm::dvec3; // 0..1 each, as shown

/// Screen: x to the right and y down in pixels, z away from the eye.
class Raster {
  public:
    Raster(int width_px, int height_px, const Colour& background);

    /// `light` 0..1 scales the colour; `line` is the opacity of lines along the edges.
    void triangle(const std::array<glm::dvec3, 3>& at, const Colour& colour, double light,
                  double line);
    /// A ball of radius_px in front of what is deeper than its centre.
    void dot(const glm::dvec3& at, double radius_px, const Colour& colour);
    /// Capitals, digits and a little punctuation; other characters are spaces. Baseline-free: x, y
    /// is the upper left corner, a letter is 4 by 6 times `scale`.
    void words(int x, int y, std::string_view text, int scale, const Colour& colour);
    void box(int x, int y, int width, int height, const Colour& colour);

    /// Averaged over 2 x 2 pixels: half the width and height. Throws std::runtime_error.
    [[nodiscard]] std::string png() const;

  private:
    void set(int x, int y, const Colour& colour) {
        pixel_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x)] = colour;
    }
    int width_, height_;
    std::vector<Colour> pixel_;
    std::vector<double> depth_;
};

} // namespace bake
