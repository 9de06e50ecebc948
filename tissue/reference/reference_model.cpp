// tissue/reference/reference_model.cpp
// What never changes of a reference body: shape gradients, consistent mass, sparse patterns and
// the place of each tet's blocks in them. Called at setup.
#include "tissue/reference/reference_element.h"
#include "tissue/reference/tet10.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

void check_nodes(const QuadraticMesh& mesh) {
    std::vector<std::uint8_t> used(mesh.rest_m.size(), 0);
    for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
        for (const std::uint32_t node : mesh.tets[i]) {
            if (node >= mesh.rest_m.size()) {
                throw std::invalid_argument(
                    "tet " + std::to_string(i) + " names node " + std::to_string(node) + " of " +
                    std::to_string(mesh.rest_m.size()) + ": nodes count from 0");
            }
            used[node] = 1;
        }
    }
    const auto loose = std::find(used.begin(), used.end(), 0);
    if (loose != used.end()) {
        throw std::invalid_argument("node " + std::to_string(loose - used.begin()) +
                                    " has no mass: no tet uses it");
    }
}

void add_points(ReferenceModel& m) {
    for (std::size_t i = 0; i < m.mesh.tets.size(); ++i) {
        std::array<ReferencePoint, 4> points;
        for (std::size_t q = 0; q < points.size(); ++q) {
            const ShapeGradients s = shape_gradients(m.mesh, m.mesh.tets[i], kFourPoints[q].at);
            points[q] = {s.gradient_1pm, kFourPoints[q].weight * s.six_volumes_m3 / 6.0};
            if (!(points[q].volume_m3 > 0.0) || !std::isfinite(points[q].volume_m3)) {
                throw std::invalid_argument("tet " + std::to_string(i) + " has volume " +
                                            std::to_string(points[q].volume_m3 * 1e9) +
                                            " mm3 around a quadrature point: must be positive");
            }
        }
        m.points.push_back(points);
    }
}

// Nodes that share a tet with each node and come after it, ascending.
std::vector<std::vector<std::uint32_t>> later_neighbours(const QuadraticMesh& mesh) {
    std::vector<std::vector<std::uint32_t>> later(mesh.rest_m.size());
    for (const Tet10& t : mesh.tets) {
        for (const std::uint32_t a : t) {
            for (const std::uint32_t b : t) {
                if (b > a)
                    later[a].push_back(b);
            }
        }
    }
    for (std::vector<std::uint32_t>& list : later) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return later;
}

// Three columns per node: what is left of the diagonal block, then three rows per neighbour. A
// block is known by the place of its upper left entry, see reference_assembly.cpp.
void add_pattern(ReferenceModel& m) {
    const auto later = later_neighbours(m.mesh);
    m.all.size = static_cast<int>(3 * m.mesh.rest_m.size());
    m.all.column_start.push_back(0);
    for (std::size_t node = 0; node < later.size(); ++node) {
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t r = c; r < 3; ++r)
                m.all.row.push_back(static_cast<int>(3 * node + r));
            for (const std::uint32_t other : later[node]) {
                for (std::size_t r = 0; r < 3; ++r)
                    m.all.row.push_back(static_cast<int>(3 * other + r));
            }
            m.all.column_start.push_back(static_cast<int>(m.all.row.size()));
        }
    }
    for (const Tet10& t : m.mesh.tets) {
        std::array<std::int32_t, 55> places;
        std::size_t k = 0;
        for (std::size_t a = 0; a < 10; ++a) {
            for (std::size_t b = 0; b <= a; ++b) {
                const std::uint32_t column = std::min(t[a], t[b]), row = std::max(t[a], t[b]);
                std::int32_t place = m.all.column_start[3 * column];
                if (row != column) {
                    const auto& list = later[column];
                    place += static_cast<std::int32_t>(
                        3 + 3 * (std::lower_bound(list.begin(), list.end(), row) - list.begin()));
                }
                places[k++] = place;
            }
        }
        m.block.push_back(places);
    }
}

void number_unknowns(std::span<const std::uint8_t> held, ReferenceModel& m) {
    m.unknown.assign(3 * m.mesh.rest_m.size(), -1);
    for (std::size_t i = 0; i < m.unknown.size(); ++i) {
        const int flag = kHeldX << (i % 3);
        if (held.empty() || (held[i / 3] & flag) == 0)
            m.unknown[i] = m.unknowns++;
    }
    if (m.unknowns == 0)
        throw std::invalid_argument("every node is held: nothing can move");

    m.free.size = m.unknowns;
    m.free.column_start.push_back(0);
    for (int c = 0; c < m.all.size; ++c) {
        if (m.unknown[c] < 0)
            continue;
        for (int k = m.all.column_start[c]; k < m.all.column_start[c + 1]; ++k) {
            if (m.unknown[m.all.row[k]] < 0)
                continue;
            m.free.row.push_back(m.unknown[m.all.row[k]]);
            m.free_source.push_back(k);
        }
        m.free.column_start.push_back(static_cast<int>(m.free.row.size()));
    }
}

