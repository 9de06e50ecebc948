// tests/tissue/measures_test.cpp
// Energy, volume, stress and damage of a body in known states, corotated and quadratic.
#include "tissue/solver/measures.h"

#include "tests/tissue/allocations.h"
#include "tests/tissue/driven_bodies.h"

#include <doctest/doctest.h>

using glm::dmat3;
using glm::dvec3;

namespace {

constexpr double kYoung_pa = 8e3, kPoisson = 0.4;
const dvec3 kSize_m{0.04, 0.03, 0.03};
const double kMu_pa = kYoung_pa / (2 + 2 * kPoisson);
const double kBulk_pa = kYoung_pa / (3 - 6 * kPoisson), kLambda_pa = kBulk_pa - 2.0 / 3 * kMu_pa;
const double kVolume_m3 = kSize_m.x * kSize_m.y * kSize_m.z;

struct Expected {
    double density_jpm3, von_mises_pa;
};
double von_mises(const dvec3& s) {
    const dvec3 d = s - dvec3{s.y, s.z, s.x};
    return std::sqrt(0.5 * glm::dot(d, d));
}

// The tiers: a body of a mesh, and what its law makes of principal stretches.
struct Corotated {
    tissue::CorotatedModel model;
    tissue::CorotatedState state;
    explicit Corotated(const tissue::TetMesh& mesh, const tissue::Material& m)
        : model(make_corotated(mesh, m, {})), state(rest_state(model)) {}
    static Expected law(const dvec3& s) {
        const dvec3 e = s - dvec3(1.0);
        const double sum = e.x + e.y + e.z;
        return {kMu_pa * glm::dot(e, e) + 0.5 * kLambda_pa * sum * sum, 2 * kMu_pa * von_mises(s)};
    }
};
struct Quadratic {
    tissue::QuadraticModel model;
    tissue::QuadraticState state;
    explicit Quadratic(const tissue::TetMesh& mesh, const tissue::Material& m)
        : model(make_quadratic(tissue::quadratic_mesh(mesh), m, {})), state(rest_state(model)) {}
    static Expected law(const dvec3& s) {
        const double J = s.x * s.y * s.z;
        return {0.5 * kMu_pa * (glm::dot(s, s) / std::cbrt(J * J) - 3) +
                    0.5 * kBulk_pa * (J - 1) * (J - 1),
                kMu_pa * std::pow(J, -5.0 / 3) * von_mises(s * s)};
    }
};

tissue::TetMesh box(const std::array<int, 3>& cells = {3, 2, 2}, double shake = 0.2) {
    return tissue::box_mesh(kSize_m, cells, shake, 5);
}

template <typename Body, typename Place> void put(Body& body, Place place) {
    for (std::size_t i = 0; i < body.state.position_m.size(); ++i)
        body.state.position_m[i] = place(body.model.mesh.rest_m[i]);
}

dmat3 random_rotation(std::mt19937_64& random) {
    return bodies::rotation(bodies::signed_vector(random), 3 * bodies::signed_unit(random));
}
dmat3 diagonal(const dvec3& s) {
    return {{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}};
}

const tissue::DamageLimits kNever{1e12, 20.0, 1e20};

} // namespace

TEST_CASE_TEMPLATE("a body moved and turned as one measures nothing", Body, Corotated, Quadratic) {
    Body body(box(), bodies::elastic(kYoung_pa, kPoisson));
    auto log = make_tissue_log(body.model);
    const dmat3 R = bodies::rotation({1, 2, -1}, 2.0);
    put(body, [&](const dvec3& x) { return R * x + dvec3(0.2, 0, 1); });
    const std::size_t before = bodies::allocations();
    const auto m = measure(body.model, body.state, {}, 0.01, log);
    CHECK(bodies::allocations() == before);
    CHECK(m.stored_j < 1e-12 * kYoung_pa * kVolume_m3);
    CHECK(m.volume_m3 == doctest::Approx(kVolume_m3).epsilon(1e-12).scale(0.0));
    CHECK(std::abs(m.volume_change) < 1e-6); // the shares add rest volumes in single precision
    CHECK(m.peak_von_mises_pa < 1e-6 * kYoung_pa);
    CHECK(m.over_share == 0.0);
    CHECK(m.hurt_share == 0.0);
    CHECK(m.inverted == 0);
}

