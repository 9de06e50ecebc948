// tissue/solver/quadratic_recovery.cpp
// Linear steps about the rest shape, for bodies that are inside out somewhere. Tissue loop.
#include "tissue/solver/quadratic_recovery.h"

#include "tissue/solver/polar_rotation.h"
#include "tissue/solver/quadratic_linear.h"

#include <algorithm>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

dvec3 at(const NodeVector<double>& v, std::size_t node) noexcept {
    return {v[4 * node], v[4 * node + 1], v[4 * node + 2]};
}

// Rigid motion that is nearest to where the nodes are.
struct Motion {
    dmat3 R{1.0};
    dvec3 rest_centre_m{0.0}, centre_m{0.0};
};

Motion nearest_motion(const QuadraticModel& model, const QuadraticSystem& s) noexcept {
    Motion m;
    if (model.fixed.size() > 1 || !model.bed_npm.empty()) // beside the sink
        return m;
    const std::size_t nodes = model.mesh.rest_m.size();
    for (std::size_t i = 0; i < nodes; ++i) {
        m.rest_centre_m += model.mesh.rest_m[i] / static_cast<double>(nodes);
        m.centre_m += (model.mesh.rest_m[i] + at(s.start_m, i)) / static_cast<double>(nodes);
    }
    dmat3 spread(0.0);
    for (std::size_t i = 0; i < nodes; ++i) {
        const dvec3 rest = model.mesh.rest_m[i];
        spread += glm::outerProduct(rest + at(s.start_m, i) - m.centre_m, rest - m.rest_centre_m);
    }
    m.R = closest_rotation(spread);
    return m;
}

} // namespace

void linearize_recovering(const QuadraticModel& model, QuadraticSystem& s) noexcept {
    const Motion motion = nearest_motion(model, s);
    s.turned = motion.R;
    const dmat3 back = glm::transpose(motion.R);
    const auto n = static_cast<std::size_t>(model.unknowns);
    const std::span<double> strained(s.unknown.data(), n), force(s.unknown.data() + n, n);
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        if (model.dof[i] < 0)
            continue;
        const dvec3 rest = model.mesh.rest_m[i];
        const dvec3 u =
            back * (rest + at(s.start_m, i) - motion.centre_m) - (rest - motion.rest_centre_m);
        for (int c = 0; c < 3; ++c)
            strained[model.dof[i] + c] = u[c];
    }
    multiply(model.pattern, s.rest_stiffness_npm, strained, force);
    std::fill(s.way.begin(), s.way.end(), 0.0);
    std::fill(s.residual_n.begin(), s.residual_n.end(), 0.0);
    for (std::size_t i = 0; i < model.dof.size(); ++i) {
        const std::int32_t d = model.dof[i];
        if (d < 0)
            continue;
        const dvec3 f = motion.R * dvec3{force[d], force[d + 1], force[d + 2]};
        for (int c = 0; c < 3; ++c) {
            s.internal_n[4 * i + c] = f[c];
            s.residual_n[4 * i + c] = s.momentum_n[4 * i + c] - f[c];
        }
    }
}

void solve_recovering(QuadraticSystem& s, std::span<double> b) noexcept {
    const auto turn = [&](const dmat3& R) {
        for (std::size_t k = 0; k < b.size(); k += 3) {
            const dvec3 v = R * dvec3{b[k], b[k + 1], b[k + 2]};
            for (int c = 0; c < 3; ++c)
                b[k + c] = v[c];
        }
    };
    turn(glm::transpose(s.turned));
    s.exact.solve(b, 1);
    turn(s.turned);
}

} // namespace tissue
