// sim/io/mesh_file.h
// A surface file as a triangle mesh for collision: the bytes in, connected triangles out. Called by
// commands; opens no file. Nothing is repaired: `trocar import` does that.
#pragma once

#include "haptics/collision/mesh_view.h"

#include <cstddef>
#include <string>
#include <vector>

namespace sim {

struct TriangleMesh {
    std::vector<glm::dvec3> vertex_m;
    std::vector<haptics::Corners> triangle;
};

/// 0.001, 0.01, 1 for "mm", "cm", "m"; throws std::invalid_argument.
double unit_m_of(const std::string& unit);

/// STL, OBJ, PLY or OFF by the end of the name. Points that are equal to the bit become one, as STL
/// knows no shared ones. Throws std::runtime_error naming the file and the line or byte.
TriangleMesh read_mesh(std::span<const std::byte> bytes, const std::string& file_name,
                       double unit_m);

} // namespace sim
