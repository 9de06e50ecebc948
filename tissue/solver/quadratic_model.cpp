// tissue/solver/quadratic_model.cpp
// What never changes of a quadratic body, and the factor of its matrix at rest. Called at setup,
// where it lets the reference solver check the mesh and integrate mass and stiffness.
#include "tissue/reference/reference.h"
#include "tissue/reference/tet10.h"
#include "tissue/solver/quadratic_columns.h"
#include "tissue/solver/quadratic_linear.h"
#include "tissue/solver/quadratic_refactor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

void number_unknowns(std::span<const std::uint8_t> anchored, QuadraticModel& m) {
    const auto nodes = static_cast<std::int32_t>(m.mesh.rest_m.size());
    for (std::int32_t i = 0; i < nodes; ++i) {
        if (!anchored.empty() && anchored[i] != 0) {
            m.dof.push_back(-1);
            m.fixed.push_back(4 * i);
            continue;
        }
        m.dof.push_back(m.unknowns);
        m.unknowns += 3;
        m.place_of_unknown.insert(m.place_of_unknown.end(), {4 * i, 4 * i + 1, 4 * i + 2});
    }
    m.fixed.push_back(4 * nodes);
}

// Gradients of the barycentric coordinates 1 to 3 where the shape functions are evaluated.
dmat3 barycentric_gradients(const QuadraticMesh& mesh, const Tet10& tet, const Barycentric& L) {
    dmat3 J(0.0); // d rest / d (L1, L2, L3)
    const auto add = [&](int corner, const dvec3& x, double slope) {
        for (int c = 0; c < 3; ++c)
            J[c] += slope * (corner == 0 ? -x : corner == c + 1 ? x : dvec3{0.0});
    };
    for (int a = 0; a < 4; ++a)
        add(a, mesh.rest_m[tet[a]], 4.0 * L[a] - 1.0);
    for (std::size_t e = 0; e < kEdge.size(); ++e) {
        const auto [a, b] = kEdge[e];
        add(a, mesh.rest_m[tet[4 + e]], 4.0 * L[b]);
        add(b, mesh.rest_m[tet[4 + e]], 4.0 * L[a]);
    }
    return glm::transpose(glm::inverse(J));
}

void add_groups(const ReferenceModel& reference, QuadraticModel& m) {
    constexpr std::size_t kLanes = QuadraticGroup::kLanes;
    QuadraticGroup empty{};
    for (auto& lanes : empty.node)
        lanes.fill(m.fixed.back());
    m.groups.assign((m.mesh.tets.size() + kLanes - 1) / kLanes, empty);
    for (std::size_t e = 0; e < m.mesh.tets.size(); ++e) {
        QuadraticGroup& group = m.groups[e / kLanes];
        const std::size_t lane = e % kLanes;
        for (std::size_t a = 0; a < 10; ++a)
            group.node[a][lane] = static_cast<std::int32_t>(4 * m.mesh.tets[e][a]);
        for (std::size_t q = 0; q < 4; ++q) {
            const dmat3 g = barycentric_gradients(m.mesh, m.mesh.tets[e], kFourPoints[q].at);
            for (int k = 0; k < 9; ++k) {
                group.gradient_1pm[q][k][lane] = g[k / 3][k % 3];
                group.gradient_single_1pm[q][k][lane] = static_cast<float>(g[k / 3][k % 3]);
            }
            group.volume_m3[q][lane] = reference.points[e][q].volume_m3;
            m.volume_m3 += reference.points[e][q].volume_m3;
        }
    }
}

void add_tets_of_nodes(QuadraticModel& m) {
    std::vector<std::vector<std::int32_t>> at(m.mesh.rest_m.size());
    for (std::size_t e = 0; e < m.mesh.tets.size(); ++e) {
        for (const std::uint32_t node : m.mesh.tets[e])
            at[node].push_back(static_cast<std::int32_t>(e));
    }
    m.tet_start.push_back(0);
    for (const auto& list : at) {
        m.tet_of_node.insert(m.tet_of_node.end(), list.begin(), list.end());
        m.tet_start.push_back(static_cast<std::int32_t>(m.tet_of_node.size()));
    }
}

