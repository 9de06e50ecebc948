#include "haptics/contact/contact_rows.h"

#include "tests/haptics/sneddon_table.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <random>

namespace {

using haptics::ContactMemory;
using haptics::ContactProblem;
using haptics::ContactRow;
using haptics::ContactSolution;
using haptics::kTools;
using haptics::LocalLaw;
using Memory = std::array<ContactMemory, kTools>;

constexpr double kTipRadius_m = 3e-3;
const SneddonSphere kSphere;

const haptics::IndenterTable& table() {
    static const haptics::IndenterTable t = sneddon_table(kSphere);
    return t;
}

glm::dvec3 across(const glm::dvec3& v, const glm::dvec3& n) {
    return v - n * glm::dot(v, n);
}

// One tool over a plane with normal z at the origin.
ContactProblem one_tool(const LocalLaw& law, double friction, const glm::dvec3& tip_m,
                        double compliance_mpn) {
    ContactProblem p;
    p.row[0] = ContactRow{.active = true,
                          .tip_m = tip_m,
                          .tip_radius_m = kTipRadius_m,
                          .friction = friction,
                          .law = law};
    p.compliance[0][0] = glm::dmat3{compliance_mpn};
    return p;
}

glm::dvec3 depth_tip(double depth_m) {
    return {0, 0, kTipRadius_m - depth_m};
}

// Random tools over tissue with a random symmetric positive 9x9 compliance of about 1 mm/N.
struct RandomCase {
    ContactProblem problem;
    Memory memory;
};

RandomCase random_case(std::uint32_t seed, bool table_law) {
    std::mt19937 rng(seed);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(rng);
    };
    const auto vector = [&](double size) {
        return glm::dvec3{uniform(-size, size), uniform(-size, size), uniform(-size, size)};
    };
    double B[9][9];
    for (auto& row : B)
        for (double& b : row)
            b = uniform(-1.0, 1.0);
    RandomCase c;
    for (int i = 0; i < kTools; ++i) {
        ContactRow& r = c.problem.row[i];
        r.active = uniform(0, 1) < 0.9;
        r.normal = glm::normalize(vector(1.0) + glm::dvec3{0, 0, 0.2});
        r.tip_radius_m = kTipRadius_m;
        r.surface_free_m = vector(0.1);
        r.tip_m = r.surface_free_m + r.normal * (kTipRadius_m - uniform(-1e-3, 4e-3)) +
                  across(vector(2e-3), r.normal);
        r.friction = uniform(0, 1) < 0.2 ? 0.0 : uniform(0.0, 0.5);
        r.law = {
            .normal_mpn = uniform(0, 2e-3), .tangential_mpn = uniform(0, 2e-3), .floor_mpn = 1e-3};
        if (table_law)
            r.law.table = &table();
        if (uniform(0, 1) < 0.7)
            c.memory[i] = {.touching = true,
                           .friction_n = across(vector(0.3), r.normal),
                           .lag_m = across(vector(5e-4), r.normal),
                           .x = uniform(0, 1)};
        for (int j = 0; j < kTools; ++j)
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b) {
                    double sum = i == j && a == b ? 1e-3 : 0.0;
                    for (int k = 0; k < 9; ++k)
                        sum += 2e-4 * B[3 * i + a][k] * B[3 * j + b][k];
                    c.problem.compliance[i][j][b][a] = sum;
                }
    }
    return c;
}

// (p - y) of tool i under forces F.
glm::dvec3 offset_m(const ContactProblem& p, const std::array<glm::dvec3, kTools>& F, int i) {
    glm::dvec3 d = p.row[i].tip_m - p.row[i].surface_free_m;
    for (int j = 0; j < kTools; ++j)
        if (p.row[j].active)
            d += p.compliance[i][j] * F[j];
    return d;
}

// Nearest point of the Coulomb cone about n.
glm::dvec3 onto_cone(const glm::dvec3& f, const glm::dvec3& n, double mu) {
    const double normal = glm::dot(f, n);
    const glm::dvec3 t = across(f, n);
    const double size = glm::length(t);
    if (size <= mu * normal)
        return f;
    if (mu * size <= -normal)
        return glm::dvec3{0.0};
    const double along = (normal + mu * size) / (1.0 + mu * mu);
    return along * n + t * (mu * along / size);
}

