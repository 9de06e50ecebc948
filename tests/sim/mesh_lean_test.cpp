// tests/sim/mesh_lean_test.cpp
// What linear tetrahedra owe where a body bends aslant to its skin. A beam whose section is a
// parallelogram, held at one end: its top looks up, and it bends along the section's own axes. The
// reference is beam theory with unsymmetric bending (Timoshenko & Goodier 1970, 102).
#include "haptics/contact/model_step.h"
#include "sim/bridge/mesh_lean.h"
#include "sim/check/rest_feel.h"
#include "tests/sim/organ_bench.h"
#include "tissue/response/footprint_kernel.h"
#include "tissue/response/mesh_term.h"

#include <doctest/doctest.h>
#include <glm/matrix.hpp>
#include <random>

using glm::dmat2;
using glm::dmat3;
using glm::dvec2;
using glm::dvec3;

namespace {

constexpr double kLength_m = 0.09, kWidth_m = 0.022, kHeight_m = 0.012, kSlant = 0.8;
constexpr double kLoaded_m = 0.075; // from the held end
constexpr double kYoung_pa = 20e3, kPoisson = 0.4;

tissue::Material material() {
    return organ_tests::material_of({.young_pa = kYoung_pa}, 4.0);
}

// `turn` acts on all of it.
std::shared_ptr<tissue::BakedOrgan> beam(const dmat3& turn = dmat3{1.0}) {
    const dvec3 size_m{kLength_m, kWidth_m, kHeight_m};
    auto organ = std::make_shared<tissue::BakedOrgan>();
    organ->name = "beam";
    organ->mesh = tissue::box_mesh(size_m, {14, 3, 2});
    organ->surface = organ_tests::box_skin(dvec3{0.0}, size_m, 3e-3);
    const auto place = [&](dvec3& x) {
        x -= dvec3{0.0, 0.5 * kWidth_m, 0.5 * kHeight_m};
        x.y += kSlant * x.z;
        x = turn * x;
    };
    for (dvec3& x : organ->mesh.rest_m) {
        organ->anchored.push_back(x.x < 1e-9);
        place(x);
    }
    for (dvec3& x : organ->surface.rest_m)
        place(x);
    const tissue::FootprintOptions options{.order = 1, .tip_radius_max_m = organ_tests::kRadius_m};
    tissue::make_footprints(organ->mesh, organ->anchored, options, organ->surface);
    tissue::make_mesh_terms(organ->mesh, kPoisson, organ->anchored, options, organ->surface);
    return organ;
}

sim::Body body_of(std::shared_ptr<const tissue::BakedOrgan> organ, double step_s = 0.02) {
    constexpr double r = organ_tests::kRadius_m;
    return sim::make_body(std::move(organ), material(), {r, r, r}, step_s, tissue::Tier::corotated);
}

// E I of y y, y z, z z.
dmat2 section() {
    const double area = kWidth_m * kHeight_m, h2 = kHeight_m * kHeight_m / 12.0;
    const double yz = kSlant * h2;
    return kYoung_pa * area * dmat2{{kWidth_m * kWidth_m / 12.0 + kSlant * yz, yz}, {yz, h2}};
}

// Motion per force at (kLoaded_m, offset): bending, shear and stretch; no torsion.
dmat3 beam_mpn(const dvec2& offset_m) {
    const double a = kLoaded_m, area = kWidth_m * kHeight_m;
    const dmat2 soft = glm::inverse(section());
    // curvature k at a distance t from the load moves it by (-k . offset, k t)
    const double tt = a * a * a / 3.0, t = a * a / 2.0;
    const dvec2 to = soft * offset_m;
    dmat3 w{0.0};
    w[0][0] = a * glm::dot(offset_m, to) + a / (kYoung_pa * area);
    for (int i = 0; i < 2; ++i) {
        w[0][i + 1] = w[i + 1][0] = -t * to[i];
        for (int j = 0; j < 2; ++j)
            w[i + 1][j + 1] = tt * soft[i][j];
        const double shear_pa = kYoung_pa / (2.0 * (1.0 + kPoisson));
        w[i + 1][i + 1] += a / (5.0 / 6.0 * shear_pa * area);
    }
    return w;
}

// The top where the section's middle lies below: nothing twists it there from above.
haptics::SurfacePoint over_middle(const sim::Body& body, const dmat3& turn = dmat3{1.0}) {
    return sim::nearest_on(body, turn * dvec3{kLoaded_m, 0.0, 0.5 * kHeight_m}).at;
}

double mixed(const sim::Body& body, const haptics::SurfacePoint& at,
             const std::vector<double>& term) {
    const tissue::Triangle& t = body.organ->surface.triangles[at.triangle];
    return at.weight.x * term[t[0]] + at.weight.y * term[t[1]] + at.weight.z * term[t[2]];
}

// What the mesh has and what it owes.
dmat3 yields_mpn(const sim::Body& body, const haptics::SurfacePoint& at, bool leans) {
    const tissue::ContactSurface& skin = body.organ->surface;
    const double n = mixed(body, at, skin.mesh_term_n_m) / kYoung_pa;
    const double t = mixed(body, at, skin.mesh_term_t_m) / kYoung_pa;
    const dvec3 up = sim::normal_on(body, at);
    const dmat3 plain = dmat3{t} + (n - t) * glm::outerProduct(up, up);
    return sim::RestFeel(body).mesh_compliance(at) + plain +
           (leans ? sim::lean_on(body, at) : dmat3{0.0});
}

// A tool that sticks, beside a rig that steps until nothing moves.
struct Held {
    sim::TissueRig rig;
    std::unique_ptr<sim::TissueAnswer> answer = std::make_unique<sim::TissueAnswer>();
    sim::ToolsNow tools;