// The reference's mass is the same for x, y and z: every third column holds it.
void add_mass(const ReferenceModel& reference, QuadraticModel& m) {
    struct Entry {
        std::int32_t column;
        double kg;
    };
    const std::size_t nodes = m.mesh.rest_m.size();
    std::vector<std::vector<Entry>> rows(nodes);
    for (std::size_t c = 0; c < nodes; ++c) {
        for (int k = reference.all.column_start[3 * c]; k < reference.all.column_start[3 * c + 1];
             ++k) {
            if (reference.all.row[k] % 3 != 0)
                continue;
            const auto r = static_cast<std::size_t>(reference.all.row[k] / 3);
            rows[r].push_back({static_cast<std::int32_t>(4 * c), reference.mass_kg[k]});
            if (r != c)
                rows[c].push_back({static_cast<std::int32_t>(4 * r), reference.mass_kg[k]});
        }
    }
    m.mass_start.push_back(0);
    for (const auto& row : rows) {
        for (const Entry& e : row) {
            m.mass_column.push_back(e.column);
            m.mass_kg.push_back(e.kg);
        }
        m.mass_start.push_back(static_cast<std::int32_t>(m.mass_column.size()));
    }
}

// The bed in both shapes of the stiffness at rest: between nodes, and on the pattern.
void hold(std::span<const BedSample> bed, QuadraticModel& m) {
    m.bed_npm = bed_stiffness(m, bed);
    m.rest_bed_npm.assign(m.rest_stiffness_npm.size(), 0.0);
    for (int column = 0; column < m.unknowns; ++column) {
        const std::int32_t from = m.place_of_unknown[column];
        for (std::int32_t k = m.pattern.column_start[column];
             k < m.pattern.column_start[column + 1]; ++k) {
            const std::int32_t to = m.place_of_unknown[m.pattern.row[k]];
            if (to % 4 != from % 4)
                continue;
            const std::int32_t node = to / 4;
            const auto first = m.mass_column.begin() + m.mass_start[node],
                       last = m.mass_column.begin() + m.mass_start[node + 1];
            const auto entry = std::find(first, last, 4 * (from / 4));
            m.rest_bed_npm[k] = m.bed_npm[entry - m.mass_column.begin()];
            m.rest_stiffness_npm[k] += m.rest_bed_npm[k];
        }
    }
}

} // namespace

QuadraticModel make_quadratic(const QuadraticMesh& mesh, const Material& material,
                              std::span<const std::uint8_t> anchored, const dvec3& gravity_mps2,
                              std::span<const BedSample> bed) {
    std::vector<std::uint8_t> held(anchored.begin(), anchored.end());
    for (std::uint8_t& flag : held)
        flag = flag != 0 ? kHeld : 0;
    ReferenceModel reference = make_reference(mesh, material, Law::neo_hooke, held, gravity_mps2);
    QuadraticModel m;
    m.mesh = mesh;
    m.material = material;
    m.elasticity = reference.elasticity;
    number_unknowns(anchored, m);
    add_groups(reference, m);
    add_tets_of_nodes(m);
    add_mass(reference, m);
    for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
        for (std::size_t k = 0; k < 4; ++k)
            m.weight_n.push_back(k < 3 ? reference.weight_n[3 * i + k] : 0.0);
    }
    m.weight_n.resize((m.weight_n.size() + 4 + 15) / 16 * 16, 0.0);

    ReferenceSystem system = make_system(reference);
    linearize(reference, rest_state(reference), system);
    m.pattern = reference.free;
    for (const std::int32_t k : reference.free_source) {
        m.rest_stiffness_npm.push_back(system.stiffness[k]);
        m.rest_mass_kg.push_back(reference.mass_kg[k]);
    }
    if (!bed.empty())
        hold(bed, m);
    m.block_place = block_places(m);
    if (material.prony.empty())
        return m;
    reference.elasticity.bulk_pa = 0.0;
    linearize(reference, rest_state(reference), system);
    for (const std::int32_t k : reference.free_source)
        m.rest_shear_npm.push_back(system.stiffness[k]);
    return m;
}

