// tissue/mesh/tet_mesh.cpp
// Facts about tetrahedra. Called at load and bake time and by tests; volume_m3 by anyone.
#include "tissue/mesh/tet_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dvec3;

// Faces of a positive tet, counter-clockwise from outside; face k lies opposite corner k.
constexpr std::array<std::array<int, 3>, 4> kFace{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

double six_volumes(const Tet& t, std::span<const dvec3> x) noexcept {
    return glm::dot(glm::cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]), x[t[3]] - x[t[0]]);
}

// Uniform in [-1, 1), the same on every machine (SplitMix64, Steele et al. 2014).
double signed_unit(std::uint64_t& state) noexcept {
    std::uint64_t z = (state += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
}

// The corners of one grid cell along the six monotone paths from its low to its high corner.
void add_kuhn_cell(const std::array<std::uint32_t, 3>& stride, std::uint32_t low,
                   std::vector<Tet>& tets) {
    constexpr std::array<std::array<int, 3>, 6> kPath{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}}};
    for (std::size_t p = 0; p < kPath.size(); ++p) {
        const std::uint32_t a = low + stride[kPath[p][0]];
        const std::uint32_t b = a + stride[kPath[p][1]];
        const std::uint32_t high = b + stride[kPath[p][2]];
        // odd permutations of the axes turn the tet inside out
        tets.push_back(p < 3 ? Tet{low, a, b, high} : Tet{low, b, a, high});
    }
}

} // namespace

std::vector<Triangle> boundary_triangles(const TetMesh& mesh) {
    struct Face {
        Triangle key;      // sorted nodes
        std::size_t order; // 4 tet + face
    };
    std::vector<Face> faces;
    faces.reserve(4 * mesh.tets.size());
    for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
            Triangle key{mesh.tets[i][kFace[k][0]], mesh.tets[i][kFace[k][1]],
                         mesh.tets[i][kFace[k][2]]};
            std::sort(key.begin(), key.end());
            faces.push_back({key, 4 * i + k});
        }
    }
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
        return a.key != b.key ? a.key < b.key : a.order < b.order;
    });

    // a face that only one tet has is on the boundary
    std::vector<std::size_t> single;
    for (std::size_t i = 0; i < faces.size();) {
        std::size_t end = i + 1;
        while (end < faces.size() && faces[end].key == faces[i].key)
            ++end;
        if (end == i + 1)
            single.push_back(faces[i].order);
        i = end;
    }
    std::sort(single.begin(), single.end());

    std::vector<Triangle> triangles;
    triangles.reserve(single.size());
    for (const std::size_t order : single) {
        const Tet& t = mesh.tets[order / 4];
        const std::array<int, 3>& f = kFace[order % 4];
        triangles.push_back({t[f[0]], t[f[1]], t[f[2]]});
    }
    return triangles;
}

double volume_m3(const TetMesh& mesh, std::span<const dvec3> position_m) {
    double sum = 0.0;
    for (const Tet& t : mesh.tets)
        sum += six_volumes(t, position_m);
    return sum / 6.0;
}

void check_mesh(const TetMesh& mesh) {
    for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
        for (const std::uint32_t node : mesh.tets[i]) {
            if (node >= mesh.rest_m.size()) {
                throw std::invalid_argument(
                    "tet " + std::to_string(i) + " names node " + std::to_string(node) + " of " +
                    std::to_string(mesh.rest_m.size()) + ": nodes count from 0");
            }
        }
        const double volume = six_volumes(mesh.tets[i], mesh.rest_m) / 6.0;
        if (!(volume > 0.0) || !std::isfinite(volume)) {
            throw std::invalid_argument("tet " + std::to_string(i) + " has volume " +
                                        std::to_string(volume * 1e9) + " mm3: must be positive");
        }
    }
}

TetMesh box_mesh(const dvec3& size_m, const std::array<int, 3>& cells, double jitter,
                 std::uint64_t seed) {
    for (int axis = 0; axis < 3; ++axis) {
        if (cells[axis] < 1 || !(size_m[axis] > 0.0)) {
            throw std::invalid_argument("box: axis " + std::to_string(axis) +
                                        " needs a positive size and at least one cell");
        }
    }
    const auto nx = static_cast<std::uint32_t>(cells[0]), ny = static_cast<std::uint32_t>(cells[1]),
               nz = static_cast<std::uint32_t>(cells[2]);
    const dvec3 cell_m = size_m / dvec3(cells[0], cells[1], cells[2]);
    const std::array<std::uint32_t, 3> stride{1, nx + 1, (nx + 1) * (ny + 1)};

    TetMesh mesh;
    mesh.rest_m.reserve((nx + 1) * (ny + 1) * (nz + 1));
    std::uint64_t random = seed;
    for (std::uint32_t k = 0; k <= nz; ++k) {
        for (std::uint32_t j = 0; j <= ny; ++j) {
            for (std::uint32_t i = 0; i <= nx; ++i) {
                dvec3 grid(i, j, k);
                const bool interior = i > 0 && i < nx && j > 0 && j < ny && k > 0 && k < nz;
                if (interior && jitter > 0.0) {
                    for (int axis = 0; axis < 3; ++axis)
                        grid[axis] += jitter * signed_unit(random);
                }
                mesh.rest_m.push_back(grid * cell_m);
            }
        }
    }
    mesh.tets.reserve(6u * nx * ny * nz);
    for (std::uint32_t k = 0; k < nz; ++k) {
        for (std::uint32_t j = 0; j < ny; ++j) {
            for (std::uint32_t i = 0; i < nx; ++i) {
                add_kuhn_cell(stride, i + stride[1] * j + stride[2] * k, mesh.tets);
            }
        }
    }
    return mesh;
}

} // namespace tissue