// M_ab = integral of rho N_a N_b, times I
void add_mass_and_weight(ReferenceModel& m) {
    const auto rule = fourteen_points();
    m.mass_kg.assign(m.all.row.size(), 0.0);
    for (std::size_t i = 0; i < m.mesh.tets.size(); ++i) {
        std::array<double, 55> mass{};
        for (const QuadraturePoint& p : rule) {
            const auto N = shape_values(p.at);
            const double kg = m.material.density_kgpm3 * p.weight / 6.0 *
                              shape_gradients(m.mesh, m.mesh.tets[i], p.at).six_volumes_m3;
            std::size_t k = 0;
            for (std::size_t a = 0; a < 10; ++a) {
                for (std::size_t b = 0; b <= a; ++b)
                    mass[k++] += kg * N[a] * N[b];
            }
        }
        std::size_t k = 0;
        for (std::size_t a = 0; a < 10; ++a) {
            for (std::size_t b = 0; b <= a; ++b, ++k)
                add_block(m, i, a, b, k, dmat3(mass[k]), m.mass_kg);
        }
    }
    std::vector<double> acceleration_mps2;
    for (std::size_t i = 0; i < m.mesh.rest_m.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            acceleration_mps2.push_back(m.gravity_mps2[k]);
    }
    m.weight_n.resize(acceleration_mps2.size());
    multiply(m.all, m.mass_kg, acceleration_mps2, m.weight_n);
}

// sum over the samples of E stiffness N_a N_b, times I
void add_bed(std::span<const BedSample> bed, ReferenceModel& m) {
    if (bed.empty())
        return;
    m.bed_npm.assign(m.all.row.size(), 0.0);
    for (const BedSample& sample : bed) {
        if (sample.tet >= m.mesh.tets.size()) {
            throw std::invalid_argument("bed: a sample names tet " + std::to_string(sample.tet) +
                                        " of " + std::to_string(m.mesh.tets.size()) +
                                        ": tets count from 0");
        }
        const auto N = shape_values(sample.weight);
        const double spring_npm = m.material.young_pa * sample.stiffness_m;
        std::size_t k = 0;
        for (std::size_t a = 0; a < 10; ++a) {
            for (std::size_t b = 0; b <= a; ++b, ++k)
                add_block(m, sample.tet, a, b, k, dmat3(spring_npm * N[a] * N[b]), m.bed_npm);
        }
    }
}

} // namespace

ReferenceModel make_reference(const QuadraticMesh& mesh, const Material& material, Law law,
                              std::span<const std::uint8_t> held, const dvec3& gravity_mps2,
                              std::span<const BedSample> bed) {
    if (!held.empty() && held.size() != mesh.rest_m.size()) {
        throw std::invalid_argument("flags of held components for " + std::to_string(held.size()) +
                                    " nodes: the mesh has " + std::to_string(mesh.rest_m.size()));
    }
    if (!(material.density_kgpm3 > 0.0)) {
        throw std::invalid_argument("density_kgpm3 = " + std::to_string(material.density_kgpm3) +
                                    ": must be greater than 0");
    }
    ReferenceModel m;
    m.mesh = mesh;
    m.material = material;
    m.elasticity = elasticity(material, law);
    prony_step(material, 0.0); // checks the terms
    m.gravity_mps2 = gravity_mps2;
    check_nodes(mesh);
    add_points(m);
    add_pattern(m);
    number_unknowns(held, m);
    add_mass_and_weight(m);
    add_bed(bed, m);
    return m;
}

ReferenceState rest_state(const ReferenceModel& model) {
    return {model.mesh.rest_m, std::vector<dvec3>(model.mesh.rest_m.size(), dvec3{0.0}),
            std::vector<Symmetric>(4 * model.points.size() * model.material.prony.size(), kUnit)};
}

ReferenceSystem make_system(const ReferenceModel& model) {
    return {.internal_n = std::vector<double>(model.unknown.size()),
            .stiffness = std::vector<double>(model.all.row.size()),
            .matrix = std::vector<double>(model.free.row.size()),
            .factor = SparseFactor(model.free)};
}

} // namespace tissue