    explicit Held(sim::Body body) {
        body.material.friction = 1e3;
        std::vector<sim::Body> bodies;
        bodies.push_back(std::move(body));
        sim::TissueConfig config;
        config.step_s = 0.02;
        rig = sim::make_tissue_rig(std::move(bodies), config);
        rig.device_npm.fill(1e12);
        tools.tip.fill({.centre_m = {0, 0, 10}, .radius_m = organ_tests::kRadius_m});
    }
    dvec3 step(const dvec3& centre_m, int times) {
        tools.tip[0].centre_m = centre_m;
        for (int i = 0; i < times; ++i) {
            tools.tick += 20;
            tissue_step(rig, tools, *answer);
        }
        return rig.contact[0].force_n;
    }
};

} // namespace

TEST_CASE("mesh lean: a slanting beam yields as beam theory says, in every direction") {
    const sim::Body body = body_of(beam());
    const haptics::SurfacePoint at = over_middle(body);
    const dmat3 whole = yields_mpn(body, at, true), plain = yields_mpn(body, at, false);
    const dmat3 theory = beam_mpn({0.0, 0.5 * kHeight_m});
    double worst = 0.0, worst_plain = 0.0;
    for (const dvec3& d : {dvec3{0, 1, 0}, dvec3{0, 0, 1}, dvec3{0, .6, .8}, dvec3{0, -.6, .8},
                           dvec3{0, .8, -.6}, dvec3{.8, 0, .6}, dvec3{-.8, 0, .6}}) {
        const double wanted = glm::dot(d, theory * d);
        worst = std::max(worst, std::abs(glm::dot(d, whole * d) / wanted - 1.0));
        worst_plain = std::max(worst_plain, std::abs(glm::dot(d, plain * d) / wanted - 1.0));
    }
    MESSAGE("worst direction ", 100.0 * worst, " %, without what leans ", 100.0 * worst_plain);
    CHECK(worst < 0.08);
    CHECK(worst_plain > 0.2);
}

