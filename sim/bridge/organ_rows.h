// sim/bridge/organ_rows.h
// Where organs meet each other and the scenery: a row for every vertex of a skin that is over, or
// nearly over, or in, another skin. Made at setup, found anew in every FEM step by tissue_loop.cpp.
//
// Skins are a little soft, and each vertex pushes for the area around it,
//   force = k area max(0, zero - gap),  k = E / 0.1 mm
// with E of the softer body: what presses tissue flat, E, leaves 0.1 mm. So forces are unique and
// spread as a pressure does, a row comes and goes at force zero, and no row has to be chosen. How
// much it counts goes smoothly to nothing where skins turn away from each other and beside the rim.
//
// `zero` is the gap at rest where bodies were baked into each other: nothing ever pushes at rest.
// What lies deeper in the other body than kBuried_m at rest never meets it.
//
// Frictionless. Edges that cross edges are not looked for: skins are finer than what they lie on.
#pragma once

#include "sim/bridge/faced_skin.h"
#include "tissue/response/skin_turn.h"

namespace sim {

struct OrganRow {
    std::int32_t vertex_of = 0, skin_of = 0; // bodies
    std::uint32_t vertex = 0;
    tissue::ContactPoint at; // what of the other skin it is over
    glm::dvec3 normal{0.0};  // out of that skin; the vertex is pushed along it
    double gap_m = 0.0;      // beyond its zero, as the step begins
    double share = 0.0;      // 0..1, how much it counts
    double stiffness_npm = 0.0;
    double force_n = 0.0;
    tissue::SkinTurn own_turn;               // of the vertex
    std::array<tissue::SkinTurn, 3> at_turn; // of the corners below it
};

/// All vertices of one body against the skin of another.
struct SkinPair {
    std::int32_t vertex_of = 0, skin_of = 0;
    double pressure_npm3 = 0.0; // k
    double most_area_m2 = 0.0;  // a vertex of coarse scenery counts for no more
    std::vector<double> zero_m; // by vertex, <= 0; minus infinity: never meets
    // how far from the skin the vertex was when last looked at, where it was, and the skin's way
    std::vector<double> clear_m, clear_way_m;
    std::vector<glm::dvec3> clear_at_m;
    std::vector<double> force_n; // of the step before
    double next_m = -1.0;        // until both have gone so far nothing is near; -1: never looked
    std::size_t first = 0, count = 0; // its rows
};

struct OrganRows {
    std::vector<SkinTree> skin;                // by body
    std::vector<std::vector<double>> area_m2;  // by body and vertex
    std::vector<std::vector<double>> deep_m;   // how deep it may be found
    std::vector<double> way_m, last_m, tool_m; // by body: moved so far, in the last step, by tools
    std::vector<std::uint8_t> still;           // by body: neither moves nor did
    std::vector<SkinPair> pair;
    std::vector<OrganRow> row, before; // room for kMostRows
    std::size_t looked = 0;            // counts vertices looked at, for tests
    std::size_t left_out = 0;          // rows that there was no room for
};
inline constexpr std::size_t kMostRows = 4096;
inline constexpr double kBuried_m = 3e-3;

/// Setup, bodies at rest.
OrganRows make_organ_rows(std::span<const Body> bodies);

/// The rows of this step; `tool_m` says how far tools may push each body in it. What is still costs
/// nothing and keeps its rows. Real-time safe.
void find_organ_rows(std::span<const Body> bodies, OrganRows& rows) noexcept;

} // namespace sim
