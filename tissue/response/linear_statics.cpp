// tissue/response/linear_statics.cpp
// Assembles K on linear and quadratic tetrahedra. Bake time and tests, any thread.
#include "tissue/response/linear_statics.h"

#include "tissue/material/elastic.h"
#include "tissue/mesh/quadratic_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

std::uint32_t mid_node(const LinearStatics& s, std::uint32_t a, std::uint32_t b) {
    const std::array<std::uint32_t, 3> key{std::min(a, b), std::max(a, b), 0};
    return (*std::lower_bound(s.mid.begin(), s.mid.end(), key))[2];
}

void number_mid_nodes(const TetMesh& mesh, LinearStatics& s) {
    for (const Tet& tet : mesh.tets) {
        for (const auto& [a, b] : kEdge)
            s.mid.push_back({std::min(tet[a], tet[b]), std::max(tet[a], tet[b]), 0});
    }
    std::sort(s.mid.begin(), s.mid.end());
    s.mid.erase(std::unique(s.mid.begin(), s.mid.end()), s.mid.end());
    for (std::size_t i = 0; i < s.mid.size(); ++i)
        s.mid[i][2] = static_cast<std::uint32_t>(mesh.rest_m.size() + i);
}

void number_unknowns(const TetMesh& mesh, std::span<const std::uint8_t> anchored,
                     LinearStatics& s) {
    for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
        s.dof.push_back(anchored[i] ? -1 : s.unknowns);
        s.unknowns += anchored[i] ? 0 : 3;
    }
    for (const auto& [low, high, node] : s.mid) {
        const bool fixed = anchored[low] && anchored[high];
        s.dof.push_back(fixed ? -1 : s.unknowns);
        s.unknowns += fixed ? 0 : 3;
    }
}

std::vector<std::uint32_t> element_nodes(const LinearStatics& s, const Tet& tet) {
    std::vector<std::uint32_t> nodes(tet.begin(), tet.end());
    if (s.order == 2) {
        for (const auto& [a, b] : kEdge)
            nodes.push_back(mid_node(s, tet[a], tet[b]));
    }
    return nodes;
}

// The unknowns come in threes: blocks are looked up per node, [column block][k] = row block.
using Blocks = std::vector<std::vector<int>>;

Blocks make_pattern(const TetMesh& mesh, LinearStatics& s) {
    Blocks blocks(s.unknowns / 3);
    for (const Tet& tet : mesh.tets) {
        const auto nodes = element_nodes(s, tet);
        for (const std::uint32_t a : nodes) {
            for (const std::uint32_t b : nodes) {
                if (s.dof[b] >= 0 && s.dof[a] >= s.dof[b])
                    blocks[s.dof[b] / 3].push_back(s.dof[a] / 3);
            }
        }
    }
    s.pattern.size = s.unknowns;
    s.pattern.column_start.assign(1, 0);
    for (std::size_t j = 0; j < blocks.size(); ++j) {
        std::sort(blocks[j].begin(), blocks[j].end());
        blocks[j].erase(std::unique(blocks[j].begin(), blocks[j].end()), blocks[j].end());
        for (int k = 0; k < 3; ++k) {
            for (const int i : blocks[j]) {
                for (int r = i == static_cast<int>(j) ? k : 0; r < 3; ++r)
                    s.pattern.row.push_back(3 * i + r);
            }
            s.pattern.column_start.push_back(static_cast<int>(s.pattern.row.size()));
        }
    }
    s.stiffness_m.assign(s.pattern.row.size(), 0.0);
    return blocks;
}

// Adds the lower part of block (row i, column j), i >= j, in units of nodes.
void add_block(const Blocks& blocks, int i, int j, const dmat3& K, LinearStatics& s) {
    const auto& column = blocks[j];
    const auto at = std::lower_bound(column.begin(), column.end(), i) - column.begin();
    for (int k = 0; k < 3; ++k) {
        // the diagonal block stores 3 - k rows of column k
        const std::ptrdiff_t first = s.pattern.column_start[3 * j + k] + 3 * at - (at > 0 ? k : 0);
        for (int r = i == j ? k : 0; r < 3; ++r)
            s.stiffness_m[first + r - (i == j ? k : 0)] += K[k][r];
    }
}

// Gradients of the shape functions where the barycentric coordinates are `l`:
// corners l_i (2 l_i - 1), edges 4 l_i l_j.
void shape_gradients(int order, const std::array<dvec3, 4>& corner, const std::array<double, 4>& l,
                     std::span<dvec3> gradient) {
    if (order == 1) {
        std::copy(corner.begin(), corner.end(), gradient.begin());
        return;
    }
    for (int i = 0; i < 4; ++i)
        gradient[i] = (4.0 * l[i] - 1.0) * corner[i];
    for (int e = 0; e < 6; ++e) {
        const auto [i, j] = kEdge[e];
        gradient[4 + e] = 4.0 * (l[i] * corner[j] + l[j] * corner[i]);
    }
}

