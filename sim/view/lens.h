// sim/view/lens.h
// The endoscope's optics: a round picture with a dark rim and a little barrel distortion. Lengths
// in half heights of the window, origin in its middle. Pure; any thread.
//
// The middle keeps the size of a pinhole's picture. At the rim, left and right, the lens shows what
// a pinhole would show at the window's edge, so nothing is lost but the corners.
#pragma once

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace view {

struct Lens {
    double rim = 1.0;           // radius of the round picture
    double barrel = 0.0;        // k: what is seen at r, a pinhole shows at r (1 + k r^2)
    glm::dvec2 reach{1.0, 1.0}; // half sides of the pinhole's picture that is needed
};

/// For a window of this shape; wider than 16 : 9 or taller than wide stays dark at the sides.
inline Lens lens_of(int width_px, int height_px) noexcept {
    constexpr double kRim = 0.92, kWidest = 16.0 / 9.0;
    const double aspect = static_cast<double>(std::max(1, width_px)) / std::max(1, height_px);
    const double rim = kRim * std::clamp(aspect, 1.0, kWidest);
    return {rim, (1.0 / kRim - 1.0) / (rim * rim),
            glm::dvec2(std::min(rim, aspect), std::min(rim, 1.0)) / kRim};
}

/// Where a pinhole shows what the lens shows at `at`.
inline glm::dvec2 pinhole_place(const Lens& lens, const glm::dvec2& at) noexcept {
    return at * (1.0 + lens.barrel * glm::dot(at, at));
}

/// Radius at which the lens shows what a pinhole shows at radius `r`: Newton's method on
/// s + k s^3 = r, which is convex there, so it falls to the root from above.
inline double seen_radius(const Lens& lens, double r) noexcept {
    double s = r;
    for (int i = 0; i < 20; ++i)
        s -= (s + lens.barrel * s * s * s - r) / (1.0 + 3.0 * lens.barrel * s * s);
    return s;
}

/// How much smaller than in the middle a small thing is, towards the rim, seen at radius `s`.
inline double radial_scale(const Lens& lens, double s) noexcept {
    return 1.0 / (1.0 + 3.0 * lens.barrel * s * s);
}

} // namespace view