TEST_CASE_TEMPLATE("stretched any way a body stores and bears what its law says", Body, Corotated,
                   Quadratic) {
    std::mt19937_64 random(5);
    Body body(box(), bodies::elastic(kYoung_pa, kPoisson));
    auto log = make_tissue_log(body.model);
    for (const dvec3& s : {dvec3{1.3, 0.9, 0.9}, dvec3{0.7, 1.0, 1.2}, dvec3(1.1), dvec3(0.8),
                           dvec3{1.001, 1.0, 0.999}}) {
        const dmat3 F = random_rotation(random) * diagonal(s) * random_rotation(random);
        put(body, [&](const dvec3& x) { return F * x; });
        const auto m = measure(body.model, body.state, kNever, 0.01, log);
        const Expected expected = Body::law(s);
        const double J = s.x * s.y * s.z;
        CHECK(m.stored_j ==
              doctest::Approx(expected.density_jpm3 * kVolume_m3).epsilon(1e-8).scale(0.0));
        CHECK(m.volume_m3 == doctest::Approx(J * kVolume_m3).epsilon(1e-12).scale(0.0));
        CHECK(std::abs(m.volume_change - (J - 1)) < 1e-6);
        const double least = 1e-6 * kYoung_pa; // equal stretches: none
        CHECK(std::abs(m.peak_von_mises_pa - expected.von_mises_pa) <
              least + 1e-6 * expected.von_mises_pa);
        CHECK(std::abs(m.high_von_mises_pa - expected.von_mises_pa) <
              least + 1e-6 * expected.von_mises_pa);
    }
}

TEST_CASE_TEMPLATE("tissue is over the limit of strain if a principal stretch is", Body, Corotated,
                   Quadratic) {
    std::mt19937_64 random(9);
    Body body(box({1, 1, 1}, 0.0), bodies::elastic(kYoung_pa, kPoisson));
    auto log = make_tissue_log(body.model);
    const tissue::DamageLimits limits{1e12, 0.38, 1e20};
    int over = 0;
    for (int i = 0; i < 300; ++i) {
        const dvec3 strain = 0.5 * bodies::signed_vector(random);
        const dmat3 F =
            random_rotation(random) * diagonal(glm::exp(strain)) * random_rotation(random);
        put(body, [&](const dvec3& x) { return F * x; });
        const double worst = std::max({std::abs(strain.x), std::abs(strain.y), std::abs(strain.z)});
        if (std::abs(worst - 0.38) < 1e-6)
            continue;
        over += worst > 0.38;
        CHECK(measure(body.model, body.state, limits, 0.0, log).over_share ==
              (worst > 0.38 ? 1.0 : 0.0));
    }
    CHECK(over > 50);
    CHECK(over < 250);
}

TEST_CASE_TEMPLATE("peaks are of the worst, the percentile and the shares of the volume", Body,
                   Corotated, Quadratic) {
    // 200 layers, the last `hard` of them stretched along z
    Body body(tissue::box_mesh(kSize_m, {1, 1, 200}), bodies::elastic(kYoung_pa, kPoisson));
    auto log = make_tissue_log(body.model);
    const Expected expected = Body::law({1.0, 1.0, 1.6});
    for (const int hard : {1, 3, 50}) {
        const double from = kSize_m.z * (1 - hard / 200.0);
        put(body,
            [&](const dvec3& x) { return dvec3(x.x, x.y, x.z + 0.6 * std::max(0.0, x.z - from)); });
        auto m = measure(body.model, body.state, {1e12, 0.38, 1e20}, 0.0, log);
        CHECK(m.peak_von_mises_pa ==
              doctest::Approx(expected.von_mises_pa).epsilon(1e-6).scale(0.0));
        CHECK(m.high_von_mises_pa ==
              doctest::Approx(hard > 2 ? expected.von_mises_pa : 0.0).epsilon(1e-6));
        CHECK(m.over_share == doctest::Approx(hard / 200.0).epsilon(1e-5).scale(0.0));
        CHECK(m.hurt_share == doctest::Approx(hard / 200.0).epsilon(1e-5).scale(0.0));
        m = measure(body.model, body.state, {0.99 * expected.von_mises_pa, 20.0, 1e20}, 0.0, log);
        CHECK(m.over_share == doctest::Approx(hard / 200.0).epsilon(1e-5).scale(0.0));
        m = measure(body.model, body.state, {1.01 * expected.von_mises_pa, 20.0, 1e20}, 0.0, log);
        CHECK(m.over_share == 0.0);
    }
    // what was hurt stays hurt
    put(body, [](const dvec3& x) { return x; });
    const auto after = measure(body.model, body.state, kNever, 0.0, log);
    CHECK(after.over_share == 0.0);
    CHECK(after.hurt_share == doctest::Approx(0.25).epsilon(1e-5).scale(0.0));
}

