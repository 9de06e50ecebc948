// F9, inverted tetrahedra in the methods of tissue/baseline: springs do not notice; TLED's stress
// has a wall at det F = 0 that keeps a tet on the wrong side, where it finds another rest; XPBD and
// projections come back.
#include "sim/study/failure_bench.h"

#include "tissue/baseline/mass_spring.h"
#include "tissue/baseline/projective.h"
#include "tissue/baseline/run.h"
#include "tissue/baseline/tled.h"
#include "tissue/baseline/xpbd.h"

#include <cmath>

namespace sim::failure {
namespace {

constexpr double kHeight_m = 0.008;
const tissue::TetMesh kTet = tissue::lone_tet(kHeight_m);

tissue::Material material(double poisson, double damping_1ps) {
    return {.young_pa = 7e3,
            .poisson = poisson,
            .damping_mass_1ps = damping_1ps,
            .damping_stiffness_s = 0.0,
            .source = "design value"};
}

/// Where the apex is after a second, of its height; it began half its height below the base.
template <typename Model> double apex_after(const Model& model) {
    tissue::BaselineState state = tissue::rest_state(model.body);
    state.position_m[3].z = -0.5 * kHeight_m;
    tissue::run(model, {}, kTick_s, 1000, state);
    return state.position_m[3].z / kHeight_m;
}

/// F = diag(1, 1, -s) over the held base rests where
/// (2/3) mu (s^1/3 - s^-5/3) + K (s + 1) = 0: s, by bisection.
double mirrored_rest(const tissue::Elasticity& e) {
    double low = 1e-3, high = 1.0;
    for (int i = 0; i < 60; ++i) {
        const double s = 0.5 * (low + high);
        const double slope =
            2.0 / 3.0 * e.mu_pa * (std::cbrt(s) - 1.0 / std::cbrt(std::pow(s, 5))) +
            e.bulk_pa * (s + 1.0);
        (slope < 0.0 ? low : high) = s;
    }
    return low;
}

} // namespace

void inverted_baselines(Rows& rows) {
    const std::string apex = "a tet pushed through: its apex after 1 s, 1 is right";
    auto tled = tissue::make_tled(kTet, material(0.3, 2000.0), tissue::kLoneTetBase);
    tled.substep_s *= 0.05; // longer ones may leap over the wall
    rows.near("F9", "TLED", apex, apex_after(tled), -mirrored_rest(tled.elasticity), 1e-6, true);
    rows.near("F9", "XPBD", apex,
              apex_after(tissue::make_xpbd(kTet, material(0.3, 20.0), tissue::kLoneTetBase)), 1.0,
              0.01, false);
    rows.near("F9", "projective", apex,
              apex_after(tissue::make_projective(kTet, material(0.45, 20.0), tissue::kLoneTetBase)),
              1.0, 0.01, false);

    const tissue::TetMesh cube = tissue::box_mesh({0.03, 0.03, 0.03}, {3, 3, 3}, 0.1);
    const auto springs = tissue::make_mass_spring(cube, material(0.3, 20.0), {});
    tissue::BaselineState state = tissue::rest_state(springs.body);
    for (dvec3& x : state.position_m)
        x.z = -x.z;
    const tissue::BaselineReport report = tissue::run(springs, {}, 0.01, 100, state);
    rows.at_most("F9", "mass-spring", "a cube inside out: tets inverted after 1 s, of 162",
                 report.inverted, 0, true);
    rows.at_most("F9", "mass-spring", "a cube inside out: greatest speed after 1 s, m/s",
                 tissue::fastest_mps(state), 1e-9, false); // it feels nothing
}

} // namespace sim::failure
