// tests/tissue/quadratic_bench.cpp
// A heavy beam falls from the straight state: cost of a quadratic step in CPU time of the process,
// beside CHOLMOD's factorisation and solve of the same matrix, and how far the tip is from the
// reference solver's at every step.
//   tissue_quadratic_bench [poisson [cells_x cells_y [dt_ms [steps]]]]
#include "tests/tissue/reference_bodies.h"
#include "tissue/solver/quadratic.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>

using glm::dvec3;

namespace {

double cpu_ms() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

double mean(const std::vector<double>& v) {
    double sum = 0.0;
    for (const double x : v)
        sum += x;
    return sum / static_cast<double>(v.size());
}
double quantile(std::vector<double> v, double share) {
    std::sort(v.begin(), v.end());
    return v[static_cast<std::size_t>(share * static_cast<double>(v.size() - 1) + 0.5)];
}

std::size_t tip_of(const tissue::QuadraticMesh& mesh) {
    std::size_t tip = 0;
    for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
        if (glm::length(mesh.rest_m[i] - dvec3(0.2, 0.02, 0.02)) < 1e-9)
            tip = i;
    }
    return tip;
}

double argument(int argc, char** argv, int i, double otherwise) {
    return argc > i ? std::atof(argv[i]) : otherwise;
}

} // namespace

int main(int argc, char** argv) {
    const double poisson = argument(argc, argv, 1, 0.45);
    const int nx = static_cast<int>(argument(argc, argv, 2, 10));
    const int ny = static_cast<int>(argument(argc, argv, 3, 2));
    const double dt_s = argument(argc, argv, 4, 10) * 1e-3;
    const int steps = static_cast<int>(argument(argc, argv, 5, 200));
    const bool beside = argument(argc, argv, 6, 1) > 0;
    tissue::QuadraticOptions options;
    options.max_newton = static_cast<int>(argument(argc, argv, 7, options.max_newton));
    options.newton_tolerance = argument(argc, argv, 8, options.newton_tolerance);

    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh({0.2, 0.04, 0.04}, {nx, ny, ny}));
    const auto held =
        reference_bodies::flags(mesh, [](auto x) { return x.x < 1e-9 ? tissue::kHeld : 0; });
    const auto material = bodies::elastic(100e3, poisson);
    const auto model = make_quadratic(mesh, material, held, {0, -9.81, 0});
    auto system = make_system(model, dt_s);
    auto state = rest_state(model);
    const auto exact = make_reference(mesh, material, tissue::Law::neo_hooke, held, {0, -9.81, 0});
    auto exact_system = make_system(exact);
    auto exact_state = rest_state(exact);

    const std::size_t tip = tip_of(mesh);
    std::vector<double> du(static_cast<std::size_t>(model.unknowns)), ms, factor_ms, linear, newton;
    double worst_linear = 0.0, worst_residual = 0.0, worst_fall = 0.0, worst_share = 0.0;
    double greatest = 0.0;
    int projected = 0;
    for (int i = 0; i < steps; ++i) {
        const double before = cpu_ms();
        linearize(model, state, system);
        const auto report = free_motion(model, options, system, du);
        advance(model, system, du, state);
        ms.push_back(cpu_ms() - before);
        linear.push_back(report.linear_iterations);
        newton.push_back(report.newton_iterations);
        worst_linear = std::max(worst_linear, report.linear_residual);
        worst_residual = std::max(worst_residual, report.relative_residual);
        projected += report.projected;
        if (!beside)
            continue;
        step(exact, {}, dt_s, tissue::TimeRule::implicit_euler, {}, exact_system, exact_state);
        const dvec3 there = exact_state.position_m[tip] - mesh.rest_m[tip];
        const double off = glm::length(state.position_m[tip] - exact_state.position_m[tip]);
        greatest = std::max(greatest, glm::length(there));
        worst_fall = std::max(worst_fall, off);
        worst_share = std::max(worst_share, off / glm::length(there));
        if (i % 10 == 0) {
            const double start = cpu_ms();
            exact_system.factor.factor(exact_system.matrix);
            exact_system.factor.solve(du, 1);
            factor_ms.push_back(cpu_ms() - start);
        }
    }
    const dvec3 settled = state.position_m[tip] - mesh.rest_m[tip];
    const dvec3 converged{-38.2e-3, -113.8e-3, 0};
    std::printf("nu %g, %zu nodes, %zu tets, dt %g ms, %d steps; factor entries %lld\n", poisson,
                mesh.rest_m.size(), mesh.tets.size(), dt_s * 1e3, steps,
                static_cast<long long>(system.exact.factor_entries()));
    std::printf("step ms: mean %.3f, p50 %.3f, p99 %.3f, most %.3f\n", mean(ms), quantile(ms, 0.5),
                quantile(ms, 0.99), quantile(ms, 1.0));
    std::printf("linear iterations: mean %.1f, most %g; Newton: mean %.2f, most %g\n", mean(linear),
                quantile(linear, 1), mean(newton), quantile(newton, 1));
    std::printf("worst linear residual %.2e, worst nonlinear residual %.2e, projected %d\n",
                worst_linear, worst_residual, projected);
    std::printf("tip (%.2f, %.2f) mm, %.2f %% off (-38.2, -113.8)\n", settled.x * 1e3,
                settled.y * 1e3, 100 * glm::length(settled - converged) / glm::length(converged));
    if (beside) {
        std::printf("beside the reference: worst %.3f mm (%.3f %% of the greatest), worst share "
                    "%.3f %%\n",
                    worst_fall * 1e3, 100 * worst_fall / greatest, 100 * worst_share);
        std::printf("factor and solve: %.3f ms; a step is %.2f of it\n", mean(factor_ms),
                    mean(ms) / mean(factor_ms));
    }
    return 0;
}
