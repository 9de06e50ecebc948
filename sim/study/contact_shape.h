// sim/study/contact_shape.h
// The two smooth surfaces of the contact bench, as formulas: an organ (a sphere whose radius is a
// sum of waves) and a wavy sheet. Meshes are cut from them and paths laid over them, so neither
// rests on a collision method. Called by contact_workload; pure, any thread. Metres, world frame.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace sim {

inline constexpr double kOrganRadius_m = 0.060;
inline constexpr double kSheetWidth_m = 0.120; // x and y from -60 to 60 mm
inline constexpr double kSheetThickness_m = 0.001;

/// A reproducible stream of numbers: splitmix64 (Steele, Lea, Flood 2014).
class Dice {
  public:
    explicit Dice(std::uint64_t seed) noexcept : state_(seed) {}
    std::uint64_t bits() noexcept;
    double between(double low, double high) noexcept;
    glm::dvec3 direction() noexcept; // unit, even over the sphere

  private:
    std::uint64_t state_;
};

/// height(q) = sum of amplitude sin(wave . q + phase)
struct Ripples {
    struct One {
        glm::dvec3 wave{0.0};
        double amplitude_m = 0.0, phase_rad = 0.0;
    };
    std::vector<One> one;
    double height_m(const glm::dvec3& q) const noexcept;
    glm::dvec3 gradient(const glm::dvec3& q) const noexcept;
};

/// A place of the smooth skin and the unit normal there, outward.
struct SkinPlace {
    glm::dvec3 place_m{0.0}, normal{0.0};
};

/// Three octaves of directions' waves, 3.5 mm at most together.
Ripples organ_ripples(std::uint64_t seed);
/// Where the organ's skin is in a direction from its centre, the origin: radius 60 mm + ripples.
SkinPlace organ_skin(const Ripples& ripples, const glm::dvec3& unit) noexcept;

/// Waves of 4 mm at most over x and y, 40 mm and more long.
Ripples sheet_ripples(std::uint64_t seed);
/// The sheet's upper skin over (x, y). Its middle is the ripples' height; the two skins lie half
/// the thickness off along z times sqrt(1 + |slope|^2), so half of it along the normal.
SkinPlace sheet_skin(const Ripples& ripples, double x_m, double y_m) noexcept;

} // namespace sim