// Independent solver: de Saxce's bipotential iteration F <- cone(F - rho (v + mu |v_t| n)).
std::array<glm::dvec3, kTools> bipotential(const ContactProblem& p, const Memory& memory) {
    std::array<glm::dvec3, kTools> F{};
    for (int it = 0; it < 20000; ++it) {
        double change = 0.0;
        for (int i = 0; i < kTools; ++i) {
            const ContactRow& r = p.row[i];
            if (!r.active)
                continue;
            const double normal_mpn = std::max(r.law.normal_mpn, r.law.floor_mpn);
            const double tangent_mpn = std::max(r.law.tangential_mpn, r.law.floor_mpn);
            const glm::dvec3 d = offset_m(p, F, i);
            glm::dvec3 before{0.0};
            if (r.friction > 0.0)
                before = memory[i].touching ? tangent_mpn * memory[i].friction_n + memory[i].lag_m
                                            : across(r.tip_m - r.surface_free_m, r.normal);
            const glm::dvec3 slip = across(d + tangent_mpn * F[i] - before, r.normal);
            const double gap =
                glm::dot(d, r.normal) - r.tip_radius_m + normal_mpn * glm::dot(F[i], r.normal);
            const double rho = 100.0;
            const glm::dvec3 next =
                onto_cone(F[i] - rho * (slip + (gap + r.friction * glm::length(slip)) * r.normal),
                          r.normal, r.friction);
            change = std::max(change, glm::length(next - F[i]));
            F[i] = next;
        }
        if (change < 1e-13)
            break;
    }
    return F;
}

} // namespace

TEST_CASE("contact rows: three tools agree with an independent bipotential solver") {
    int pressed = 0;
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        RandomCase c = random_case(seed, false);
        const auto expected = bipotential(c.problem, c.memory);
        const ContactSolution s = haptics::solve_contact(c.problem, c.memory);
        CHECK(s.residual_m <= 1e-12);
        for (int i = 0; i < kTools; ++i) {
            CHECK(glm::length(s.force_n[i] - expected[i]) <= 1e-8);
            pressed += glm::length(expected[i]) > 0.0;
        }
    }
    CHECK(pressed > 300);
}

TEST_CASE("contact rows: the solution satisfies Signorini and Coulomb on the tissue's own law") {
    int slid = 0;
    int stuck = 0;
    int sweeps = 0;
    for (std::uint32_t seed = 1000; seed < 2000; ++seed) {
        RandomCase c = random_case(seed, true);
        const Memory before = c.memory;
        const ContactSolution s = haptics::solve_contact(c.problem, c.memory);
        sweeps = std::max(sweeps, s.sweeps);
        for (int i = 0; i < kTools; ++i) {
            const ContactRow& r = c.problem.row[i];
            const double P = glm::dot(s.force_n[i], r.normal);
            CHECK(P >= 0.0);
            if (!r.active)
                continue;
            const glm::dvec3 d = offset_m(c.problem, s.force_n, i);
            const double depth_m = r.tip_radius_m - glm::dot(d, r.normal);
            if (P == 0.0) {
                CHECK(depth_m <= 1e-11);
                CHECK(glm::length(s.force_n[i]) == 0.0);
                continue;
            }
            const double x = std::cbrt(P / table().force_scale_n);
            CHECK(std::abs(depth_m - haptics::law_at(r.law, x).depth_m) <= 1e-11);
            const glm::dvec3 Ft = across(s.force_n[i], r.normal);
            CHECK(glm::length(Ft) <= r.friction * P * (1.0 + 1e-12) + 1e-15);
            if (r.friction == 0.0)
                continue;
            // what is not spring is slip, and slip opposes friction at the limit
            const bool was = before[i].touching;
            const glm::dvec3 F0 = was ? before[i].friction_n : glm::dvec3{0.0};
            const glm::dvec3 lag0 =
                was ? before[i].lag_m : across(r.tip_m - r.surface_free_m, r.normal);
            const glm::dvec3 slip =
                across(d - lag0 + haptics::tangential_compliance(r.law, x) * (Ft - F0), r.normal);
            CHECK(glm::dot(slip, Ft) <= 1e-13);
            if (glm::length(Ft) < r.friction * P * (1.0 - 1e-9)) {
                CHECK(glm::length(slip) <= 1e-11);
                ++stuck;
            } else {
                CHECK(
                    glm::dot(slip, Ft) ==
                    doctest::Approx(-glm::length(slip) * glm::length(Ft)).scale(0.0).epsilon(1e-6));
                ++slid;
            }
        }
    }
    CHECK(slid > 100);
    CHECK(stuck > 100);
    CHECK(sweeps < haptics::kMaxSweeps);
}

