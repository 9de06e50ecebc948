// tissue/solver/corotated_model.cpp
// What never changes of a corotated body: shape functions, masses, and the sparse pattern with
// the place of each tet's blocks in it. Called once per body, at load.
#include "tissue/solver/corotated.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

// Free nodes that share a tet with each free node and come after it, ascending, as first unknowns.
std::vector<std::vector<std::int32_t>> later_neighbours(const CorotatedModel& m) {
    std::vector<std::vector<std::int32_t>> later(static_cast<std::size_t>(m.unknowns) / 3);
    for (const Tet& t : m.mesh.tets) {
        for (const std::uint32_t a : t) {
            for (const std::uint32_t b : t) {
                if (m.dof[a] >= 0 && m.dof[b] > m.dof[a])
                    later[m.dof[a] / 3].push_back(m.dof[b]);
            }
        }
    }
    for (std::vector<std::int32_t>& list : later) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return later;
}

// Three columns per node: what is left of the diagonal block, then three rows per neighbour.
SparsePattern node_pattern(int unknowns, const std::vector<std::vector<std::int32_t>>& later) {
    SparsePattern p;
    p.size = unknowns;
    p.column_start.push_back(0);
    for (int node = 0; node < unknowns / 3; ++node) {
        for (int c = 0; c < 3; ++c) {
            for (int r = c; r < 3; ++r)
                p.row.push_back(3 * node + r);
            for (const std::int32_t first : later[node]) {
                for (int r = 0; r < 3; ++r)
                    p.row.push_back(first + r);
            }
            p.column_start.push_back(static_cast<int>(p.row.size()));
        }
    }
    return p;
}

// Place of block (a, b) in the values: of its upper left entry, -1 if a node is anchored, and
// -2 - place if the pattern holds its transpose.
std::int32_t block_place(const SparsePattern& pattern, std::int32_t a, std::int32_t b) {
    if (a < 0 || b < 0)
        return -1;
    const std::int32_t column = std::min(a, b), row = std::max(a, b);
    const auto begin = pattern.row.begin() + pattern.column_start[column];
    const auto end = pattern.row.begin() + pattern.column_start[column + 1];
    const auto place =
        static_cast<std::int32_t>(std::lower_bound(begin, end, row) - pattern.row.begin());
    return a >= b ? place : -2 - place;
}

void number_unknowns(std::span<const std::uint8_t> anchored, CorotatedModel& m) {
    m.dof.assign(m.mesh.rest_m.size(), -1);
    for (std::size_t i = 0; i < m.dof.size(); ++i) {
        if (anchored.empty() || anchored[i] == 0) {
            m.dof[i] = m.unknowns;
            m.unknowns += 3;
        }
    }
}

void add_shapes_and_masses(CorotatedModel& m) {
    m.mass_kg.assign(m.mesh.rest_m.size(), 0.0);
    for (const Tet& t : m.mesh.tets) {
        const dvec3 x0 = m.mesh.rest_m[t[0]];
        const dmat3 edges{m.mesh.rest_m[t[1]] - x0, m.mesh.rest_m[t[2]] - x0,
                          m.mesh.rest_m[t[3]] - x0};
        // gradients of N1..N3 are the rows of the inverse edge matrix; N0 = 1 - N1 - N2 - N3
        const dmat3 rows = glm::transpose(glm::inverse(edges));
        m.gradient_1pm.push_back({-(rows[0] + rows[1] + rows[2]), rows[0], rows[1], rows[2]});
        m.volume_m3.push_back(glm::determinant(edges) / 6.0);
        for (const std::uint32_t node : t) {
            m.mass_kg[node] += m.material.density_kgpm3 * m.volume_m3.back() / 4.0;
        }
    }
    for (std::size_t i = 0; i < m.mass_kg.size(); ++i) {
        if (m.dof[i] >= 0 && !(m.mass_kg[i] > 0.0)) {
            throw std::invalid_argument("node " + std::to_string(i) +
                                        " has no mass: no tet uses it");
        }
    }
}

constexpr std::array<std::array<int, 2>, 10> kPair{
    {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

// Samples of one tet follow each other.
void add_bed(std::span<const BedSample> bed, CorotatedModel& m) {
    for (const BedSample& sample : bed) {
        if (sample.tet >= m.mesh.tets.size())
            throw std::invalid_argument("the bed names tet " + std::to_string(sample.tet) + " of " +
                                        std::to_string(m.mesh.tets.size()));
        if (m.held.empty() || m.held.back().tet != sample.tet)
            m.held.push_back({sample.tet, {}});
        for (int k = 0; k < 10; ++k) {
            m.held.back().npm[k] += m.material.young_pa * sample.stiffness_m *
                                    sample.weight[kPair[k][0]] * sample.weight[kPair[k][1]];
        }
    }
}

} // namespace

CorotatedModel make_corotated(const TetMesh& mesh, const Material& material,
                              std::span<const std::uint8_t> anchored, const dvec3& gravity_mps2,
                              std::span<const BedSample> bed) {
    check_mesh(mesh);
    if (!anchored.empty() && anchored.size() != mesh.rest_m.size()) {
        throw std::invalid_argument("anchors for " + std::to_string(anchored.size()) +
                                    " nodes: the mesh has " + std::to_string(mesh.rest_m.size()));
    }
    if (!material.prony.empty()) {
        throw std::invalid_argument("prony has " + std::to_string(material.prony.size()) +
                                    " terms: corotated tissue has no memory, quadratic tissue has");
    }
    CorotatedModel m;
    m.mesh = mesh;
    m.material = material;
    const Lame constants = lame(material);
    m.lambda_pa = constants.lambda_pa;
    m.mu_pa = constants.mu_pa;
    m.gravity_mps2 = gravity_mps2;
    number_unknowns(anchored, m);
    if (m.unknowns == 0)
        throw std::invalid_argument("every node is anchored: nothing can move");
    add_shapes_and_masses(m);
    add_bed(bed, m);

    m.pattern = node_pattern(m.unknowns, later_neighbours(m));
    for (const Tet& t : mesh.tets) {
        const std::array<std::int32_t, 4> d{m.dof[t[0]], m.dof[t[1]], m.dof[t[2]], m.dof[t[3]]};
        const auto place = [&](int a, int b) { return block_place(m.pattern, d[a], d[b]); };
        m.block.push_back({place(0, 0), place(1, 1), place(2, 2), place(3, 3), place(0, 1),
                           place(0, 2), place(0, 3), place(1, 2), place(1, 3), place(2, 3)});
    }
    return m;
}

CorotatedState rest_state(const CorotatedModel& model) {
    return {model.mesh.rest_m, std::vector<dvec3>(model.mesh.rest_m.size(), dvec3{0.0})};
}

CorotatedSystem make_system(const CorotatedModel& model) {
    const auto n = static_cast<std::size_t>(model.unknowns);
    return {.internal_n = std::vector<double>(n),
            .stiffness = std::vector<double>(model.pattern.row.size()),
            .matrix = std::vector<double>(model.pattern.row.size()),
            .work = std::vector<double>(2 * n),
            .factor = SparseFactor(model.pattern)};
}

} // namespace tissue