TEST_CASE_TEMPLATE("stress that is borne too long hurts, in steps of any size", Body, Corotated,
                   Quadratic) {
    Body body(box({1, 1, 1}, 0.0), bodies::elastic(kYoung_pa, kPoisson));
    put(body, [](const dvec3& x) { return diagonal({1.2, 1.0, 1.0}) * x; });
    const double stress = Body::law({1.2, 1.0, 1.0}).von_mises_pa;
    const tissue::DamageLimits limits{1e12, 20.0, 2.0 * stress}; // two seconds
    for (const double dt : {0.01, 0.02, 0.3}) {
        auto log = make_tissue_log(body.model);
        for (double t = dt; t < 2.5; t += dt) {
            const double share = measure(body.model, body.state, limits, dt, log).hurt_share;
            if (std::abs(t - 2.0) > 1e-3)
                CHECK(share == (t > 2.0 ? 1.0 : 0.0));
        }
    }
}

TEST_CASE("with a memory stress relaxes and energy is what the reference could have back") {
    auto material = bodies::elastic(kYoung_pa, kPoisson, 1e-12);
    material.prony = {{0.3, 0.5}, {0.2, 8.0}};
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh(kSize_m, {2, 1, 1}, 0.0));
    const auto held = reference_bodies::flags(mesh, [](const dvec3& x) {
        return reference_bodies::on_box(x, kSize_m) ? tissue::kHeld : 0;
    });
    const double shear = 0.3, dt = 0.2;
    const auto place = [&](const dvec3& x) { return x + dvec3(shear * x.z, 0, 0); };
    driven::Reference reference(mesh, material, held, dt);
    driven::Quadratic body(mesh, material, held, dt);
    auto log = make_tissue_log(body.model);
    reference.set_dt(1e-7);
    body.set_dt(1e-7);
    double t = 0.0;
    for (int i = 0; i < 8; ++i) {
        REQUIRE(reference.step(place));
        REQUIRE(body.step(place));
        const auto m = measure(body.model, body.state, {}, dt, log);
        double share = 1.0;
        for (const auto& [g, tau] : material.prony)
            share -= g * (1 - std::exp(-t / tau));
        // simple shear: sigma = mu (F F^T - ...), von Mises mu sqrt(3 gamma^2 + gamma^4)
        const double expected = kMu_pa * share * std::sqrt(3 * shear * shear + std::pow(shear, 4));
        CHECK(m.peak_von_mises_pa == doctest::Approx(expected).epsilon(1e-5).scale(0.0));
        CHECK(m.stored_j == doctest::Approx(stored_energy_j(reference.model, reference.state))
                                .epsilon(1e-6)
                                .scale(0.0));
        reference.set_dt(dt);
        body.set_dt(dt);
        t += dt;
    }
}

TEST_CASE_TEMPLATE("inside out is over every limit, with numbers that are finite", Body, Corotated,
                   Quadratic) {
    Body body(box({1, 1, 1}, 0.0), bodies::elastic(kYoung_pa, kPoisson));
    auto log = make_tissue_log(body.model);
    put(body, [](const dvec3& x) { return dvec3(-x.x, x.y, x.z); });
    const auto m = measure(body.model, body.state, kNever, 0.01, log);
    CHECK(m.inverted == (std::is_same_v<Body, Corotated> ? 6 : 24));
    CHECK(std::isfinite(m.stored_j));
    CHECK(m.peak_von_mises_pa == 0.0);
    CHECK(m.over_share == 1.0);
    CHECK(m.volume_m3 == doctest::Approx(-kVolume_m3).epsilon(1e-12).scale(0.0));
}
