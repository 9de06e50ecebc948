// tests/tissue/chord_test.cpp
// A corotated step that is ended by the tangent of an earlier one, against the same step of
// implicit Euler solved by Newton's method to rounding, and against statics.
#include "tests/tissue/touched_body.h"
#include "tissue/solver/chord.h"
#include "tissue/solver/corotated_assembly.h"

#include <cmath>
#include <doctest/doctest.h>

namespace {

constexpr double kDt_s = 0.01;

double norm(std::span<const double> v) {
    double sum = 0.0;
    for (const double x : v)
        sum += x * x;
    return std::sqrt(sum);
}

double apart(std::span<const double> a, std::span<const double> b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum);
}

struct Pressed {
    bodies::TouchedBlock block = bodies::touched_block({4, 4, 2}, bodies::elastic(8e3, 0.45));
    tissue::CorotatedState state = tissue::rest_state(block.model);
    tissue::CorotatedSystem system = tissue::make_system(block.model);
    tissue::Chord chord = tissue::make_chord(block.model);
    std::vector<double> load_n = std::vector<double>(block.model.unknowns);
    std::vector<double> du = load_n;

    explicit Pressed(double force_n) {
        tissue::linearize(block.model, state, kDt_s, system);
        tissue::add_row(block.model.dof, block.skin, bodies::on_top(block, 0.045, 0.035),
                        {0.3, 0.0, -1.0}, force_n, load_n);
    }
    tissue::ChordEnd step() {
        tissue::free_motion(block.model, state, system, du, load_n);
        return tissue::end_on_chord(block.model, load_n, du, system, chord, state);
    }
};

// Newton's method on the step itself, each iteration linearised where it stands. With u = x0 + d,
// A(u) e = load - M (d/dt - v)/dt - f_int(u): what free_motion() solves for a velocity v - d/dt.
std::vector<double> solved(const Pressed& p) {
    const tissue::CorotatedModel& model = p.block.model;
    tissue::CorotatedState at = p.state;
    tissue::CorotatedSystem system = tissue::make_system(model);
    std::vector<double> motion(p.du.size()), more(p.du.size());
    for (int i = 0; i < 30; ++i) {
        tissue::CorotatedState left = at;
        for (std::size_t k = 0; k < model.dof.size(); ++k) {
            const std::int32_t d = model.dof[k];
            if (d >= 0)
                left.velocity_mps[k] = p.state.velocity_mps[k] -
                                       glm::dvec3{motion[d], motion[d + 1], motion[d + 2]} / kDt_s;
        }
        tissue::linearize(model, left, kDt_s, system);
        tissue::free_motion(model, left, system, more, p.load_n);
        for (std::size_t k = 0; k < motion.size(); ++k)
            motion[k] += more[k];
        tissue::advance(model, more, kDt_s, at);
    }
    REQUIRE(norm(more) < 1e-10 * norm(motion));
    return motion;
}

} // namespace

TEST_CASE("chord: of what it corrects, a step with an older tangent leaves less than a hundredth") {
    for (const double force_n : {0.05, 0.15}) {
        CAPTURE(force_n);
        Pressed p(force_n);
        for (int i = 0; i < 4; ++i)
            REQUIRE(p.step().made); // all with the tangent of rest
        const std::vector<double> truth = solved(p);
        const tissue::ChordEnd end = p.step();
        REQUIRE(end.made);
        CHECK(end.share > 1e-4); // there is something to correct
        CHECK(apart(p.du, truth) < 1e-2 * end.share * norm(truth));
    }
}

TEST_CASE("chord: under a load that stays, an old tangent ends at the equilibrium of statics") {
    Pressed p(0.1);
    int made = 0;
    for (int i = 0; i < 1500; ++i) {
        if (p.step().made) {
            ++made;
            for (glm::dvec3& v : p.state.velocity_mps) // settles sooner
                v *= 0.5;
            continue;
        }
        tissue::advance(p.block.model, p.du, kDt_s, p.state);
        tissue::linearize(p.block.model, p.state, kDt_s, p.system);
    }
    CHECK(made > 1400);
    tissue::CorotatedState rest = tissue::rest_state(p.block.model);
    REQUIRE(tissue::solve_static(p.block.model, p.load_n, 1e-12, 50, rest).converged);
    double apart_m = 0.0, moved_m = 0.0;
    for (std::size_t i = 0; i < rest.position_m.size(); ++i) {
        apart_m = std::max(apart_m, glm::distance(rest.position_m[i], p.state.position_m[i]));
        moved_m = std::max(moved_m, glm::distance(rest.position_m[i], p.block.mesh.rest_m[i]));
    }
    CHECK(apart_m < 1e-4 * moved_m);
}

TEST_CASE("chord: a tangent that is too old is refused, and the state left as it was") {
    Pressed p(0.1);
    for (std::size_t i = 0; i < p.state.position_m.size(); ++i) // bent over by half a radian
        p.state.position_m[i].x += 12.0 * std::pow(p.block.mesh.rest_m[i].z, 2);
    const tissue::CorotatedState before = p.state;
    tissue::linearize(p.block.model, tissue::rest_state(p.block.model), kDt_s, p.system);
    p.system.internal_n.assign(p.system.internal_n.size(), 0.0);
    const tissue::ChordEnd end = p.step();
    CHECK_FALSE(end.made);
    CHECK(std::ranges::equal(p.state.position_m, before.position_m));
    CHECK(std::ranges::equal(p.state.velocity_mps, before.velocity_mps));
}

TEST_CASE(
    "chord: without contact such a step is begun again with the tangent of now, and is better") {
    const auto bent = [](tissue::CorotatedSystem& fresh) {
        Pressed p(0.1);
        for (std::size_t i = 0; i < p.state.position_m.size(); ++i)
            p.state.position_m[i].x += 6.0 * std::pow(p.block.mesh.rest_m[i].z, 2);
        tissue::linearize(p.block.model, p.state, kDt_s, fresh);
        p.system.internal_n = fresh.internal_n; // forces of now, the tangent of the rest shape
        return p;
    };
    tissue::CorotatedSystem fresh = tissue::make_system(Pressed(0.1).block.model);
    Pressed old = bent(fresh), p = bent(fresh);
    const std::vector<double> exact = solved(p);
    std::vector<double> newton(exact.size());
    tissue::free_motion(p.block.model, p.state, fresh, newton, p.load_n);
    CHECK_FALSE(old.step().made);
    tissue::free_motion(p.block.model, p.state, p.system, p.du, p.load_n);
    const tissue::FreshEnd end =
        tissue::end_or_begin_again(p.block.model, p.load_n, p.du, p.system, p.chord, p.state);
    CHECK(end.end.made);
    CHECK(end.new_tangent);
    MESSAGE("off by " << apart(p.du, exact) / norm(exact) << ", one iteration of Newton's by "
                      << apart(newton, exact) / norm(exact) << ", with the old tangent "
                      << apart(old.du, exact) / norm(exact));
    CHECK(apart(p.du, exact) < 0.25 * apart(newton, exact));
    std::vector<double> force_n(exact.size());
    tissue::assemble_forces(p.block.model, p.state, force_n);
    CHECK(apart(p.system.internal_n, force_n) < 1e-9 * norm(force_n)); // for the next step
}

TEST_CASE("chord: what is not a number is refused") {
    Pressed p(0.1);
    p.load_n[7] = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(p.step().made);
}