TEST_CASE("contact rows: a shallow sphere is Hertz's") {
    const LocalLaw law{.table = &table()};
    const double depth_m = 2e-6; // a_c / a = 0.026: Sneddon's next term is 1e-4 of it
    Memory memory;
    const ContactProblem p = one_tool(law, 0.0, depth_tip(depth_m), 0.0);
    const double force = haptics::solve_contact(p, memory).force_n[0].z;
    const double hertz =
        4.0 / 3.0 * kSphere.plane_modulus_pa * std::sqrt(kTipRadius_m) * std::pow(depth_m, 1.5);
    CHECK(force == doctest::Approx(hertz).scale(0.0).epsilon(1e-3));
}

TEST_CASE("contact rows: a deep sphere is Sneddon's") {
    const LocalLaw law{.table = &table()};
    Memory memory;
    for (const double depth_m : {0.2e-3, 1e-3, 3e-3, 8e-3, 4e-3}) {
        const ContactProblem p = one_tool(law, 0.0, depth_tip(depth_m), 0.0);
        CHECK(haptics::solve_contact(p, memory).force_n[0].z ==
              doctest::Approx(kSphere.force_at_depth_n(depth_m)).scale(0.0).epsilon(3e-4));
    }
}

TEST_CASE("contact rows: a rigid body is as stiff as the coupling and no stiffer") {
    const LocalLaw law{.floor_mpn = 1.0 / 800.0};
    Memory memory;
    const ContactProblem p = one_tool(law, 0.0, depth_tip(1e-3), 0.0);
    CHECK(haptics::solve_contact(p, memory).force_n[0].z ==
          doctest::Approx(0.8).scale(0.0).epsilon(1e-12));
}

TEST_CASE("contact rows: a dragged block reaches exactly the Coulomb limit and stays there") {
    const LocalLaw law{.table = &table(), .normal_mpn = 1e-3, .floor_mpn = 1e-3};
    constexpr double kMu = 0.3;
    Memory memory;
    glm::dvec3 surface_m{0.0};
    ContactSolution s;
    double work_j = 0.0;
    for (int ms = 0; ms < 400; ++ms) {
        ContactProblem p = one_tool(law, kMu, depth_tip(3e-3) + glm::dvec3{ms * 2e-5, 0, 0}, 2e-3);
        p.row[0].surface_free_m = surface_m;
        s = haptics::solve_contact(p, memory);
        surface_m += s.slip_m[0];
        work_j = glm::dot(s.force_n[0], s.slip_m[0]);
        CHECK(work_j <= 0.0);
    }
    CHECK(s.force_n[0].z > 0.05);
    CHECK(-s.force_n[0].x == doctest::Approx(kMu * s.force_n[0].z).scale(0.0).epsilon(1e-9));
    CHECK(s.slip_m[0].x ==
          doctest::Approx(2e-5).scale(0.0).epsilon(1e-6)); // slides as fast as it is dragged
}

TEST_CASE("contact rows: friction builds up along the tangential spring until it slides") {
    constexpr double kTangent_mpn = 2e-3;
    const LocalLaw law{.tangential_mpn = kTangent_mpn, .floor_mpn = 1e-3};
    Memory memory;
    for (int ms = 0; ms <= 100; ++ms) {
        const double drag_m = ms * 1e-6;
        const ContactProblem p =
            one_tool(law, 0.4, depth_tip(1e-3) + glm::dvec3{0, drag_m, 0}, 0.0);
        const ContactSolution s = haptics::solve_contact(p, memory);
        // rounding of the 1e-4 m at the end; at first there is none to pull
        CHECK(std::abs(s.force_n[0].y + drag_m / kTangent_mpn) < 1e-15 / kTangent_mpn);
        CHECK(s.slip_m[0] == glm::dvec3{0.0});
    }
}

