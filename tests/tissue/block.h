// tests/tissue/block.h
// The block of the contact tests: a box of tetrahedra, its bottom anchored, its top covered by a
// skin of small triangles.
#pragma once

#include "tissue/mesh/contact_surface.h"

namespace block {

inline tissue::ContactSurface grid_skin(const glm::dvec3& corner_m, double length_m, double width_m,
                                        int nx, int ny) {
    tissue::ContactSurface skin;
    for (int j = 0; j <= ny; ++j) {
        for (int i = 0; i <= nx; ++i)
            skin.rest_m.push_back(corner_m + glm::dvec3{length_m * i / nx, width_m * j / ny, 0.0});
    }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i + j * (nx + 1)); };
    for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) {
            skin.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            skin.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return skin;
}

/// The whole top of a box [0, size].
inline tissue::ContactSurface top_skin(const glm::dvec3& size_m, double edge_m) {
    return grid_skin({0, 0, size_m.z}, size_m.x, size_m.y, static_cast<int>(size_m.x / edge_m + .5),
                     static_cast<int>(size_m.y / edge_m + .5));
}

inline std::vector<std::uint8_t> bottom_anchored(const tissue::TetMesh& mesh) {
    std::vector<std::uint8_t> anchored;
    for (const glm::dvec3& x : mesh.rest_m)
        anchored.push_back(x.z < 1e-9);
    return anchored;
}

} // namespace block
