// F11, explicit steps explode: a cube of 30 mm in 6^3 cells, E = 10 kPa, its nodes pushed at
// 1 um/s. Central differences hold up to 2/w_max, which is the time a pressure wave takes through
// the smallest tet and nears 0 with nu = 1/2 and with slivers; what an independent program found
// from the eigenvalues of the same mesh is the theory here. Implicit methods stay bounded at 20 ms.
#include "sim/study/failure_bench.h"

#include "tissue/baseline/mass_spring.h"
#include "tissue/baseline/projective.h"
#include "tissue/baseline/run.h"
#include "tissue/baseline/tled.h"
#include "tissue/solver/quadratic.h"

#include <cmath>
#include <fmt/format.h>

namespace sim::failure {
namespace {

constexpr double kEdge_m = 0.03, kYoung_pa = 10e3, kPush_mps = 1e-6, kGone = 1e6;
constexpr double kStep_s = 0.02; // of a slow tissue loop
// speeds may grow so far: 1/sqrt(1 - 0.95^2) by the scheme, some more where modes meet in a node
constexpr double kBounded = 20.0;

tissue::Material elastic(double poisson) {
    return {.young_pa = kYoung_pa,
            .poisson = poisson,
            .density_kgpm3 = 1000.0,
            .damping_mass_1ps = 0.0,
            .damping_stiffness_s = 0.0,
            .source = "design value"};
}

struct Found {
    double poisson, critical_ms, rounding_ms;
};
constexpr Found kFound[]{
    {0.3, 0.913, 5e-4}, {0.45, 0.523, 5e-4}, {0.49, 0.242, 5e-4}, {0.499, 0.0769, 5e-5}};

template <typename State> void push(State& state, std::uint64_t seed) {
    Random random{std::mt19937_64(seed)};
    for (dvec3& v : state.velocity_mps)
        v = kPush_mps * dvec3{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
}

double fastest(const std::vector<dvec3>& velocity_mps) {
    double most = 0.0;
    for (const dvec3& v : velocity_mps)
        most = std::fmax(most, glm::length(v));
    return most / kPush_mps;
}

/// Greatest speed over that of the push while `step` is repeated; kGone once it is beyond that.
template <typename Step>
double growth(int steps, const std::vector<dvec3>& velocity_mps, const Step& step) {
    double most = 0.0;
    for (int i = 0; i < steps; ++i) {
        step();
        for (const dvec3& v : velocity_mps)
            if (!std::isfinite(v.x + v.y + v.z))
                return kGone;
        most = std::max(most, fastest(velocity_mps));
        if (most > kGone)
            return kGone;
    }
    return most;
}

template <typename Model>
double baseline_growth(const Model& model, double dt_s, int steps, std::uint64_t seed) {
    tissue::BaselineState state = tissue::rest_state(model.body);
    push(state, seed);
    auto scratch = make_scratch(model);
    return growth(steps, state.velocity_mps, [&] { step(model, {}, dt_s, scratch, state); });
}

/// What an explicit method does just below and just above its critical step.
template <typename Model>
void around_critical(std::string_view method, const std::string& of, Model model,
                     std::uint64_t seed, Rows& rows) {
    for (const double share : {0.95, 1.05}) {
        model.substep_s = share * model.critical_s;
        rows.at_most("F11", method, fmt::format("{}: {} of it: speed, of the push", of, share),
                     baseline_growth(model, model.substep_s, 1000, seed), kBounded, share > 1.0);
    }
}

double corotated_growth(const tissue::TetMesh& mesh, double poisson, std::uint64_t seed) {
    const auto model = tissue::make_corotated(mesh, elastic(poisson), {});
    tissue::CorotatedState state = tissue::rest_state(model);
    push(state, seed);
    tissue::CorotatedSystem system = tissue::make_system(model);
    std::vector<double> du(static_cast<std::size_t>(model.unknowns));
    return growth(100, state.velocity_mps, [&] {
        tissue::linearize(model, state, kStep_s, system);
        tissue::free_motion(model, state, system, du);
        tissue::advance(model, du, kStep_s, state);
    });
}

double quadratic_growth(const tissue::TetMesh& mesh, double poisson, std::uint64_t seed) {
    const auto model = tissue::make_quadratic(tissue::quadratic_mesh(mesh), elastic(poisson), {});
    tissue::QuadraticState state = tissue::rest_state(model);
    push(state, seed);
    tissue::QuadraticSystem system = tissue::make_system(model, kStep_s);
    std::vector<double> du(static_cast<std::size_t>(model.unknowns));
    return growth(100, state.velocity_mps, [&] {
        tissue::linearize(model, state, system);
        tissue::free_motion(model, {}, system, du);
        tissue::advance(model, system, du, state);
    });
}

} // namespace

void explicit_steps(std::uint64_t seed, Rows& rows) {
    const tissue::TetMesh cube = tissue::box_mesh(dvec3(kEdge_m), {6, 6, 6});
    for (const Found& p : kFound) {
        const auto model = tissue::make_tled(cube, elastic(p.poisson), {});
        const std::string nu = fmt::format("nu {}", p.poisson);
        rows.near("F11", "TLED", nu + ": critical step, ms", 1e3 * model.critical_s, p.critical_ms,
                  1.1 * p.rounding_ms / p.critical_ms, true);
        around_critical("TLED", nu, model, seed, rows);
    }
    auto haptic = tissue::make_tled(cube, elastic(0.45), {});
    haptic.substep_s = kTick_s;
    rows.at_most("F11", "TLED", "nu 0.45: steps of 1 ms: speed, of the push",
                 baseline_growth(haptic, kTick_s, 1000, seed), kBounded, true);
    // a tet 0.2 mm high: H/c_p, c_p^2 = E (1 - nu)/((1 + nu)(1 - 2 nu) rho)
    const double sliver_m = 0.2e-3, wave_mps = std::sqrt(kYoung_pa * 0.55 / (1.45 * 0.1 * 1000.0));
    rows.near("F11", "TLED", "a sliver of 0.2 mm: critical step, ms",
              1e3 *
                  tissue::make_tled(tissue::lone_tet(sliver_m), elastic(0.45), tissue::kLoneTetBase)
                      .critical_s,
              1e3 * sliver_m / wave_mps, 2e-4, true);
    around_critical("mass-spring", "its own", tissue::make_mass_spring(cube, elastic(0.45), {}),
                    seed, rows);

    for (const double poisson : {0.45, 0.499}) {
        const std::string what = fmt::format("nu {}: steps of 20 ms: speed, of the push", poisson);
        const tissue::TetMesh coarse = tissue::box_mesh(dvec3(kEdge_m), {3, 3, 3});
        rows.at_most("F11", "projective", what,
                     baseline_growth(tissue::make_projective(cube, elastic(poisson), {}), kStep_s,
                                     100, seed),
                     std::sqrt(3.0), false);
        rows.at_most("F11", "corotated", what, corotated_growth(cube, poisson, seed),
                     std::sqrt(3.0), false);
        rows.at_most("F11", "quadratic", what, quadratic_growth(coarse, poisson, seed),
                     std::sqrt(3.0), false);
    }
}

} // namespace sim::failure
