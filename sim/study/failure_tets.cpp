// sim/study/failure_tets.cpp
// F9, inverted tetrahedra: a tool that pushes a vertex through the opposite face leaves tissue
// turned inside out. StVK has a second rest there, and gives way below a stretch of 1/sqrt 3; the
// logarithm of a neo-Hookean material has no value. The corotated solver has to come back to its
// rest volume within a second, without gaining energy. One Newton iteration per FEM step does
// neither: it leaves the reach of the tangent of an inverted tet. Steps with inverted tets are made
// again by descent (tissue/solver/descent.h), here as in the tissue loop; the quadratic solver is a
// linear body until nothing is inverted (tissue/solver/quadratic_recovery.h). What the methods of
// tissue/baseline do: failure_tets_baseline.cpp.
#include "sim/study/failure_bench.h"

#include "tissue/solver/descent.h"
#include "tissue/solver/quadratic.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace sim::failure {
namespace {

/// A tet on a fixed base whose apex moves straight: F = diag(1, 1, stretch), psi per mu + lambda/2
/// and lambda = mu, which is all that the shape of the energy depends on here.
struct Lone {
    double (*force)(double stretch); // -dpsi/dstretch
};

double stvk(double s) {
    return -s * (s * s - 1.0); // psi = (s^2 - 1)^2 / 4
}

double neo_hookean(double s) { // psi = s^2 / 2 - ln s + (ln s)^2 / 2, J = s
    return -(s - 1.0 / s + std::log(s) / s);
}

/// Where the apex comes to rest, critically damped about its rest.
double settled(const Lone& tet, double stretch) {
    double rate = 0.0;
    for (int i = 0; i < 20000; ++i) {
        rate += 1e-2 * (tet.force(stretch) - 2.8 * rate);
        stretch += 1e-2 * rate;
    }
    return stretch;
}

struct Recovery {
    double volume_error = 0.0; // after a second, relative
    double gain = 0.0;         // largest increase of energy in a step, of what it began with
    int inverted = 0;          // tets, at the end
    bool finite = true;
};

double kinetic_j(const tissue::CorotatedModel& model, const tissue::CorotatedState& state) {
    double sum = 0.0;
    for (std::size_t i = 0; i < model.mass_kg.size(); ++i)
        sum += 0.5 * model.mass_kg[i] * glm::dot(state.velocity_mps[i], state.velocity_mps[i]);
    return sum;
}

constexpr double kStep_s = 0.02; // of the FEM
constexpr int kSteps = 50;       // one second
const tissue::Material kMaterial{.young_pa = 10e3, .poisson = 0.45, .source = "design value"};

double volume_error(const tissue::TetMesh& mesh, const std::vector<dvec3>& position_m) {
    return std::abs(tissue::volume_m3(mesh, position_m) / tissue::volume_m3(mesh, mesh.rest_m) -
                    1.0);
}

/// A free body from these places, at rest. `by_descent` false: one Newton iteration in every step.
Recovery recover(const tissue::TetMesh& mesh, const std::vector<dvec3>& from_m, bool by_descent) {
    const tissue::CorotatedModel model = tissue::make_corotated(mesh, kMaterial, {});
    tissue::CorotatedState state = tissue::rest_state(model);
    state.position_m = from_m;
    tissue::CorotatedSystem system = tissue::make_system(model);
    tissue::Descent descent = tissue::make_descent(model);
    std::vector<double> du(static_cast<std::size_t>(model.unknowns));
    const double start_j = tissue::elastic_energy_j(model, state);
    double before_j = start_j;
    Recovery out;
    tissue::linearize(model, state, kStep_s, system);
    for (int i = 0; i < kSteps; ++i) {
        tissue::free_motion(model, state, system, du);
        if (by_descent) {
            tissue::finish_step(model, {}, du, system, descent, state);
        } else {
            tissue::advance(model, du, kStep_s, state);
            tissue::linearize(model, state, kStep_s, system);
        }
        const double now_j = tissue::elastic_energy_j(model, state) + kinetic_j(model, state);
        out.finite = out.finite && system.factored && std::isfinite(now_j);
        out.gain = std::max(out.gain, (now_j - before_j) / start_j);
        before_j = now_j;
    }
    out.inverted = system.inverted;
    out.volume_error = volume_error(mesh, state.position_m);
    return out;
}

/// The same in ten-node tetrahedra, edge nodes halfway. Inside out there is no energy to compare.
Recovery recover_quadratic(const tissue::TetMesh& mesh, const std::vector<dvec3>& from_m) {
    const tissue::QuadraticMesh fine = tissue::quadratic_mesh(mesh);
    const auto model = tissue::make_quadratic(fine, kMaterial, {});
    tissue::QuadraticState state = tissue::rest_state(model);
    std::copy(from_m.begin(), from_m.end(), state.position_m.begin());
    for (const tissue::Tet10& t : fine.tets)
        for (std::size_t k = 0; k < tissue::kEdge.size(); ++k)
            state.position_m[t[4 + k]] = 0.5 * (state.position_m[t[tissue::kEdge[k][0]]] +
                                                state.position_m[t[tissue::kEdge[k][1]]]);
    tissue::QuadraticSystem system = tissue::make_system(model, kStep_s);
    std::vector<double> du(static_cast<std::size_t>(model.unknowns));
    tissue::QuadraticReport report;
    Recovery out;
    for (int i = 0; i < kSteps; ++i) {
        tissue::linearize(model, state, system);
        report = tissue::free_motion(model, {}, system, du);
        tissue::advance(model, system, du, state);
        for (const double d : du)
            out.finite = out.finite && std::isfinite(d);
    }
    out.inverted = report.recovering;
    state.position_m.resize(mesh.rest_m.size());
    out.volume_error = volume_error(mesh, state.position_m);
    return out;
}

/// What a solver may not do, over many bodies of one kind.
struct Recoveries {
    int bodies = 0, late = 0, inverted = 0, broken = 0;
    double gain = 0.0;

