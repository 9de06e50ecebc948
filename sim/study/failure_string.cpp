// F12, corotated without the derivative of the rotation: a taut string has its lateral stiffness
// from tension alone, and R K R^T does not contain it, so to the side it moves explicitly and holds
// up to dt = 2/w_max only, 4.494 ms here (tissue/baseline/hinged.h). A tissue loop of 20 ms then
// blows up whatever is stretched. With the exact tangent it decays at any step; so does a strip of
// ten-node tetrahedra. (Of the string they make no string: pulled at single nodes they are not
// evenly stretched.)
#include "sim/study/failure_bench.h"

#include "tissue/baseline/hinged.h"
#include "tissue/solver/quadratic.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace sim::failure {
namespace {

constexpr double kKick_m = 1e-8, kGone = 1e3;

/// Largest sag in the last tenth of the steps over that at the start; kGone once it is beyond.
template <typename Sag, typename Step> double growth(int steps, const Sag& sag, const Step& step) {
    const double start_m = sag();
    double last = 0.0;
    for (int i = 0; i < steps; ++i) {
        step();
        const double now = sag() / start_m;
        if (!(now < kGone))
            return kGone;
        if (i >= steps - steps / 10)
            last = std::max(last, now);
    }
    return last;
}

double corotated_growth(double dt_s, int steps, bool exact, std::uint64_t seed) {
    tissue::HingedRow row = tissue::taut_string({}, kKick_m, seed);
    tissue::CorotatedSystem system = tissue::make_system(row.model);
    std::vector<double> du(static_cast<std::size_t>(row.model.unknowns));
    return growth(
        steps, [&] { return tissue::sag_m(row.state.position_m); },
        [&] {
            tissue::linearize(row.model, row.state, dt_s, system, exact);
            tissue::free_motion(row.model, row.state, system, du);
            tissue::advance(row.model, du, dt_s, row.state);
        });
}

/// A strip of tissue of 320 x 4 x 4 mm, held at one end and pulled at the other by a fifth of its
/// length within 50 steps, left for 50, then its nodes moved aside by up to 0.2 mm. Tension gives
/// the lowest mode pi/0.384 m sqrt(20 kPa/1000 kg/m3) = 37 rad/s: 6 % less a step of 10 ms.
struct Strip {
    static constexpr double kLength_m = 0.32, kAside_m = 2e-4, kStretch = 0.2;
    static constexpr int kPull = 50, kKick = 100, kEnd = 300;
    tissue::TetMesh mesh = tissue::box_mesh({kLength_m, 0.004, 0.004}, {40, 1, 1});
    tissue::Material material{.young_pa = 1e5,
                              .poisson = 0.45,
                              .density_kgpm3 = 1000.0,
                              .damping_mass_1ps = 0.0,
                              .damping_stiffness_s = 0.0,
                              .source = "design value"};

    static std::vector<std::uint8_t> held(const std::vector<dvec3>& rest_m) {
        std::vector<std::uint8_t> flags;
        for (const dvec3& x : rest_m)
            flags.push_back(x.x < 1e-9 || x.x > kLength_m - 1e-9 ? 1 : 0);
        return flags;
    }
    /// Greatest speed after the last step, of the fastest aside per step.
    template <typename State, typename Step>
    static double calm(const std::vector<dvec3>& rest_m, double dt_s, std::uint64_t seed,
                       State& state, const Step& step) {
        Random random{std::mt19937_64(seed)};
        const std::vector<std::uint8_t> ends = held(rest_m);
        for (int i = 0; i < kEnd; ++i) {
            for (std::size_t n = 0; n < rest_m.size(); ++n) {
                if (ends[n] != 0)
                    state.position_m[n].x =
                        rest_m[n].x * (1.0 + kStretch * std::min(1.0, (i + 1.0) / kPull));
                else if (i == kKick)
                    state.position_m[n] +=
                        kAside_m * dvec3{0, random.between(-1, 1), random.between(-1, 1)};
            }
            step();
        }
        double most = 0.0;
        for (const dvec3& v : state.velocity_mps) {
            if (std::isnan(glm::length(v)))
                return kGone;
            most = std::max(most, glm::length(v));
        }
        return most * dt_s / kAside_m;
    }
    double corotated(double dt_s, std::uint64_t seed) const {
        const auto model = tissue::make_corotated(mesh, material, held(mesh.rest_m));
        tissue::CorotatedState state = tissue::rest_state(model);
        tissue::CorotatedSystem system = tissue::make_system(model);
        std::vector<double> du(static_cast<std::size_t>(model.unknowns));
        return calm(mesh.rest_m, dt_s, seed, state, [&] {
            tissue::linearize(model, state, dt_s, system);
            tissue::free_motion(model, state, system, du);
            tissue::advance(model, du, dt_s, state);
        });
    }
    double quadratic(double dt_s, std::uint64_t seed) const {
        const tissue::QuadraticMesh fine = tissue::quadratic_mesh(mesh);
        const auto model = tissue::make_quadratic(fine, material, held(fine.rest_m));
        tissue::QuadraticState state = tissue::rest_state(model);
        tissue::QuadraticSystem system = tissue::make_system(model, dt_s);
        std::vector<double> du(static_cast<std::size_t>(model.unknowns));
        return calm(fine.rest_m, dt_s, seed, state, [&] {
            tissue::linearize(model, state, system);
            tissue::free_motion(model, {}, system, du);
            tissue::advance(model, system, du, state);
        });
    }
};

} // namespace

void taut_strings(std::uint64_t seed, Rows& rows) {
    const double critical_s = tissue::critical_step_s({});
    const auto stable = [&](double dt_s) {
        return corotated_growth(dt_s, 2000, false, seed) < kGone;
    };
    rows.near("F12", "warped, no dR", "largest stable step, ms",
              1e3 * bisect(0.9 * critical_s, 1.1 * critical_s, stable), 1e3 * critical_s, 5e-3,
              true);
    for (const double share : {0.99, 1.01, 5.0})
        rows.at_most("F12", "warped, no dR",
                     fmt::format("{} of 2/w_max: sag after 2000 steps, of the kick", share),
                     corotated_growth(share * critical_s, 2000, false, seed), 5.0, share > 1.0);
    for (const double share : {1.01, 5.0}) {
        const std::string what =
            fmt::format("{} of 2/w_max: sag after 200 steps, of the kick", share);
        rows.at_most("F12", "corotated", what,
                     corotated_growth(share * critical_s, 200, true, seed),
                     share > 2.0 ? 1e-3 : 1.0, false);
    }
    const Strip strip;
    for (const double dt_s : {0.01, 0.02}) {
        const std::string what =
            fmt::format("a strip pulled taut, {:.0f} ms: speed after 200 steps, of "
                        "the kick",
                        1e3 * dt_s);
        rows.at_most("F12", "corotated", what, strip.corotated(dt_s, seed), 1e-3, false);
        rows.at_most("F12", "quadratic", what, strip.quadratic(dt_s, seed), 1e-3, false);
    }
}

} // namespace sim::failure
