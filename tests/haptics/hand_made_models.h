// tests/haptics/hand_made_models.h
// Local models made by hand, of systems whose motion is known: what the tissue loop would
// publish, without a tissue loop.
#pragma once

#include "haptics/contact/local_model.h"

#include <memory>

/// A flat square patch in the plane z = centre.z, normals up, `cells` cells a side (at most 12).
inline void make_flat_patch(haptics::ToolPatch& patch, const glm::dvec3& centre_m, double side_m,
                            int cells) {
    patch.near = true;
    const int row = cells + 1;
    patch.vertices = row * row;
    for (int j = 0; j < row; ++j)
        for (int i = 0; i < row; ++i) {
            haptics::PatchVertex& v = patch.vertex[j * row + i];
            v.anchor_m = centre_m + side_m * glm::dvec3{static_cast<double>(i) / cells - 0.5,
                                                        static_cast<double>(j) / cells - 0.5, 0};
            v.normal = {0, 0, 1};
        }
    patch.triangles = 2 * cells * cells;
    const auto index = [](int k) { return static_cast<std::int16_t>(k); };
    for (int j = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i) {
            const int t = 2 * (j * cells + i); // below the diagonal; t + 1 above it
            const int a = j * row + i;
            haptics::PatchTriangle& low = patch.triangle[t];
            haptics::PatchTriangle& high = patch.triangle[t + 1];
            low.vertex = {index(a), index(a + 1), index(a + row + 1)};
            low.neighbour = {index(i + 1 < cells ? t + 3 : -1), index(t + 1),
                             index(j > 0 ? t - 2 * cells + 1 : -1)};
            high.vertex = {index(a), index(a + row + 1), index(a + row)};
            high.neighbour = {index(j + 1 < cells ? t + 2 * cells : -1), index(i > 0 ? t - 2 : -1),
                              index(t)};
        }
    // the middle: the vertex there, or the diagonal of the cell there
    patch.contact = {2 * (cells / 2 * cells + cells / 2),
                     cells % 2 == 0 ? glm::dvec3{1, 0, 0} : glm::dvec3{0.5, 0, 0.5}};
}

/// Every point of the patch moves by `motion` metres per unit of mode m of its body.
inline void set_uniform_mode(haptics::ToolPatch& patch, int m, const glm::dvec3& motion) {
    for (int v = 0; v < patch.vertices; ++v)
        for (int axis = 0; axis < 3; ++axis)
            patch.shape[v][axis][m] = motion[axis];
}

/// Zeroed models: half a megabyte, so not on the stack.
inline std::unique_ptr<haptics::LocalModels> empty_models() {
    return std::make_unique<haptics::LocalModels>();
}
