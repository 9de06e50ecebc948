#include "assets/bake/polygonise.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace bake {
namespace {

constexpr std::size_t kSpans = 8; // an edge runs from a grid point to one of 7 others above it
constexpr double kMargin = 1e-3;  // no cut nearer to a grid point, in cells

struct Grid {
    std::array<std::size_t, 3> count{};
    glm::dvec3 low_m{0.0};
    double cell_m = 0.0;
    std::vector<double> value;

    [[nodiscard]] std::size_t id(std::size_t i, std::size_t j, std::size_t k) const {
        return (k * count[1] + j) * count[0] + i;
    }
    [[nodiscard]] glm::dvec3 point(std::size_t id) const {
        const std::size_t i = id % count[0], j = id / count[0] % count[1],
                          k = id / (count[0] * count[1]);
        return low_m + cell_m * glm::dvec3{static_cast<double>(i), static_cast<double>(j),
                                           static_cast<double>(k)};
    }
};

Grid sample(const Field& field, const glm::dvec3& low, const glm::dvec3& high, double cell) {
    Grid grid;
    grid.low_m = low;
    grid.cell_m = cell;
    for (int d = 0; d < 3; ++d) {
        grid.count[d] = static_cast<std::size_t>(std::ceil((high[d] - low[d]) / cell)) + 1;
    }
    const auto [nx, ny, nz] = grid.count;
    grid.value.resize(nx * ny * nz);
    for (std::size_t id = 0; id < grid.value.size(); ++id) {
        const double v = field(grid.point(id));
        // never exactly zero: a surface through a grid point would not be manifold
        grid.value[id] = std::abs(v) < kMargin * cell ? kMargin * cell : v;
        const std::size_t i = id % nx, j = id / nx % ny, k = id / (nx * ny);
        const bool rim = i == 0 || j == 0 || k == 0 || i + 1 == nx || j + 1 == ny || k + 1 == nz;
        if (rim && grid.value[id] < 0.0) {
            throw std::invalid_argument("the body touches the box it is sampled in");
        }
    }
    return grid;
}

/// Corners of the six tetrahedra of a cell as bits (x = 1, y = 2, z = 4), each along a path
/// from 0 to 7 (Kuhn).
constexpr std::array<std::array<std::size_t, 4>, 6> kTets{
    {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}}};

struct Builder {
    const Grid& grid;
    Surface surface;
    std::vector<std::int32_t> cut = {}; // vertex on the edge (lower grid point, span), or -1

    std::uint32_t vertex(std::size_t a, std::size_t b, std::size_t span) {
        auto& slot = cut[a * kSpans + span];
        if (slot < 0) {
            const double t = grid.value[a] / (grid.value[a] - grid.value[b]);
            const glm::dvec3 pa = grid.point(a), pb = grid.point(b);
            slot = static_cast<std::int32_t>(surface.point_m.size());
            surface.point_m.push_back(pa + t * (pb - pa));
        }
        return static_cast<std::uint32_t>(slot);
    }
};

void add_tet(Builder& builder, const std::array<std::size_t, 8>& corner,
             const std::array<std::size_t, 4>& tet) {
    std::array<std::size_t, 4> order{};
    std::size_t inside = 0, outside = 4;
    for (std::size_t k = 0; k < 4; ++k) {
        const bool in = builder.grid.value[corner[tet[k]]] < 0.0;
        order[in ? inside++ : --outside] = k;
    }
    if (inside == 0 || inside == 4) {
        return;
    }
    const auto on = [&](std::size_t i, std::size_t j) {
        const std::size_t p = std::min(tet[order[i]], tet[order[j]]);
        const std::size_t q = std::max(tet[order[i]], tet[order[j]]);
        return builder.vertex(corner[p], corner[q], q - p);
    };
    // outward: away from an inside corner
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const auto& p = builder.surface.point_m;
        const glm::dvec3 in = builder.grid.point(corner[tet[order[0]]]);
        const double side = glm::dot(glm::cross(p[b] - p[a], p[c] - p[a]), p[a] - in);
        builder.surface.triangles.push_back(side > 0.0 ? tissue::Triangle{a, b, c}
                                                       : tissue::Triangle{a, c, b});
    };
    if (inside == 1) {
        add(on(0, 1), on(0, 2), on(0, 3));
    } else if (inside == 3) {
        add(on(0, 3), on(1, 3), on(2, 3));
    } else {
        const auto a = on(0, 2), b = on(0, 3), c = on(1, 3), d = on(1, 2);
        add(a, b, c);
        add(a, c, d);
    }
}

} // namespace

Surface polygonise(const Field& field, const glm::dvec3& low_m, const glm::dvec3& high_m,
                   double cell_m) {
    const Grid grid = sample(field, low_m, high_m, cell_m);
    Builder builder{.grid = grid, .surface = {}};
    builder.cut.assign(grid.value.size() * kSpans, -1);
    for (std::size_t k = 0; k + 1 < grid.count[2]; ++k) {
        for (std::size_t j = 0; j + 1 < grid.count[1]; ++j) {
            for (std::size_t i = 0; i + 1 < grid.count[0]; ++i) {
                std::array<std::size_t, 8> corner{};
                for (std::size_t c = 0; c < 8; ++c) {
                    corner[c] = grid.id(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1));
                }
                for (const auto& tet : kTets) {
                    add_tet(builder, corner, tet);
                }
            }
        }
    }
    if (builder.surface.triangles.empty()) {
        throw std::invalid_argument("the recipe describes no body");
    }
    return builder.surface;
}

} // namespace bake
