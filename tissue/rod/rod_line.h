// tissue/rod/rod_line.h
// The line of a tube as it is baked: nodes, radii, and what holds it. Made by bake, held otherwise
// by a scene; what the tissue loop steps is made of it at setup.
//   hold   where a region of tissue is fixed elastically, energy 1/2 (E/L^2) int |u|^2 dV as
//          elastic_bed.h has it: over a round section, E A/L^2 per length across and along, and
//          E A/L^2 r^2/2 against turning about itself
//   bed    a medium around all of it, k per length (Winkler), k r^2/2 against turning
#pragma once

#include "tissue/rod/rod.h"

#include <functional>

namespace tissue {

struct RodLine {
    std::vector<glm::dvec3> node_m; // empty: there is no rod
    std::vector<double> radius_m;   // per node
    std::vector<std::uint8_t> held; // per node, 1 = fixed in place
    std::vector<double> hold_m;     // per node: times E, N/m
    double bed_pa = 0.0;            // k of the medium, N/m per m
};

/// Sets `hold_m`, and fixes nothing, where the line is `inside` (of a rest place, metres).
/// `length_m` > 0 is L, else std::invalid_argument. Any thread, not real time.
void hold_line(const std::function<bool(const glm::dvec3&)>& inside, double length_m,
               RodLine& line);

/// Fixes the nodes that are inside instead.
void fix_line(const std::function<bool(const glm::dvec3&)>& inside, RodLine& line);

/// Springs of hold and bed together, N/m, and how much of the volume is held, m^3.
double hold_npm(const RodLine& line, double young_pa);
double volume_m3(const RodLine& line);

/// Whether it has a place of its own: two fixed nodes in a row, or springs.
bool has_hold(const RodLine& line) noexcept;

/// Throws as make_rod(), hold_by() and round_section() do, and std::invalid_argument for sizes
/// that do not fit and a material with a memory, which rods do not have.
RodModel make_rod(const RodLine& line, const Material& material, const glm::dvec3& gravity_mps2);

} // namespace tissue
