// tissue/baseline/xpbd.cpp
// Constraint projections and substeps of extended position based dynamics. Studies and tests.
#include "tissue/baseline/xpbd.h"

#include "tissue/solver/corotated_element.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

double square(const dmat3& F) noexcept {
    return glm::dot(F[0], F[0]) + glm::dot(F[1], F[1]) + glm::dot(F[2], F[2]);
}

// Moves the free corners of a tet along one constraint. dC/dx_a = (dC/dF) G_a
void project(const CorotatedModel& body, std::size_t tet, double value, const dmat3& by_f,
             double compliance, double& multiplier, std::span<dvec3> x) noexcept {
    std::array<dvec3, 4> gradient;
    double below = compliance;
    for (int a = 0; a < 4; ++a) {
        const std::uint32_t node = body.mesh.tets[tet][a];
        gradient[a] = by_f * body.gradient_1pm[tet][a];
        if (body.dof[node] >= 0)
            below += glm::dot(gradient[a], gradient[a]) / body.mass_kg[node];
    }
    const double change = -(value + compliance * multiplier) / below;
    multiplier += change;
    for (int a = 0; a < 4; ++a) {
        const std::uint32_t node = body.mesh.tets[tet][a];
        if (body.dof[node] >= 0)
            x[node] += change / body.mass_kg[node] * gradient[a];
    }
}

void sweep(const XpbdModel& model, double h_s, std::span<double> multiplier,
           std::span<dvec3> x) noexcept {
    const CorotatedModel& body = model.body;
    const double rest = 1.0 + body.mu_pa / model.lambda_pa;
    for (std::size_t e = 0; e < body.mesh.tets.size(); ++e) {
        const double per_pa = 1.0 / (body.volume_m3[e] * h_s * h_s);
        dmat3 F = deformation_gradient(body, e, x);
        const double size = std::sqrt(square(F));
        if (size > 0.0) // a tet in a point has no direction to grow in
            project(body, e, size, F / size, per_pa / body.mu_pa, multiplier[2 * e], x);
        F = deformation_gradient(body, e, x);
        project(body, e, determinant(F) - rest, cofactor(F), per_pa / model.lambda_pa,
                multiplier[2 * e + 1], x);
    }
}

} // namespace

XpbdModel make_xpbd(const TetMesh& mesh, const Material& material,
                    std::span<const std::uint8_t> anchored, const dvec3& gravity_mps2) {
    XpbdModel model{.body = make_corotated(mesh, material, anchored, gravity_mps2)};
    model.lambda_pa = model.body.lambda_pa + model.body.mu_pa;
    return model;
}

BaselineScratch make_scratch(const XpbdModel& model) {
    return {.node = std::vector<dvec3>(model.body.dof.size()),
            .multiplier = std::vector<double>(2 * model.body.mesh.tets.size())};
}

double elastic_energy_j(const XpbdModel& model, const BaselineState& state) noexcept {
    const CorotatedModel& body = model.body;
    const double more = body.mu_pa / model.lambda_pa;
    double sum = 0.0;
    for (std::size_t e = 0; e < body.mesh.tets.size(); ++e) {
        const dmat3 F = deformation_gradient(body, e, state.position_m);
        const double away = determinant(F) - 1.0 - more;
        sum += 0.5 * body.volume_m3[e] *
               (body.mu_pa * (square(F) - 3.0) + model.lambda_pa * (away * away - more * more));
    }
    return sum;
}

BaselineReport step(const XpbdModel& model, std::span<const dvec3> load_n, double dt_s,
                    BaselineScratch& scratch, BaselineState& state) noexcept {
    const CorotatedModel& body = model.body;
    const double h = dt_s / model.substeps;
    const double keep = 1.0 / (1.0 + body.material.damping_mass_1ps * h);
    for (int k = 0; k < model.substeps; ++k) {
        scratch.node = state.position_m; // sized: copies only
        for (std::size_t i = 0; i < body.dof.size(); ++i) {
            if (body.dof[i] >= 0)
                state.position_m[i] +=
                    h * (state.velocity_mps[i] + h * free_acceleration_mps2(body, load_n, i));
        }
        std::fill(scratch.multiplier.begin(), scratch.multiplier.end(), 0.0);
        for (int s = 0; s < model.sweeps; ++s)
            sweep(model, h, scratch.multiplier, state.position_m);
        for (std::size_t i = 0; i < body.dof.size(); ++i) {
            if (body.dof[i] >= 0)
                state.velocity_mps[i] = keep / h * (state.position_m[i] - scratch.node[i]);
        }
    }
    return look_at(body, state, model.substeps);
}

} // namespace tissue