TEST_CASE("mesh lean: it turns with the body") {
    const double c = std::cos(1.1), s = std::sin(1.1);
    const dmat3 turn =
        dmat3{{1, 0, 0}, {0, c, s}, {0, -s, c}} * dmat3{{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
    const sim::Body body = body_of(beam()), turned = body_of(beam(turn));
    const haptics::SurfacePoint at = over_middle(body);
    const dmat3 lean = sim::lean_on(body, at);
    const double size = glm::length(lean[1]);
    REQUIRE(size > 0.1);

    // baked where it lies, where the kernel is sampled elsewhere, and carried there
    const dmat3 there = turn * lean * glm::transpose(turn);
    const dmat3 baked = sim::lean_on(turned, over_middle(turned, turn));
    sim::Body carried = body_of(beam());
    for (dvec3& x : carried.skin_m)
        x = turn * x + dvec3{0.1, 0.2, 0.3};
    const dmat3 moved = sim::lean_on(carried, at);
    for (int k = 0; k < 3; ++k) {
        CHECK(glm::distance(baked[k], there[k]) < 1e-3 * size);
        CHECK(glm::distance(moved[k], there[k]) < 1e-9 * size);
    }
}

TEST_CASE(
    "mesh lean: a tip that sticks presses as hard as beam, skin and law yield, in both loops") {
    Held held(body_of(beam()));
    const sim::Body& body = held.rig.bodies[0];
    const haptics::SurfacePoint at = over_middle(body);
    const dvec3 top = sim::place_on(body, at), up = sim::normal_on(body, at);
    const dvec3 touch = top + organ_tests::kRadius_m * up;
    constexpr double kDepth_m = 0.4e-3;
    held.step(touch + 0.1e-3 * up, 1);
    for (int i = 0; i <= 20; ++i)
        held.step(touch - kDepth_m * i / 20.0 * up, 1);
    const dvec3 force_n = held.step(touch - kDepth_m * up, 400);
    const dvec3 again_n = held.step(touch - kDepth_m * up, 1);
    REQUIRE(glm::distance(force_n, again_n) < 1e-4 * glm::length(force_n));

    // where the tip has gone: beam, skin, law along the normal; across it has not gone
    const haptics::SurfacePoint& there = held.rig.contact[0].at;
    const haptics::LocalLaw law = sim::law_on(body, there, 0, 0.0);
    const dmat3 own = sim::RestFeel(body).mesh_compliance(there);
    const auto gone_m = [&](const dmat3& lean) {
        return (own + lean) * force_n + up * haptics::law_at(law, held.rig.memory[0].x).depth_m +
               haptics::tangential_compliance(law, held.rig.memory[0].x) *
                   (force_n - up * glm::dot(up, force_n));
    };
    const dmat3 lean = sim::lean_on(body, there);
    MESSAGE("force ", 1e3 * force_n.x, " ", 1e3 * force_n.y, " ", 1e3 * force_n.z, " mN; gone ",
            1e3 * gone_m(lean).x, " ", 1e3 * gone_m(lean).y, " ", 1e3 * gone_m(lean).z,
            " mm; without what leans ", 1e3 * gone_m(dmat3{0.0}).y, " ",
            1e3 * gone_m(dmat3{0.0}).z);
    CHECK(glm::distance(gone_m(lean), kDepth_m * up) < 0.05 * kDepth_m);
    CHECK(glm::distance(gone_m(dmat3{0.0}), kDepth_m * up) > 0.2 * kDepth_m);

    // the local model of that answer, one tick on, and while it lives
    haptics::CouplingState state;
    haptics::adopt(state, held.answer->local);
    haptics::RunningModel model = state.pending;
    for (int tick = 0; tick < 20; ++tick) {
        haptics::step_model(model, 1e-3, held.tools.tip);
        CHECK(glm::distance(model.force_n[0], again_n) < 0.01 * glm::length(again_n));
    }
}

TEST_CASE("mesh lean: law and lean together are never stiff, whatever a file says") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    int whole = 0, none = 0, part = 0;
    for (const double size_mpn : {1e-4, 1e-2, 1.0, 1e6, -1.0, 1e300}) {
        auto organ = beam();
        tissue::ContactSurface& skin = organ->surface;
        const std::vector<dvec3> normal = tissue::vertex_normals(skin.rest_m, skin.triangles);
        for (std::size_t v = 0; v < skin.rest_m.size(); ++v) {
            // neither along the normal nor, in the mean, across, as a bake makes it; or worse
            dmat3 m{0.0};
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j <= i; ++j)
                    m[i][j] = m[j][i] = kYoung_pa * size_mpn * unit(random);
            const dmat3 nn = glm::outerProduct(normal[v], normal[v]);
            if (size_mpn > 0.0) {
                m -= glm::dot(normal[v], m * normal[v]) * nn;
                m -= 0.5 * (m[0][0] + m[1][1] + m[2][2]) * (dmat3{1.0} - nn);
            }
            skin.mesh_lean_m[v] = {m[0][0], m[1][1], m[2][2], m[1][2], m[0][2], m[0][1]};
        }
        const sim::Body body = body_of(organ);
        for (std::size_t t = 0; t < skin.triangles.size(); ++t) {
            const haptics::SurfacePoint at{static_cast<int>(t), {1.0, 0.0, 0.0}};
            const std::uint32_t v = skin.triangles[t][0];
            const haptics::LocalLaw law = sim::law_on(body, at, 0, 0.0);
            constexpr double kMost_x = 8.0; // the table's end
            const haptics::LawPoint end = haptics::law_at(law, kMost_x);
            const double n = end.ddepth_dx / end.dforce_dx,
                         c = haptics::tangential_compliance(law, kMost_x);
            const dmat3 lean = sim::lean_on(body, at);
            const dmat3 nn = glm::outerProduct(normal[v], normal[v]);
            const dmat3 sum = c * dmat3{1.0} + (n - c) * nn + lean;
            for (int i = 0; i < 20; ++i) {
                const dvec3 d =
                    glm::normalize(dvec3{unit(random), unit(random), unit(random)} + dvec3{1e-9});
                CHECK(glm::dot(d, sum * d) >= std::min({n, c, 5e-3}) * (1.0 - 1e-9));
            }
            const double share = glm::length(lean[0]) * kYoung_pa /
                                 glm::length(dvec3{skin.mesh_lean_m[v][0], skin.mesh_lean_m[v][5],
                                                   skin.mesh_lean_m[v][4]});
            ++(share > 1.0 - 1e-9 ? whole : share > 0.0 ? part : none);
        }
    }
    MESSAGE(whole, " whole, ", part, " in part, ", none, " not at all");
    CHECK(whole > 0);
    CHECK(part > 0);
}