TEST_CASE("contact rows: a stuck tool does not creep in ten seconds of trembling") {
    const LocalLaw law{.table = &table(), .floor_mpn = 1e-3};
    Memory memory;
    glm::dvec3 surface_m{0.0};
    const double reach_m = 2e-4; // well inside the limit
    for (int ms = 0; ms < 10000; ++ms) {
        const glm::dvec3 tremor{reach_m + 2e-5 * std::sin(0.06 * ms), 1e-5 * std::cos(0.05 * ms),
                                0.0};
        ContactProblem p = one_tool(law, 0.4, depth_tip(4e-3) + tremor, 1e-3);
        p.row[0].surface_free_m = surface_m;
        surface_m += haptics::predicted_slip(p.row[0], p.compliance[0][0], memory[0]) *
                     (memory[0].touching ? 1.0 : 0.0);
        p.row[0].surface_free_m = surface_m;
        surface_m += haptics::solve_contact(p, memory).slip_m[0];
    }
    CHECK(glm::length(surface_m) < 1e-6);
    CHECK(memory[0].touching);
}

TEST_CASE("contact rows: a first touch beside its point along the normal does not pull") {
    // as over a facet, whose nearest point is not on the smooth normal
    const LocalLaw law{.tangential_mpn = 1e-3, .floor_mpn = 1e-3};
    Memory memory;
    const glm::dvec3 beside{2e-4, -1e-4, 0};
    const ContactSolution s =
        haptics::solve_contact(one_tool(law, 0.3, depth_tip(1e-3) + beside, 0.0), memory);
    CHECK(s.force_n[0].z == doctest::Approx(1.0).scale(0.0));
    CHECK(glm::length(across(s.force_n[0], {0, 0, 1})) < 1e-12);
    CHECK(s.slip_m[0] == glm::dvec3{0.0});
    // and from there on it sticks: 0.1 mm at 1 mm/N
    const glm::dvec3 moved = beside + glm::dvec3{1e-4, 0, 0};
    const ContactSolution held =
        haptics::solve_contact(one_tool(law, 0.3, depth_tip(1e-3) + moved, 0.0), memory);
    CHECK(held.force_n[0].x == doctest::Approx(-0.1).scale(0.0));
    CHECK(std::abs(held.force_n[0].y) < 1e-12);
}

TEST_CASE("contact rows: unloading straight up slides when the limit falls below the friction") {
    const LocalLaw law{.tangential_mpn = 1e-3, .floor_mpn = 1e-3};
    Memory memory;
    const auto press = [&](double depth_m, double along_m) {
        const ContactProblem p =
            one_tool(law, 0.3, depth_tip(depth_m) + glm::dvec3{along_m, 0, 0}, 0.0);
        return haptics::solve_contact(p, memory);
    };
    press(1e-3, 0.0);
    CHECK(press(1e-3, 2e-4).slip_m[0].x == 0.0); // 0.2 N of friction, limit 0.3 N
    const ContactSolution s = press(5e-4, 2e-4);
    CHECK(-s.force_n[0].x == doctest::Approx(0.3 * 0.5).scale(0.0));
    CHECK(s.slip_m[0].x == doctest::Approx(0.05 * 1e-3).scale(0.0)); // the spring gives 0.05 N back
}

TEST_CASE("contact rows: without friction the tip slides by its whole tangential offset") {
    const LocalLaw law{.floor_mpn = 1e-3};
    Memory memory;
    const ContactProblem p = one_tool(law, 0.0, depth_tip(1e-3) + glm::dvec3{3e-4, -1e-4, 0}, 1e-3);
    const ContactSolution s = haptics::solve_contact(p, memory);
    CHECK(s.slip_m[0].x == doctest::Approx(3e-4).scale(0.0));
    CHECK(s.slip_m[0].y == doctest::Approx(-1e-4).scale(0.0));
    CHECK(s.force_n[0].x == 0.0);
    const glm::dvec3 predicted = haptics::predicted_slip(p.row[0], p.compliance[0][0], memory[0]);
    CHECK(glm::length(predicted - s.slip_m[0]) < 1e-15);
}

