#include "assets/bake/shape_tube.h"

#include "assets/bake/centreline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bake {
namespace {

using std::numbers::pi;

constexpr double kMm = 1e-3;
constexpr int kFewestRound = 8; // sides of the skin, however thin the tube

std::vector<Station> stations_apart(const TubeShape& shape, double edge_m) {
    const double pieces = std::round(kMm * line_length_mm(shape.point_mm) / edge_m);
    return stations(shape.point_mm, std::max(1, static_cast<int>(pieces)) + 1);
}

double radius_mm(const TubeShape& shape, const Station& at) {
    return shape.radius_mm + at.share * (shape.radius_end_mm - shape.radius_mm);
}

glm::dvec3 on_ring_m(const Station& at, double radius_mm, double angle) {
    return kMm * (at.place_mm + radius_mm * (std::cos(angle) * at.side + std::sin(angle) * at.up));
}

// Radius of a polygon as large as a circle of radius 1.
double polygon_radius(int sides) {
    return std::sqrt(2.0 * pi / (sides * std::sin(2.0 * pi / sides)));
}

// The same for polygons that turn by half a side from one to the next, with triangles between
// them: the mean of their sections is n sin(pi/n) (1 + 2 cos(pi/n)) / 3 (antiprism).
double turning_polygon_radius(int sides) {
    const double half = pi / sides;
    return std::sqrt(3.0 * pi / (sides * std::sin(half) * (1.0 + 2.0 * std::cos(half))));
}

// Three tetrahedra of the wedge between the triangle `low` and its copy `step` nodes on. Diagonals
// of the sides run from the first corner below to the last above, so that wedges which share a
// side and order its corners alike share the diagonal too.
void add_wedge(const std::array<std::uint32_t, 3>& low, std::uint32_t step, tissue::TetMesh& mesh) {
    const auto [a, b, c] = low;
    for (tissue::Tet t : {tissue::Tet{a, b, c, c + step}, tissue::Tet{a, b, b + step, c + step},
                          tissue::Tet{a, a + step, b + step, c + step}}) {
        const auto& x = mesh.rest_m;
        if (glm::dot(glm::cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]), x[t[3]] - x[t[0]]) < 0.0) {
            std::swap(t[2], t[3]);
        }
        mesh.tets.push_back(t);
    }
}

// Triangles between ring `first` and the next one, which lies half a side further if `ahead`,
// else half a side back.
void add_band(std::uint32_t first, std::uint32_t sides, bool ahead, Surface& surface) {
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t j = (i + 1) % sides;
        const std::uint32_t a = first + i, b = first + j, c = a + sides, d = b + sides;
        if (ahead) {
            surface.triangles.insert(surface.triangles.end(), {{a, b, c}, {b, d, c}});
        } else {
            surface.triangles.insert(surface.triangles.end(), {{a, d, c}, {a, b, d}});
        }
    }
}

void add_end(std::uint32_t first, std::uint32_t sides, const glm::dvec3& middle_m, bool last,
             Surface& surface) {
    const auto middle = static_cast<std::uint32_t>(surface.point_m.size());
    surface.point_m.push_back(middle_m);
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t a = first + i, b = first + (i + 1) % sides;
        surface.triangles.push_back(last ? tissue::Triangle{a, b, middle}
                                         : tissue::Triangle{b, a, middle});
    }
}

} // namespace

Surface tube_surface(const TubeShape& shape, double edge_m) {
    const auto list = stations_apart(shape, edge_m);
    const double widest_mm = std::max(shape.radius_mm, shape.radius_end_mm);
    const int sides =
        std::max(kFewestRound, static_cast<int>(std::lround(2.0 * pi * kMm * widest_mm / edge_m)));
    const double wide = turning_polygon_radius(sides);
    const auto n = static_cast<std::uint32_t>(sides);
    const auto rings = static_cast<std::uint32_t>(list.size());

    Surface surface;
    for (std::uint32_t k = 0; k < rings; ++k) {
        for (int i = 0; i < sides; ++i) {
            const double angle = 2.0 * pi * (i + (k % 2 == 1 ? 0.5 : 0.0)) / sides;
            surface.point_m.push_back(on_ring_m(list[k], wide * radius_mm(shape, list[k]), angle));
        }
    }
    for (std::uint32_t k = 0; k + 1 < rings; ++k) {
        add_band(k * n, n, k % 2 == 0, surface);
    }
    add_end(0, n, kMm * list.front().place_mm, false, surface);
    add_end((rings - 1) * n, n, kMm * list.back().place_mm, true, surface);
    return surface;
}

tissue::TetMesh tube_mesh(const TubeShape& shape, double edge_m) {
    const auto list = stations_apart(shape, edge_m);
    const double wide = polygon_radius(shape.sides);
    const auto sides = static_cast<std::uint32_t>(shape.sides), step = sides + 1;

    tissue::TetMesh mesh;
    for (const Station& at : list) {
        mesh.rest_m.push_back(kMm * at.place_mm);
        for (int i = 0; i < shape.sides; ++i) {
            mesh.rest_m.push_back(
                on_ring_m(at, wide * radius_mm(shape, at), 2.0 * pi * i / shape.sides));
        }
    }
    for (std::uint32_t k = 0; k + 1 < list.size(); ++k) {
        for (std::uint32_t i = 0; i < sides; ++i) {
            const std::uint32_t j = (i + 1) % sides;
            std::array<std::uint32_t, 3> low{k * step, k * step + 1 + std::min(i, j),
                                             k * step + 1 + std::max(i, j)};
            if (k % 2 == 1) { // the other diagonals, so that the tube does not prefer a screw
                std::reverse(low.begin(), low.end());
            }
            add_wedge(low, step, mesh);
        }
    }
    return mesh;
}

tissue::RodLine tube_line(const TubeShape& shape, double edge_m) {
    tissue::RodLine line;
    for (const Station& at : stations_apart(shape, edge_m)) {
        line.node_m.push_back(kMm * at.place_mm);
        line.radius_m.push_back(kMm * radius_mm(shape, at));
    }
    line.held.assign(line.node_m.size(), 0);
    line.hold_m.assign(line.node_m.size(), 0.0);
    return line;
}

} // namespace bake
