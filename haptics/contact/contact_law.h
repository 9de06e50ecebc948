// haptics/contact/contact_law.h
// How deep a spherical tip sinks into tissue beyond what the tissue model itself yields: the
// sub-grid part of contact, a non-linear spring in series with the rows of contact_rows.h.
// A table per tip radius and material, filled once by sim/bridge; read by both loops.
//
//   depth(P) = D(P, T) + linear * P        D: sphere on a layer of thickness T (Sneddon; Hayes)
//   monotone in P, steep at first contact, slope never below the coupling floor 1/Kc
// Where tissue at finite strain would bring the slope below the floor, it goes on along the floor.
#pragma once

#include <array>

namespace haptics {

/// D as g(x) = D/x over x = cbrt(P / force_scale), which is smooth where D itself is not.
/// Rows: levels of tip radius over tissue thickness, ascending, first 0 (thick tissue).
struct IndenterTable {
    static constexpr int kLevels = 10;
    static constexpr int kEntries = 257;

    double force_scale_n = 0.0;   // E a^2 / (1 - nu^2)
    double x_step = 0.0;          // entry i stands at x = i * x_step
    double tangential_m2pn = 0.0; // C_t = this / a_c + linear part
    std::array<double, kLevels> radius_over_thickness{};
    std::array<std::array<double, kEntries>, kLevels> depth_over_x_m{};
    std::array<std::array<double, kEntries>, kLevels> contact_radius_m{};
    std::array<double, kLevels> punch_mpn{}; // a flat punch of the tip's radius, at small strain
};

/// The law at one place. No table: a rigid body, `normal_mpn` alone.
struct LocalLaw {
    const IndenterTable* table = nullptr; // not owned; outlives every use
    double radius_over_thickness = 0.0;
    double normal_mpn = 0.0;     // may be negative: D's slope outweighs it
    double tangential_mpn = 0.0; // may be negative: the sum is floored
    double floor_mpn = 0.0;      // 1/Kc: the coupling stiffness is never above Kc
};

/// Depth and its slope at x >= 0, P = force_scale x^3 (rigid: x is P in newtons).
/// Any thread, real-time safe.
struct LawPoint {
    double force_n;
    double depth_m;
    double dforce_dx;
    double ddepth_dx;
};
LawPoint law_at(const LocalLaw& law, double x) noexcept;

/// Tangential compliance in m/N at normal-force coordinate x, never below the floor.
double tangential_compliance(const LocalLaw& law, double x) noexcept;

/// The disc by which jaws hold skin: of the area of a face, 16 x 5 mm. Design value.
inline constexpr double kHeldRadius_m = 5e-3;

/// Compliances in m/N of a disc of that radius stuck to the skin, beyond what the tissue model
/// itself yields: the law's flat punch, scaled by the radius. Needs a table.
struct GraspCompliance {
    double normal_mpn;
    double tangential_mpn;
};
GraspCompliance grasp_compliance(const LocalLaw& law) noexcept;

/// Radius of the contact disc at x, m; of a rigid body 0.
double contact_radius(const LocalLaw& law, double x) noexcept;

} // namespace haptics
