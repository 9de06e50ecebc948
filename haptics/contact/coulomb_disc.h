// haptics/contact/coulomb_disc.h
// Friction of one contact as a problem of its own: the force in a disc that comes nearest to
// sticking. Called by contact_rows.cpp in both loops.
#pragma once

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

namespace haptics {

/// Minimiser of f.A f / 2 - b.f over |f| <= radius: either A f = b (sticks, multiplier 0), or
/// (A + multiplier) f = b with |f| = radius (slips, by multiplier * |f| against f).
struct DiscPoint {
    glm::dvec2 f{0.0};
    double multiplier = 0.0; // infinite if the radius is not positive
};

/// A symmetric positive. The multiplier is the root of 1/|f| = 1/radius, a concave function,
/// reached from the left by Newton (More & Sorensen 1983). Real-time safe.
DiscPoint disc_minimum(const glm::dmat2& A, const glm::dvec2& b, double radius) noexcept;

} // namespace haptics
