// sim/study/indent.h
// Static indentation of an organ at many places: what a slow press would feel there. Used to show
// that stiffness belongs to the tissue and not to the mesh: the same organ in two meshes.
#pragma once

#include "sim/check/rest_feel.h"

#include <string>

namespace sim {

struct IndentPoint {
    glm::dvec3 place_m{0.0}, normal{0.0}; // what it is pressed against
    double mesh_mpn = 0.0;                // H K^-1 H^T, along it
    double tangential_mpn = 0.0;          // the same across, mean of two directions
    double linear_mpn = 0.0;              // linear part of the sub-grid law (mesh term less kernel)
    std::vector<double> force_n{};        // at each depth asked for
};

/// Statics of one organ: its tangent at rest, factored once. Stays where it was made.
class Indenter {
  public:
    Indenter(const Indenter&) = delete;
    Indenter(std::shared_ptr<const tissue::BakedOrgan> organ, const tissue::Material& material,
             double tip_radius_m, tissue::Tier tier = tissue::Tier::corotated);

    /// Force at `depth_m` with the tip pressed along the skin's normal at the skin point nearest
    /// to `near_m`.
    IndentPoint press(const glm::dvec3& near_m, std::span<const double> depth_m);
    /// Against the unit vector `out` instead, as a tool presses that comes from there.
    IndentPoint press(const glm::dvec3& near_m, const glm::dvec3& out,
                      std::span<const double> depth_m);
    const Body& body() const { return body_; }

  private:
    Body body_;
    RestFeel feel_; // of body_
    double radius_m_;
};

/// Of all skin, or of that which no bed holds either: held skin lies against what holds it, and no
/// tool gets there.
enum class PressedSkin : std::uint8_t { all, free };

/// Seeded, area-weighted places on the skin that a footprint's radius of unanchored tissue
/// surrounds: none where the kernel reaches anchored nodes or, on free skin, lies for more than
/// half on tets of a bed. A bed under the whole body holds no part of it. Throws
/// std::invalid_argument if there is no such skin.
std::vector<glm::dvec3> random_places(const Body& body, int count, std::uint64_t seed,
                                      PressedSkin skin = PressedSkin::all);

/// A straight path of `length_m` over the skin from near `from_m`, `steps` + 1 places.
std::vector<glm::dvec3> slide_places(const Body& body, const glm::dvec3& from_m,
                                     const glm::dvec3& heading, double length_m, int steps);

} // namespace sim
