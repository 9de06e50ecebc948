// A rod behind points: what contact is told of it is what it does.
#include "tests/tissue/rods.h"
#include "tissue/rod/rod_points.h"

#include <doctest/doctest.h>
#include <numbers>

using glm::dvec3;
using std::numbers::pi;

namespace {

struct Tube {
    tissue::RodModel model = rods::straight({.edges = 20, .both = true});
    tissue::RodState state = rest_state(model);
    tissue::RodSystem system = make_system(model);
    tissue::RodPoints points;
    std::size_t unknowns = 0;
};

// Rings of 6 points on the skin, every 5 mm.
Tube tube() {
    std::vector<dvec3> x_m;
    for (int ring = 0; ring <= 20; ++ring) {
        for (int k = 0; k < 6; ++k)
            x_m.emplace_back(5e-3 * ring, 3e-3 * std::cos(k * pi / 3), 3e-3 * std::sin(k * pi / 3));
    }
    Tube t;
    t.points = make_points(t.model, x_m);
    t.unknowns = 3 * x_m.size();
    return t;
}

} // namespace

TEST_CASE("points of a rod under a load come to rest where statics has them, by 20 ms steps") {
    Tube t = tube();
    std::vector<double> load_n(t.unknowns, 0.0), du(t.unknowns);
    for (std::size_t k = 0; k < 6; ++k)
        load_n[3 * (10 * 6 + k) + 2] = 1e-3 / 6; // the middle ring, along z
    for (int i = 0; i < 400; ++i) {
        linearize(t.model, t.state, 0.02, t.system);
        free_motion(t.model, t.state, t.system, load_n, t.points, du);
        end_step(t.model, load_n, {}, t.points, du, t.system, t.state);
    }
    double middle_m = 0.0;
    for (std::size_t k = 0; k < 6; ++k)
        middle_m += t.points.position_m[10 * 6 + k].z / 6;
    tissue::RodState still = rest_state(t.model);
    // the same force on the line; blended, a quarter of it bends the neighbouring nodes
    rods::step(t.model, rods::kStatics_s, rods::load_at(t.model, 11, {0, 0, 1e-3}), t.system,
               still);
    CHECK(middle_m == doctest::Approx(still.position_m[11].z).scale(0.0).epsilon(0.01));
}

TEST_CASE("the answer of a rod to a small change of load on points is the one it was solved for") {
    Tube t = tube();
    std::vector<double> before(t.unknowns, 0.0), after(t.unknowns, 0.0), du(t.unknowns);
    before[3 * 50 + 1] = 2e-3;
    for (int i = 0; i < 200; ++i) {
        linearize(t.model, t.state, 0.02, t.system);
        end_step(t.model, before, {.tolerance = 1e-10}, t.points, du, t.system, t.state);
    }
    linearize(t.model, t.state, 0.02, t.system);
    std::vector<double> answer(t.unknowns, 0.0);
    answer[3 * 62 + 2] = 1e-6;
    after = before;
    after[3 * 62 + 2] += 1e-6;
    solve(t.model, t.state, t.system, t.points, answer, 1);
    end_step(t.model, after, {.tolerance = 1e-12}, t.points, du, t.system, t.state);
    double most = 0.0, off = 0.0;
    for (std::size_t i = 0; i < t.unknowns; ++i) {
        most = std::max(most, std::abs(answer[i]));
        off = std::max(off, std::abs(answer[i] - du[i]));
    }
    CHECK(most > 1e-9);
    CHECK(off < 1e-3 * most);
}

TEST_CASE("what one point of a rod gives under a load at another is the same the other way") {
    Tube t = tube();
    linearize(t.model, t.state, 0.02, t.system);
    std::vector<double> block(2 * t.unknowns, 0.0);
    const std::size_t a = 3 * 40 + 1, b = 3 * 77 + 2;
    block[a] = 1.0;
    block[t.unknowns + b] = 1.0;
    solve(t.model, t.state, t.system, t.points, block, 2);
    CHECK(block[b] == doctest::Approx(block[t.unknowns + a]).scale(0.0).epsilon(1e-9));
    CHECK(block[a] > 0.0);
    CHECK(block[t.unknowns + b] > 0.0);
}
