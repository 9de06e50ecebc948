// tissue/baseline/mass_spring.cpp
// Springs of a mesh, their forces and their explicit steps. Called by studies and tests.
#include "tissue/baseline/mass_spring.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tissue {
namespace {

using glm::dvec3;

std::vector<Spring> edge_springs(const CorotatedModel& body) {
    constexpr double kLloyd = 24.0 / 25.0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> share_nm; // k l^2 of each edge
    for (std::size_t e = 0; e < body.mesh.tets.size(); ++e) {
        const Tet& t = body.mesh.tets[e];
        for (int a = 0; a < 4; ++a) {
            for (int b = a + 1; b < 4; ++b)
                share_nm[std::minmax(t[a], t[b])] +=
                    kLloyd * body.material.young_pa * body.volume_m3[e];
        }
    }
    std::vector<Spring> springs;
    for (const auto& [edge, nm] : share_nm) {
        const double length_m =
            glm::length(body.mesh.rest_m[edge.second] - body.mesh.rest_m[edge.first]);
        springs.push_back({edge.first, edge.second, length_m, nm / (length_m * length_m)});
    }
    return springs;
}

// K u = sum k n n^T (u_b - u_a) at rest
StiffnessProduct product_at_rest(const MassSpringModel& model) {
    return [&model](std::span<const double> u, std::span<double> force) {
        const CorotatedModel& body = model.body;
        const auto at = [&](std::int32_t d) {
            return d < 0 ? dvec3{0.0} : dvec3{u[d], u[d + 1], u[d + 2]};
        };
        std::fill(force.begin(), force.end(), 0.0);
        for (const Spring& s : model.springs) {
            const dvec3 n = (body.mesh.rest_m[s.b] - body.mesh.rest_m[s.a]) / s.rest_m;
            const std::int32_t a = body.dof[s.a], b = body.dof[s.b];
            const dvec3 pull = s.npm * glm::dot(n, at(b) - at(a)) * n;
            for (int k = 0; k < 3; ++k) {
                if (a >= 0)
                    force[a + k] -= pull[k];
                if (b >= 0)
                    force[b + k] += pull[k];
            }
        }
    };
}

} // namespace

MassSpringModel make_mass_spring(const TetMesh& mesh, const Material& material,
                                 std::span<const std::uint8_t> anchored,
                                 const dvec3& gravity_mps2) {
    MassSpringModel model{.body = make_corotated(mesh, material, anchored, gravity_mps2)};
    model.springs = edge_springs(model.body);
    model.critical_s = 2.0 / greatest_frequency_radps(model.body, product_at_rest(model));
    model.substep_s = kCourant * model.critical_s;
    return model;
}

BaselineScratch make_scratch(const MassSpringModel& model) {
    return {.node = std::vector<dvec3>(model.body.dof.size())};
}

void elastic_forces(const MassSpringModel& model, const BaselineState& state,
                    std::span<dvec3> force_n) noexcept {
    std::fill(force_n.begin(), force_n.end(), dvec3{0.0});
    for (const Spring& s : model.springs) {
        const dvec3 d = state.position_m[s.b] - state.position_m[s.a];
        const double length_m = glm::length(d);
        if (!(length_m > 0.0))
            continue; // no direction, and the mean over all of them is no force
        const dvec3 pull = s.npm * (1.0 - s.rest_m / length_m) * d;
        force_n[s.a] -= pull;
        force_n[s.b] += pull;
    }
}

double elastic_energy_j(const MassSpringModel& model, const BaselineState& state) noexcept {
    double sum = 0.0;
    for (const Spring& s : model.springs) {
        const double longer_m =
            glm::length(state.position_m[s.b] - state.position_m[s.a]) - s.rest_m;
        sum += 0.5 * s.npm * longer_m * longer_m;
    }
    return sum;
}

// v' = (v + h a(x)) / (1 + alpha h), x' = x + h v'
BaselineReport step(const MassSpringModel& model, std::span<const dvec3> load_n, double dt_s,
                    BaselineScratch& scratch, BaselineState& state) noexcept {
    const CorotatedModel& body = model.body;
    const int substeps = substep_count(dt_s, model.substep_s);
    const double h = dt_s / substeps;
    const double keep = 1.0 / (1.0 + body.material.damping_mass_1ps * h);
    for (int k = 0; k < substeps; ++k) {
        elastic_forces(model, state, scratch.node);
        for (std::size_t i = 0; i < body.dof.size(); ++i) {
            if (body.dof[i] < 0)
                continue;
            const dvec3 a =
                free_acceleration_mps2(body, load_n, i) - scratch.node[i] / body.mass_kg[i];
            state.velocity_mps[i] = keep * (state.velocity_mps[i] + h * a);
            state.position_m[i] += h * state.velocity_mps[i];
        }
    }
    return look_at(body, state, substeps);
}

} // namespace tissue