QuadraticState rest_state(const QuadraticModel& model) {
    const std::vector<dvec3> none(model.mesh.rest_m.size(), dvec3{0.0});
    const std::size_t terms = model.material.prony.size();
    QuadraticSymmetric unit{};
    for (auto& point : unit.point) {
        for (std::size_t k = 0; k < point.size(); ++k)
            point[k].fill(kUnit[k]);
    }
    return {
        model.mesh.rest_m, none, none,
        std::vector<QuadraticSymmetric>(terms > 0 ? model.groups.size() * (terms + 1) : 0, unit)};
}

QuadraticSystem make_system(const QuadraticModel& model, double dt_s) {
    if (!(dt_s > 0.0) || !std::isfinite(dt_s))
        throw std::invalid_argument("dt_s = " + std::to_string(dt_s) +
                                    ": must be finite and greater than 0");
    QuadraticSystem s{.dt_s = dt_s, .exact = SparseFactor(model.pattern)};
    const double mass = 1.0 / (dt_s * dt_s) + model.material.damping_mass_1ps / dt_s;
    const double stiffness = 1.0 + model.material.damping_stiffness_s / dt_s;
    s.prony = prony_step(model.material, dt_s);
    s.rest_stiffness_npm = model.rest_stiffness_npm;
    for (std::size_t k = 0; k < model.rest_shear_npm.size(); ++k) {
        s.rest_stiffness_npm[k] -=
            (1.0 - s.prony.mu_pa / model.elasticity.mu_pa) * model.rest_shear_npm[k];
    }
    std::vector<double> matrix(model.rest_mass_kg.size());
    for (std::size_t k = 0; k < matrix.size(); ++k)
        matrix[k] = mass * model.rest_mass_kg[k] + stiffness * s.rest_stiffness_npm[k];
    s.fixed_matrix.resize(matrix.size());
    for (std::size_t k = 0; k < matrix.size(); ++k) {
        const double bed = model.rest_bed_npm.empty() ? 0.0 : model.rest_bed_npm[k];
        s.fixed_matrix[k] = mass * model.rest_mass_kg[k] + stiffness * bed;
    }
    if (!s.exact.factor(matrix))
        throw std::invalid_argument("the stiffness at rest is not positive definite: young_pa = " +
                                    std::to_string(model.material.young_pa));
    for (std::size_t k = 0; k < model.mass_kg.size(); ++k) {
        const double bed = model.bed_npm.empty() ? 0.0 : model.bed_npm[k];
        s.scalar_npm.push_back(static_cast<float>(mass * model.mass_kg[k] + stiffness * bed));
    }
    s.single = make_single_factor(s.exact.supernodes());

    for (const int k : s.single.order)
        s.place_in_order.push_back(model.place_of_unknown[k]);

    const std::size_t nodes = model.mesh.rest_m.size(), places = model.weight_n.size();
    const std::size_t remembering = s.prony.terms > 0 ? model.groups.size() : 0;
    for (QuadraticTangents* t : {&s.tangent, &s.tangent_at_start}) {
        t->elastic.resize(model.groups.size());
        t->shear.resize(remembering);
    }
    s.shear_pa.resize(remembering);
    s.stretch.resize(model.groups.size());
    s.warp.assign(nodes, glm::mat3(1.0f));
    s.unwarp = s.warp;
    for (auto* v : {&s.start_m, &s.moved_m, &s.trial_m, &s.momentum_n, &s.internal_n, &s.inertia_n,
                    &s.residual_n, &s.way, &s.damped_n, &s.last_way, &s.last_inertia_n})
        v->assign(places, 0.0);
    for (auto* v : {&s.b, &s.x, &s.r, &s.z, &s.p, &s.q})
        v->assign(places, 0.0f);
    s.ordered.resize(static_cast<std::size_t>(model.unknowns));
    s.unknown.resize(2 * static_cast<std::size_t>(model.unknowns));
    s.load_n.assign(static_cast<std::size_t>(model.unknowns), 0.0);
    s.lines.resize(static_cast<std::size_t>(s.single.most_lines));
    s.block = make_block_scratch(model, s.single.order);
    return s;
}

} // namespace tissue