// K_ab = int lambda g_a g_b^T + mu g_b g_a^T + mu (g_a . g_b) I; four points of degree 2, which
// is exact: gradients are linear on straight-edged quadratic tets.
void add_element(const TetMesh& mesh, const Tet& tet, const Lame& elastic, const Blocks& blocks,
                 LinearStatics& s) {
    const dvec3 origin = mesh.rest_m[tet[0]];
    const dmat3 edges{mesh.rest_m[tet[1]] - origin, mesh.rest_m[tet[2]] - origin,
                      mesh.rest_m[tet[3]] - origin};
    const dmat3 rows = glm::transpose(glm::inverse(edges));
    const std::array<dvec3, 4> corner{-rows[0] - rows[1] - rows[2], rows[0], rows[1], rows[2]};
    const double volume = glm::determinant(edges) / 6.0;
    const double far = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0, near = (5.0 - std::sqrt(5.0)) / 20.0;

    const auto nodes = element_nodes(s, tet);
    std::vector<dvec3> g(nodes.size());
    for (int q = 0; q < (s.order == 1 ? 1 : 4); ++q) {
        std::array<double, 4> l{near, near, near, near};
        l[q] = far;
        shape_gradients(s.order, corner, l, g);
        const double weight = volume / (s.order == 1 ? 1 : 4);
        for (std::size_t a = 0; a < nodes.size(); ++a) {
            for (std::size_t b = 0; b < nodes.size(); ++b) {
                const int i = s.dof[nodes[a]], j = s.dof[nodes[b]];
                if (j < 0 || i < j)
                    continue;
                const dmat3 K = elastic.lambda_pa * glm::outerProduct(g[a], g[b]) +
                                elastic.mu_pa * glm::outerProduct(g[b], g[a]) +
                                dmat3(elastic.mu_pa * glm::dot(g[a], g[b]));
                add_block(blocks, i / 3, j / 3, weight * K, s);
            }
        }
    }
}

// Shape functions at barycentric `l`, in the order of element_nodes().
void shape_values(int order, const std::array<double, 4>& l, std::span<double> value) {
    for (int i = 0; i < 4; ++i)
        value[i] = order == 1 ? l[i] : l[i] * (2.0 * l[i] - 1.0);
    for (int e = 0; order == 2 && e < 6; ++e)
        value[4 + e] = 4.0 * l[kEdge[e][0]] * l[kEdge[e][1]];
}

void add_bed(const TetMesh& mesh, std::span<const BedSample> bed, const Blocks& blocks,
             LinearStatics& s) {
    std::vector<double> value;
    for (const BedSample& sample : bed) {
        const auto nodes = element_nodes(s, mesh.tets[sample.tet]);
        value.assign(nodes.size(), 0.0);
        shape_values(s.order, sample.weight, value);
        for (std::size_t a = 0; a < nodes.size(); ++a) {
            for (std::size_t b = 0; b < nodes.size(); ++b) {
                const int i = s.dof[nodes[a]], j = s.dof[nodes[b]];
                if (j >= 0 && i >= j) {
                    add_block(blocks, i / 3, j / 3, dmat3(sample.stiffness_m * value[a] * value[b]),
                              s);
                }
            }
        }
    }
}

} // namespace

LinearStatics make_linear_statics(const TetMesh& mesh, int order, double poisson,
                                  std::span<const std::uint8_t> anchored,
                                  std::span<const BedSample> bed) {
    if (order != 1 && order != 2)
        throw std::invalid_argument("order = " + std::to_string(order) + ": must be 1 or 2");
    check_mesh(mesh);
    Material material;
    material.young_pa = 1.0;
    material.poisson = poisson;
    const Lame elastic = lame(material);

    LinearStatics s;
    s.order = order;
    if (order == 2)
        number_mid_nodes(mesh, s);
    number_unknowns(mesh, anchored, s);
    const Blocks blocks = make_pattern(mesh, s);
    for (const Tet& tet : mesh.tets)
        add_element(mesh, tet, elastic, blocks, s);
    add_bed(mesh, bed, blocks, s);
    return s;
}

SurfaceShape surface_shape(const LinearStatics& statics, const Triangle& triangle,
                           const dvec3& weight) {
    SurfaceShape shape;
    shape.count = statics.order == 1 ? 3 : 6;
    if (statics.order == 2)
        shape.value = triangle_shapes(weight);
    for (int i = 0; i < 3; ++i) {
        shape.node[i] = triangle[i];
        if (statics.order == 1)
            shape.value[i] = weight[i];
        else
            shape.node[3 + i] = mid_node(statics, triangle[i], triangle[(i + 1) % 3]);
    }
    return shape;
}

} // namespace tissue