TEST_CASE("contact rows: the slip predicted at unchanged pressure is the slip of the solve") {
    const LocalLaw law{.tangential_mpn = 1.5e-3, .floor_mpn = 1e-3};
    Memory memory;
    ContactProblem p = one_tool(law, 0.3, depth_tip(2e-3), 1e-3);
    p.compliance[0][0][0][1] = p.compliance[0][0][1][0] = 4e-4; // tangents couple
    haptics::solve_contact(p, memory);
    p.row[0].tip_m += glm::dvec3{9e-4, 5e-4, 0};
    const glm::dvec3 predicted = haptics::predicted_slip(p.row[0], p.compliance[0][0], memory[0]);
    const ContactSolution s = haptics::solve_contact(p, memory);
    CHECK(glm::length(s.slip_m[0]) > 1e-4);
    CHECK(glm::length(predicted - s.slip_m[0]) < 1e-12);
}

TEST_CASE("contact rows: the lag never grows beyond the tip's radius and how deep it is") {
    constexpr double kDeep_m = 1e-3, kMost_m = kTipRadius_m + kDeep_m;
    const LocalLaw law{.tangential_mpn = 50e-3, .floor_mpn = 1e-3};
    Memory memory;
    for (int ms = 0; ms < 50; ++ms) {
        const ContactProblem p =
            one_tool(law, 1.0, depth_tip(kDeep_m) + glm::dvec3{ms * 1e-4, 0, 0}, 0.0);
        const ContactSolution s = haptics::solve_contact(p, memory);
        CHECK(glm::length(memory[0].lag_m) <= kMost_m * (1 + 1e-12));
        if (ms == 49)
            CHECK(s.slip_m[0].x == doctest::Approx(4.9e-3 - kMost_m).scale(0.0));
    }
}

TEST_CASE("contact rows: a tool in the air feels nothing and remembers nothing") {
    const LocalLaw law{.table = &table(), .floor_mpn = 1e-3};
    Memory memory;
    memory[0] = {.touching = true, .friction_n = {0.1, 0, 0}, .lag_m = {1e-4, 0, 0}, .x = 0.3};
    const ContactProblem p = one_tool(law, 0.3, depth_tip(-1e-6), 1e-3);
    const ContactSolution s = haptics::solve_contact(p, memory);
    CHECK(s.force_n[0] == glm::dvec3{0.0});
    CHECK_FALSE(memory[0].touching);
    CHECK(memory[0].lag_m == glm::dvec3{0.0});
}

TEST_CASE("contact rows: what is not finite gives zero force and clears the memory") {
    const LocalLaw law{.table = &table(), .floor_mpn = 1e-3};
    const double nan = std::nan("");
    for (int what = 0; what < 4; ++what) {
        Memory memory;
        ContactProblem p = one_tool(law, 0.3, depth_tip(1e-3), 1e-3);
        haptics::solve_contact(p, memory);
        if (what == 0)
            p.row[0].tip_m.y = nan;
        if (what == 1)
            p.compliance[0][0][2][2] = HUGE_VAL;
        if (what == 2)
            p.row[0].law.radius_over_thickness = nan;
        if (what == 3)
            memory[0].lag_m.x = nan;
        const ContactSolution s = haptics::solve_contact(p, memory);
        CHECK(s.force_n[0] == glm::dvec3{0.0});
        CHECK(s.residual_m == HUGE_VAL);
        CHECK_FALSE(memory[0].touching);
        CHECK(memory[0].lag_m == glm::dvec3{0.0});
    }
}

TEST_CASE("contact rows: nothing that yields at all is no force, not an infinite one") {
    Memory memory;
    const ContactSolution s =
        haptics::solve_contact(one_tool({}, 0.3, depth_tip(1e-3), 0.0), memory);
    CHECK(s.force_n[0] == glm::dvec3{0.0});
    CHECK(s.residual_m == HUGE_VAL);
}
