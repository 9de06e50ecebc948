// tissue/baseline/projective.cpp
// Projections, global matrix and steps of projective dynamics. Called by studies and tests.
#include "tissue/baseline/projective.h"

#include "tissue/solver/corotated_element.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

double inner(const dmat3& a, const dmat3& b) noexcept {
    return glm::dot(a[0], b[0]) + glm::dot(a[1], b[1]) + glm::dot(a[2], b[2]);
}

// Least change d with det(F + d) = 1: d <- [(g:d - c)/|g|^2] g, c = det - 1 and g its gradient at
// F + d (Bouaziz et al. 2014, appendix; there on the singular values, which d leaves aligned).
// Flat and inverted tets begin at R, which has the volume: from F some end at a farther shape.
dmat3 nearest_of_rest_volume(const dmat3& F, const dmat3& R) noexcept {
    constexpr int kMaxIterations = 300; // 5 to 10 at strains of a tenth, a hundred when inverted
    constexpr double kDone = 1e-26;     // squared change
    dmat3 D = determinant(F) > 0.0 ? F : R;
    for (int k = 0; k < kMaxIterations; ++k) {
        const dmat3 g = cofactor(D);
        const double size2 = inner(g, g);
        if (!(size2 > 0.0))
            return R;
        const dmat3 next = F + (inner(g, D - F) - determinant(D) + 1.0) / size2 * g;
        const dmat3 change = next - D;
        D = next;
        if (inner(change, change) < kDone)
            break;
    }
    return D;
}

struct Projections {
    dmat3 F, R, D;
};
Projections project(const CorotatedModel& body, std::size_t tet,
                    std::span<const dvec3> x) noexcept {
    const dmat3 F = deformation_gradient(body, tet, x);
    const dmat3 R = polar_rotation(F);
    return {F, R, body.lambda_pa > 0.0 ? nearest_of_rest_volume(F, R) : F};
}

// The pattern of the corotated matrix has 3 x 3 blocks; this one has a number for each.
SparsePattern one_of_nine(const SparsePattern& blocks) {
    SparsePattern p;
    p.size = blocks.size / 3;
    p.column_start.push_back(0);
    for (int column = 0; column < p.size; ++column) {
        for (int k = blocks.column_start[3 * column]; k < blocks.column_start[3 * column + 1];
             ++k) {
            if (blocks.row[k] % 3 == 0)
                p.row.push_back(blocks.row[k] / 3);
        }
        p.column_start.push_back(static_cast<int>(p.row.size()));
    }
    return p;
}

double& entry(const SparsePattern& pattern, std::span<double> values, int column,
              int row) noexcept {
    const auto begin = pattern.row.begin() + pattern.column_start[column];
    const auto end = pattern.row.begin() + pattern.column_start[column + 1];
    return values[std::lower_bound(begin, end, row) - pattern.row.begin()];
}

void factor_for(const ProjectiveModel& model, double dt_s, ProjectiveScratch& scratch) noexcept {
    const CorotatedModel& body = model.body;
    std::fill(scratch.matrix.begin(), scratch.matrix.end(), 0.0);
    const double of_mass = (1.0 / dt_s + body.material.damping_mass_1ps) / dt_s;
    for (std::size_t i = 0; i < body.dof.size(); ++i) {
        if (body.dof[i] >= 0)
            scratch.matrix[model.pattern.column_start[body.dof[i] / 3]] +=
                of_mass * body.mass_kg[i];
    }
    const double of_f = 2.0 * body.mu_pa + 3.0 * body.lambda_pa;
    for (std::size_t e = 0; e < body.mesh.tets.size(); ++e) {
        for (int a = 0; a < 4; ++a) {
            for (int b = 0; b < 4; ++b) {
                const int column = body.dof[body.mesh.tets[e][a]];
                const int row = body.dof[body.mesh.tets[e][b]];
                if (column >= 0 && row >= column)
                    entry(model.pattern, scratch.matrix, column / 3, row / 3) +=
                        of_f * body.volume_m3[e] *
                        glm::dot(body.gradient_1pm[e][a], body.gradient_1pm[e][b]);
            }
        }
    }
    scratch.factored = scratch.factor.factor(scratch.matrix);
    scratch.dt_s = dt_s;
}

