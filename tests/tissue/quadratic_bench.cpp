// tests/tissue/quadratic_bench.cpp
// A heavy beam falls from the straight state: CPU time of the process per quadratic step, alone and
// beside the reference solver, whose way the tip is compared with at every step.
//   tissue_quadratic_bench [poisson [cells_x cells_y [dt_ms [steps [young_kpa]]]]]
#include "tests/tissue/quadratic_bodies.h"

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

struct Column {
    std::vector<double> values;

    double mean() const {
        double sum = 0.0;
        for (const double x : values)
            sum += x;
        return sum / static_cast<double>(values.size());
    }
    double quantile(double share) const {
        std::vector<double> v = values;
        std::sort(v.begin(), v.end());
        return v[static_cast<std::size_t>(share * static_cast<double>(v.size() - 1) + 0.5)];
    }
    void print(const char* what) const {
        std::printf("%-38s mean %8.4g  p50 %8.4g  p99 %8.4g  most %8.4g\n", what, mean(),
                    quantile(0.5), quantile(0.99), quantile(1.0));
    }
};

struct Work {
    double poisson = 0.45;
    int cells_x = 10, cells_y = 2;
    double dt_s = 0.01;
    int steps = 200;
    double young_pa = 100e3;
};

struct Fall {
    Work work;
    tissue::QuadraticMesh mesh;
    std::vector<std::uint8_t> held;
    std::size_t tip = 0;
    Column ms, linear, newton, linear_residual, residual, projected, off_mm, off_percent, factor_ms;

    explicit Fall(const Work& w)
        : work(w), mesh(tissue::quadratic_mesh(
                       tissue::box_mesh({0.2, 0.04, 0.04}, {w.cells_x, w.cells_y, w.cells_y}))),
          held(quadratic_bodies::held_at_x0(mesh)) {
        while (glm::length(mesh.rest_m[tip] - dvec3(0.2, 0.02, 0.02)) > 1e-9)
            ++tip;
    }
    tissue::Material material() const { return bodies::elastic(work.young_pa, work.poisson); }

    void take(double step_ms, const tissue::QuadraticReport& report) {
        ms.values.push_back(step_ms);
        linear.values.push_back(report.linear_iterations);
        newton.values.push_back(report.newton_iterations);
        linear_residual.values.push_back(report.linear_residual);
        residual.values.push_back(report.relative_residual);
        projected.values.push_back(report.projected);
    }
};

// The reference, one step behind or beside each of ours.
struct Beside {
    tissue::ReferenceModel model;
    tissue::ReferenceState state;
    tissue::ReferenceSystem system;
    std::vector<double> right;

    explicit Beside(const Fall& fall)
        : model(make_reference(fall.mesh, fall.material(), tissue::Law::neo_hooke, fall.held,
                               {0, -9.81, 0})),
          state(rest_state(model)), system(make_system(model)),
          right(static_cast<std::size_t>(model.unknowns), 1.0) {}

    void take(const tissue::QuadraticState& ours, Fall& fall) {
        step(model, {}, fall.work.dt_s, tissue::TimeRule::implicit_euler, {}, system, state);
        const double off = glm::length(ours.position_m[fall.tip] - state.position_m[fall.tip]);
        fall.off_mm.values.push_back(1e3 * off);
        fall.off_percent.values.push_back(
            100 * off / glm::length(state.position_m[fall.tip] - fall.mesh.rest_m[fall.tip]));
        const double start = cpu_ms();
        system.factor.factor(system.matrix); // of the last Newton iteration
        system.factor.solve(right, 1);
        fall.factor_ms.values.push_back(cpu_ms() - start);
    }
};

tissue::QuadraticState run(Fall& fall, Beside* beside) {
    const auto model = make_quadratic(fall.mesh, fall.material(), fall.held, {0, -9.81, 0});
    auto system = make_system(model, fall.work.dt_s);
    auto state = rest_state(model);
    std::vector<double> du(static_cast<std::size_t>(model.unknowns));
    for (int i = 0; i < fall.work.steps; ++i) {
        const double before = cpu_ms();
        linearize(model, state, system);
        const auto report = free_motion(model, {}, system, du);
        advance(model, system, du, state);
        fall.take(cpu_ms() - before, report);
        if (beside != nullptr)
            beside->take(state, fall);
    }
    return state;
}

void print(const Fall& alone, const Fall& both, const tissue::QuadraticState& end) {
    std::printf("nu %g, %g kPa, %zu nodes, %zu tets, %d steps of %g ms\n", alone.work.poisson,
                1e-3 * alone.work.young_pa, alone.mesh.rest_m.size(), alone.mesh.tets.size(),
                alone.work.steps, 1e3 * alone.work.dt_s);
    alone.ms.print("step, ms CPU, alone");
    both.ms.print("step, ms CPU, beside the reference");
    both.factor_ms.print("factor and solve, ms CPU");
    std::printf("%-38s mean %8.4g\n", "step / (factor and solve)",
                both.ms.mean() / both.factor_ms.mean());
    alone.linear.print("iterations of the linear solves");
    alone.newton.print("iterations of Newton");
    alone.linear_residual.print("residual, linear");
    alone.residual.print("residual, nonlinear");
    alone.projected.print("projected");
    both.off_mm.print("tip off the reference, mm");
    both.off_percent.print("tip off the reference, %");
    const dvec3 tip = end.position_m[alone.tip] - alone.mesh.rest_m[alone.tip];
    std::printf("tip at the end (%.2f, %.2f) mm\n", 1e3 * tip.x, 1e3 * tip.y);
}

} // namespace

int main(int argc, char** argv) {
    const auto given = [&](int i, double otherwise) {
        return argc > i ? std::atof(argv[i]) : otherwise;
    };
    Work work;
    work.poisson = given(1, work.poisson);
    work.cells_x = static_cast<int>(given(2, work.cells_x));
    work.cells_y = static_cast<int>(given(3, work.cells_y));
    work.dt_s = 1e-3 * given(4, 1e3 * work.dt_s);
    work.steps = static_cast<int>(given(5, work.steps));
    work.young_pa = 1e3 * given(6, 1e-3 * work.young_pa);
    Fall alone(work), both(work);
    const auto end = run(alone, nullptr);
    Beside beside(both);
    run(both, &beside);
    print(alone, both, end);
    return 0;
}
