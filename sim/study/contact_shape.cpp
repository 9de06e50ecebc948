#include "sim/study/contact_shape.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace sim {
namespace {

using glm::dvec3;

constexpr double kTurn = 2.0 * std::numbers::pi;

struct Octave {
    double wave = 0.0, amplitude_m = 0.0;
    int waves = 0; // that share the amplitude
};

} // namespace

std::uint64_t Dice::bits() noexcept {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

double Dice::between(double low, double high) noexcept {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
}

dvec3 Dice::direction() noexcept {
    const double z = between(-1.0, 1.0), turn = between(0.0, kTurn);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(turn), r * std::sin(turn), z};
}

double Ripples::height_m(const dvec3& q) const noexcept {
    double sum = 0.0;
    for (const One& w : one)
        sum += w.amplitude_m * std::sin(glm::dot(w.wave, q) + w.phase_rad);
    return sum;
}

dvec3 Ripples::gradient(const dvec3& q) const noexcept {
    dvec3 sum{0.0};
    for (const One& w : one)
        sum += w.amplitude_m * std::cos(glm::dot(w.wave, q) + w.phase_rad) * w.wave;
    return sum;
}

Ripples organ_ripples(std::uint64_t seed) {
    Dice dice(seed);
    Ripples out;
    for (const Octave& o : {Octave{3.0, 0.002, 4}, {7.0, 0.001, 4}, {15.0, 0.0005, 4}})
        for (int i = 0; i < o.waves; ++i)
            out.one.push_back(
                {o.wave * dice.direction(), o.amplitude_m / o.waves, dice.between(0.0, kTurn)});
    return out;
}

SkinPlace organ_skin(const Ripples& ripples, const dvec3& unit) noexcept {
    // of the surface |p| = R(p / |p|): the normal is along R u - (gradient of R along the sphere)
    const double radius = kOrganRadius_m + ripples.height_m(unit);
    const dvec3 slope = ripples.gradient(unit);
    const dvec3 along = slope - glm::dot(slope, unit) * unit;
    return {radius * unit, glm::normalize(radius * unit - along)};
}

Ripples sheet_ripples(std::uint64_t seed) {
    Dice dice(seed);
    Ripples out;
    for (const Octave& o : {Octave{kTurn / 0.080, 0.003, 2}, {kTurn / 0.040, 0.001, 2}})
        for (int i = 0; i < o.waves; ++i) {
            const double turn = dice.between(0.0, kTurn);
            out.one.push_back({o.wave * dvec3{std::cos(turn), std::sin(turn), 0.0},
                               o.amplitude_m / o.waves, dice.between(0.0, kTurn)});
        }
    return out;
}

SkinPlace sheet_skin(const Ripples& ripples, double x_m, double y_m) noexcept {
    const dvec3 at{x_m, y_m, 0.0};
    const dvec3 slope = ripples.gradient(at);
    const double steep = std::sqrt(1.0 + glm::dot(slope, slope));
    return {{x_m, y_m, ripples.height_m(at) + 0.5 * kSheetThickness_m * steep},
            dvec3{-slope.x, -slope.y, 1.0} / steep};
}

} // namespace sim