    void add(const Recovery& r) {
        ++bodies;
        late += !(r.volume_error <= 1e-3);
        inverted += r.inverted > 0;
        broken += !r.finite;
        gain = std::max(gain, r.gain);
    }
    void tell(const char* method, const std::string& shape, Rows& rows) const {
        const std::string of = fmt::format(", of {}", bodies);
        rows.at_most("F9", method, shape + ": volume not back in 1 s" + of, late, 0, false);
        rows.at_most("F9", method, shape + ": inverted after 1 s" + of, inverted, 0, false);
        rows.at_most("F9", method, shape + ": not finite" + of, broken, 0, false);
    }
};

dvec3 in_ball(double radius_m, Random& random) {
    for (;;) {
        const dvec3 x{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        if (glm::length(x) <= 1.0)
            return radius_m * x;
    }
}

} // namespace

void inverted_tets(std::uint64_t seed, Rows& rows) {
    constexpr int kBodies = 40, kQuadratic = 12; // of each start; quadratic ones are slower
    Random random{std::mt19937_64(seed)};
    const double h_m = 0.01;
    const tissue::TetMesh lone{{{0, 0, 0}, {h_m, 0, 0}, {0, h_m, 0}, {0, 0, h_m}}, {{0, 1, 2, 3}}};
    std::array<Recoveries, 3> ours, quadratic; // by start
    Recoveries newton;                         // of the worst
    for (int i = 0; i < kBodies; ++i) {
        const auto from = [&](const tissue::TetMesh& mesh, std::size_t start,
                              const std::vector<dvec3>& from_m) {
            ours[start].add(recover(mesh, from_m, true));
            if (start == 2)
                newton.add(recover(mesh, from_m, false));
            if (i < kQuadratic)
                quadratic[start].add(recover_quadratic(mesh, from_m));
        };
        std::vector<dvec3> from_m = lone.rest_m;
        from_m[3] = {random.between(0, h_m), random.between(0, h_m), -random.between(0.1, 1) * h_m};
        from(lone, 0, from_m);
        const tissue::TetMesh cube =
            tissue::box_mesh({0.03, 0.03, 0.03}, {3, 3, 3}, 0.1, random.engine());
        std::vector<dvec3> ball = cube.rest_m, flat = ball, inside_out = ball;
        for (dvec3& x : ball)
            x = in_ball(0.015, random);
        for (dvec3& x : flat)
            x.z = 0.0;
        for (dvec3& x : inside_out)
            x.z = -x.z;
        from(cube, 2, ball);
        from(cube, 1, flat);
        from(cube, 2, inside_out);
    }
    const std::array<std::string, 3> starts{"a tet pushed through", "a cube flattened",
                                            "a cube in a ball, or inside out"};
    for (std::size_t k = 0; k < starts.size(); ++k) {
        ours[k].tell("corotated", starts[k], rows);
        rows.at_most("F9", "corotated", starts[k] + ": energy gained in a step, share",
                     ours[k].gain, 1e-12, false);
        quadratic[k].tell("quadratic", starts[k], rows);
    }

    const std::string of = fmt::format(", of {}", newton.bodies);
    rows.at_most("F9", "one Newton a step", starts[2] + ": volume not back in 1 s" + of,
                 newton.late, 0, true);
    rows.at_most("F9", "one Newton a step", starts[2] + ": inverted after 1 s" + of,
                 newton.inverted, 0, true);
    rows.at_most("F9", "one Newton a step", starts[2] + ": energy gained in a step, share",
                 newton.gain, 1.0, true); // as much as it began with, and more
    rows.near("F9", "StVK", "a tet pushed through: where it rests, 1 is right",
              settled({stvk}, -0.5), -1.0, 1e-6, true);
    double softest = 1.0; // where squeezing more meets less
    for (double s = 1.0; s > 0.0; s -= 1e-5)
        if (stvk(s) > stvk(softest))
            softest = s;
    rows.near("F9", "StVK", "stretch below which it gives way", softest, 1.0 / std::sqrt(3.0), 1e-4,
              true);
    rows.at_most("F9", "neo-Hookean", "a tet pushed through: not finite",
                 !std::isfinite(settled({neo_hookean}, -0.5)), 0, true);
    inverted_baselines(rows);
}

} // namespace sim::failure
