// tests/tissue/touched_body.h
// A block clamped below with a skin above, for the tests of contact rows and of the basis.
#pragma once

#include "tests/tissue/bodies.h"
#include "tissue/response/contact_rows.h"

namespace bodies {

/// Hangs every vertex of `s` on the nodes within `radius_m` of it, with weights falling linearly,
/// sum 1. Offsets turn with the first boundary triangle of the mesh.
inline void hang(const tissue::TetMesh& mesh, double radius_m, tissue::ContactSurface& s) {
    const tissue::Triangle frame = tissue::boundary_triangles(mesh).front();
    s.neighbours = tissue::triangle_neighbours(s.triangles);
    s.row_start = {0};
    for (const glm::dvec3& x : s.rest_m) {
        const std::size_t first = s.row_weight.size();
        double sum = 0.0;
        glm::dvec3 carried{0.0};
        for (std::uint32_t i = 0; i < mesh.rest_m.size(); ++i) {
            const double w = 1.0 - glm::length(mesh.rest_m[i] - x) / radius_m;
            if (w <= 0.0)
                continue;
            s.row_node.push_back(i);
            s.row_weight.push_back(w);
            sum += w;
        }
        for (std::size_t k = first; k < s.row_weight.size(); ++k) {
            s.row_weight[k] /= sum;
            carried += s.row_weight[k] * mesh.rest_m[s.row_node[k]];
        }
        s.row_start.push_back(static_cast<std::uint32_t>(s.row_node.size()));
        s.offset_m.push_back(x - carried);
        s.frame_node.push_back(frame);
    }
}

/// The boundary of `mesh` as a skin.
inline tissue::ContactSurface skin_of(const tissue::TetMesh& mesh, double radius_m) {
    tissue::ContactSurface s;
    s.rest_m = mesh.rest_m;
    s.triangles = tissue::boundary_triangles(mesh);
    hang(mesh, radius_m, s);
    return s;
}

/// The top of a box as a skin of 2 mm triangles, finer than the mesh.
inline tissue::ContactSurface fine_top(const tissue::TetMesh& mesh, const glm::dvec3& size_m,
                                       double radius_m) {
    constexpr std::uint32_t kCells = 40;
    tissue::ContactSurface s;
    for (std::uint32_t j = 0; j <= kCells; ++j) {
        for (std::uint32_t i = 0; i <= kCells; ++i) {
            s.rest_m.push_back({size_m.x * i / kCells, size_m.y * j / kCells, size_m.z});
            if (i == kCells || j == kCells)
                continue;
            const std::uint32_t v = i + (kCells + 1) * j, up = v + kCells + 1;
            s.triangles.push_back({v, v + 1, up + 1});
            s.triangles.push_back({v, up + 1, up});
        }
    }
    hang(mesh, radius_m, s);
    return s;
}

struct TouchedBlock {
    tissue::TetMesh mesh;
    tissue::CorotatedModel model;
    tissue::ContactSurface skin;
};

inline TouchedBlock touched_block(const std::array<int, 3>& cells, const tissue::Material& m) {
    const glm::dvec3 size{0.08, 0.08, 0.04};
    TouchedBlock b{tissue::box_mesh(size, cells, 0.15), {}, {}};
    b.model = tissue::make_corotated(b.mesh, m, anchors(b.mesh, [](auto x) { return x.z < 1e-9; }));
    b.skin = fine_top(b.mesh, size, 1.75 * size.x / cells[0]);
    return b;
}

/// The point of the top face above (x, y).
inline tissue::ContactPoint on_top(const TouchedBlock& b, double x_m, double y_m) {
    for (std::uint32_t t = 0; t < b.skin.triangles.size(); ++t) {
        const tissue::Triangle& v = b.skin.triangles[t];
        const glm::dvec3 p = b.skin.rest_m[v[0]], q = b.skin.rest_m[v[1]], r = b.skin.rest_m[v[2]];
        const double area = (q.x - p.x) * (r.y - p.y) - (r.x - p.x) * (q.y - p.y);
        const double wq = ((x_m - p.x) * (r.y - p.y) - (r.x - p.x) * (y_m - p.y)) / area;
        const double wr = ((q.x - p.x) * (y_m - p.y) - (x_m - p.x) * (q.y - p.y)) / area;
        if (wq < -1e-12 || wr < -1e-12 || wq + wr > 1 + 1e-12)
            continue;
        return {t, {1 - wq - wr, wq, wr}};
    }
    return {};
}

} // namespace bodies
