#include "assets/bake/shape_sheet.h"

#include "assets/bake/shape.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <vector>

namespace bake {
namespace {

constexpr double kMm = 1e-3;

double sqr(double x) {
    return x * x;
}

/// 0 at the edge, 1 from `reach` on, round like the edge of a lens.
double rise(double inside_mm, double reach_mm) {
    return 1.0 - sqr(std::max(0.0, 1.0 - inside_mm / reach_mm));
}

/// Box [0, size] to the sheet, in millimetres, before it is turned; z from the rest plane.
glm::dvec3 shaped_mm(const SheetShape& s, const glm::dvec3& p) {
    const double side = p.x < 0.5 * s.size_mm.x ? 1.0 : -1.0; // inwards
    const double from_side = std::min(p.x, s.size_mm.x - p.x), from_end = p.y;
    const double reach = kCornerReach * s.corner_mm;
    const double in_corner = reach > 0.0 ? sqr(std::max(0.0, 1.0 - from_side / reach)) *
                                               sqr(std::max(0.0, 1.0 - from_end / reach))
                                         : 0.0;
    const double inner = rise(from_side, s.taper_mm) * rise(from_end, s.taper_mm);
    const double thick = s.edge_thickness_mm + (s.size_mm.z - s.edge_thickness_mm) * inner;
    const double u = 2.0 * p.x / s.size_mm.x - 1.0, v = 2.0 * p.y / s.size_mm.y - 1.0;
    const double noise = smooth_noise({p.x, p.y, 0.0}, s.noise_wavelength_mm, s.seed);
    const double lift =
        s.bulge_mm * (1.0 - u * u) * (1.0 - v * v) + 0.5 * s.noise_mm * (1.0 + noise);
    return {p.x + side * s.corner_mm * in_corner, p.y + s.corner_mm * in_corner,
            lift + thick * p.z / s.size_mm.z};
}

/// Where the lines of a lattice run from the free edge at 0 to `length`: even, but where a cell is
/// wider than follows the taper the first is pulled outwards. If the other edge is free too so is
/// the last, with even cells between; else the others stay, for it is at the hinge that it bends.
std::vector<double> lines_mm(double length, int cells, double taper, bool both) {
    const double even = length / cells;
    const double beside = std::max(kTaperShare * taper, kNarrowest * even);
    std::vector<double> at;
    for (int i = 0; i <= cells; ++i) {
        at.push_back(even * i);
    }
    if (even <= beside || cells <= (both ? 2 : 1)) {
        return at;
    }
    at[1] = beside;
    for (int i = 2; both && i < cells; ++i) {
        at[i] = beside + (length - 2.0 * beside) * (i - 1) / (cells - 2);
    }
    return at;
}

void place(const SheetShape& shape, std::vector<glm::dvec3>& point_m) {
    const glm::dmat3 turned = turn(shape.tilt_deg);
    for (glm::dvec3& p : point_m) {
        p = kMm * (shape.centre_mm + turned * (shaped_mm(shape, p / kMm) - 0.5 * shape.size_mm));
    }
}

} // namespace

Surface sheet_surface(const SheetShape& shape, double edge_m) {
    Surface surface = box_surface(kMm * shape.size_mm, edge_m);
    place(shape, surface.point_m);
    return surface;
}

tissue::TetMesh sheet_mesh(const SheetShape& shape) {
    const auto [nx, ny, nz] = shape.cells;
    tissue::TetMesh mesh = tissue::box_mesh(kMm * shape.size_mm, shape.cells);
    const auto x_mm = lines_mm(shape.size_mm.x, nx, shape.taper_mm, true);
    const auto y_mm = lines_mm(shape.size_mm.y, ny, shape.taper_mm, false);
    for (std::size_t node = 0; node < mesh.rest_m.size(); ++node) {
        mesh.rest_m[node].x = kMm * x_mm[node % (nx + 1)];
        mesh.rest_m[node].y = kMm * y_mm[node / (nx + 1) % (ny + 1)];
    }
    mesh.tets.clear();
    // the tetrahedra of both halves, the second one seen in a mirror
    const int left = nx / 2;
    for (const bool mirrored : {false, true}) {
        const int width = mirrored ? nx - left : left;
        if (width == 0) {
            continue;
        }
        const auto half = tissue::box_mesh(glm::dvec3{1.0}, {width, ny, nz});
        for (tissue::Tet t : half.tets) {
            for (std::uint32_t& node : t) {
                const std::uint32_t row = node / (width + 1), i = node % (width + 1);
                node = row * (nx + 1) + (mirrored ? nx - i : i);
            }
            if (mirrored) {
                std::swap(t[2], t[3]);
            }
            mesh.tets.push_back(t);
        }
    }
    place(shape, mesh.rest_m);
    return mesh;
}

} // namespace bake