// The residual at `state` into scratch.change, negative. Returns its size as BaselineReport has it.
double find_residual(const ProjectiveModel& model, std::span<const dvec3> load_n,
                     const BaselineState& state, ProjectiveScratch& scratch) noexcept {
    const CorotatedModel& body = model.body;
    const double rate = 1.0 / scratch.dt_s;
    const double damped = rate * (rate + body.material.damping_mass_1ps);
    elastic_forces(model, state, scratch.force_n);
    double left2 = 0.0, driving2 = 0.0, elastic2 = 0.0;
    for (std::size_t i = 0; i < body.dof.size(); ++i) {
        if (body.dof[i] < 0)
            continue;
        const dvec3 drive = body.mass_kg[i] * (rate * state.velocity_mps[i] +
                                               free_acceleration_mps2(body, load_n, i));
        const dvec3 went = state.position_m[i] - scratch.before_m[i];
        const dvec3 left = drive - damped * body.mass_kg[i] * went - scratch.force_n[i];
        for (int k = 0; k < 3; ++k)
            scratch.change[k * model.pattern.size + body.dof[i] / 3] = left[k];
        left2 += glm::dot(left, left);
        driving2 += glm::dot(drive, drive);
        elastic2 += glm::dot(scratch.force_n[i], scratch.force_n[i]);
    }
    const double size = std::sqrt(driving2) + std::sqrt(elastic2);
    return size > 0.0 ? std::sqrt(left2) / size : 0.0;
}

} // namespace

ProjectiveModel make_projective(const TetMesh& mesh, const Material& material,
                                std::span<const std::uint8_t> anchored, const dvec3& gravity_mps2) {
    ProjectiveModel model{.body = make_corotated(mesh, material, anchored, gravity_mps2)};
    model.pattern = one_of_nine(model.body.pattern);
    return model;
}

ProjectiveScratch make_scratch(const ProjectiveModel& model) {
    const std::vector<dvec3> nodal(model.body.dof.size());
    return {.matrix = std::vector<double>(model.pattern.row.size()),
            .change = std::vector<double>(static_cast<std::size_t>(model.body.unknowns)),
            .before_m = nodal,
            .force_n = nodal,
            .factor = SparseFactor(model.pattern)};
}

void elastic_forces(const ProjectiveModel& model, const BaselineState& state,
                    std::span<dvec3> force_n) noexcept {
    const CorotatedModel& body = model.body;
    std::fill(force_n.begin(), force_n.end(), dvec3{0.0});
    for (std::size_t e = 0; e < body.mesh.tets.size(); ++e) {
        const auto [F, R, D] = project(body, e, state.position_m);
        const dmat3 P =
            body.volume_m3[e] * (2.0 * body.mu_pa * (F - R) + 3.0 * body.lambda_pa * (F - D));
        for (int a = 0; a < 4; ++a)
            force_n[body.mesh.tets[e][a]] += P * body.gradient_1pm[e][a];
    }
}

double elastic_energy_j(const ProjectiveModel& model, const BaselineState& state) noexcept {
    const CorotatedModel& body = model.body;
    double sum = 0.0;
    for (std::size_t e = 0; e < body.mesh.tets.size(); ++e) {
        const auto [F, R, D] = project(body, e, state.position_m);
        sum += body.volume_m3[e] *
               (body.mu_pa * inner(F - R, F - R) + 1.5 * body.lambda_pa * inner(F - D, F - D));
    }
    return sum;
}

BaselineReport step(const ProjectiveModel& model, std::span<const dvec3> load_n, double dt_s,
                    ProjectiveScratch& scratch, BaselineState& state) noexcept {
    const CorotatedModel& body = model.body;
    if (scratch.dt_s != dt_s)
        factor_for(model, dt_s, scratch);
    scratch.before_m = state.position_m; // sized: copies only
    const double keep = 1.0 / (1.0 + body.material.damping_mass_1ps * dt_s);
    for (std::size_t i = 0; i < body.dof.size(); ++i) {
        if (body.dof[i] >= 0 && model.start == ProjectiveStart::inertial)
            state.position_m[i] +=
                dt_s * keep *
                (state.velocity_mps[i] + dt_s * free_acceleration_mps2(body, load_n, i));
    }

    double residual = 1.0;
    for (int k = 0; k < model.iterations && scratch.factored; ++k) {
        residual = find_residual(model, load_n, state, scratch);
        scratch.factor.solve(scratch.change, 3);
        for (std::size_t i = 0; i < body.dof.size(); ++i) {
            for (int c = 0; c < 3 && body.dof[i] >= 0; ++c)
                state.position_m[i][c] += scratch.change[c * model.pattern.size + body.dof[i] / 3];
        }
    }
    for (std::size_t i = 0; i < body.dof.size(); ++i)
        state.velocity_mps[i] = (state.position_m[i] - scratch.before_m[i]) / dt_s;
    BaselineReport report = look_at(body, state, 1);
    report.relative_residual = residual;
    return report;
}

} // namespace tissue
