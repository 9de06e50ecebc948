// sim/study/contact_stand_ins.h
// Meshes of the size and character of those on which Gregory, Lin, Gottschalk and Taylor (1999)
// measured H-Collide, made by recipe: stand-ins, not their models. Metres; the same seed gives
// the same mesh.
#pragma once

#include "haptics/collision/mesh_view.h"

#include <array>
#include <string_view>
#include <vector>

namespace sim {

struct StandIn {
    std::string_view name, of; // `of`: what it stands in for
    std::vector<glm::dvec3> vertex_m;
    std::vector<haptics::Corners> triangle;
};

/// 12 000 triangles: a height field 0.1 m wide with bumps like atoms.
StandIn nano_surface(std::uint64_t seed);
/// 18 000 triangles at least, one part's more at most: boxes, tubes and discs as CAD tessellates
/// them, slivers next to large faces, a smooth body among them; 0.24 m long.
StandIn assembly(std::uint64_t seed);
/// 79 000 triangles: two wings, each with two sides at most 0.4 mm apart that meet at the rim;
/// 0.2 m across.
StandIn wing(std::uint64_t seed);

std::vector<StandIn> make_stand_ins(std::uint64_t seed);

} // namespace sim
