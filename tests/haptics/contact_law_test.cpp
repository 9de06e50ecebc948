#include "haptics/contact/contact_law.h"

#include "tests/haptics/sneddon_table.h"

#include <algorithm>
#include <doctest/doctest.h>

namespace {

using haptics::law_at;
using haptics::LawPoint;
using haptics::LocalLaw;

const SneddonSphere kSphere;

const haptics::IndenterTable& table() {
    static const haptics::IndenterTable t = sneddon_table(kSphere);
    return t;
}

double last_x() {
    return (haptics::IndenterTable::kEntries - 1) * table().x_step;
}

} // namespace

TEST_CASE("contact law: force and depth are Sneddon's sphere at any depth") {
    const LocalLaw law{.table = &table()};
    for (const double s : {0.05, 0.2, 0.7, 1.5, 2.7}) {
        const double force = kSphere.force_n(s);
        const LawPoint p = law_at(law, std::cbrt(force / table().force_scale_n));
        CHECK(p.force_n == doctest::Approx(force).scale(0.0).epsilon(1e-12));
        // piecewise linear in a smooth curve of 128 pieces per unit
        CHECK(p.depth_m == doctest::Approx(kSphere.depth_m(s)).scale(0.0).epsilon(2e-4));
    }
}

TEST_CASE("contact law: slopes are the derivatives of force and depth") {
    const LocalLaw soft{.table = &table(), .normal_mpn = 2e-3, .floor_mpn = 1e-3};
    const LocalLaw negative{.table = &table(), .normal_mpn = -1.0, .floor_mpn = 1e-3};
    for (const LocalLaw& law : {soft, negative})
        for (const double x : {0.3 * table().x_step, 10.4 * table().x_step, 1.01 * last_x()}) {
            const double h = 1e-6 * x;
            const LawPoint p = law_at(law, x);
            const LawPoint low = law_at(law, x - h);
            const LawPoint high = law_at(law, x + h);
            CHECK(p.dforce_dx ==
                  doctest::Approx((high.force_n - low.force_n) / (2 * h)).scale(0.0).epsilon(1e-7));
            CHECK(p.ddepth_dx ==
                  doctest::Approx((high.depth_m - low.depth_m) / (2 * h)).scale(0.0).epsilon(1e-6));
        }
}

TEST_CASE("contact law: the slope of depth over force never falls below the floor") {
    // A chord of g may miss the slope of D by the share x_step / (3 x) of it: g grows like x^2
    // where D is linear in force, and a chord's slope stands for its middle.
    const LocalLaw law{.table = &table(), .normal_mpn = -1.0, .floor_mpn = 1.25e-3};
    for (double x = 0.5 * table().x_step; x < 3.0 * last_x(); x += 0.37 * table().x_step) {
        const LawPoint p = law_at(law, x);
        const double slope_mpn = p.ddepth_dx / p.dforce_dx;
        const double punch_mpn = 1.0 / (2.0 * kSphere.plane_modulus_pa * kSphere.radius_m);
        CHECK(slope_mpn >= law.floor_mpn - punch_mpn * table().x_step / (3.0 * x));
    }
}

TEST_CASE("contact law: depth and slope go on smoothly beyond the table") {
    const LocalLaw law{.table = &table()};
    const LawPoint in = law_at(law, last_x() * (1.0 - 1e-9));
    const LawPoint out = law_at(law, last_x() * (1.0 + 1e-9));
    CHECK(out.depth_m == doctest::Approx(in.depth_m).scale(0.0).epsilon(1e-8));
    CHECK(out.ddepth_dx == doctest::Approx(in.ddepth_dx).scale(0.0).epsilon(1e-6));
    // a sphere far in is a punch of its own radius: dP = 2 E* a dd
    const double stiffness = 2.0 * kSphere.plane_modulus_pa * kSphere.radius_m;
    CHECK(out.dforce_dx / out.ddepth_dx == doctest::Approx(stiffness).scale(0.0).epsilon(0.02));
}

TEST_CASE("contact law: tissue that stiffens below the floor goes on along it, without a kink") {
    // a table whose slope falls to two thirds of a punch, and so below a floor that the punch meets
    haptics::IndenterTable stiffening_table = table();
    for (double& punch : stiffening_table.punch_mpn)
        punch *= 1.5;
    const LocalLaw law{.table = &stiffening_table, .normal_mpn = -1.0, .floor_mpn = 1.25e-3};
    const auto slope_mpn = [&](double x) {
        const LawPoint p = law_at(law, x);
        return p.ddepth_dx / p.dforce_dx;
    };
    const double step = 0.01 * table().x_step;
    LawPoint last = law_at(law, table().x_step);
    for (double x = table().x_step + step; x < 1.5 * last_x(); x += step) {
        const LawPoint p = law_at(law, x);
        CHECK(p.depth_m - last.depth_m >= 0.98 * law.floor_mpn * (p.force_n - last.force_n));
        // no jump: the depth won is what the slope says
        CHECK(p.depth_m - last.depth_m <= 1.05 * p.ddepth_dx * step + 1e-12);
        last = p;
    }
    CHECK(slope_mpn(last_x()) == doctest::Approx(law.floor_mpn).scale(0.0).epsilon(1e-9));
    // and where the punch is as soft as that it is left alone
    const LocalLaw plain{.table = &stiffening_table, .normal_mpn = 1.0, .floor_mpn = 1.25e-3};
    const double x = 0.9 * last_x();
    CHECK(law_at(plain, x).depth_m - 1.0 * law_at(plain, x).force_n ==
          doctest::Approx(law_at({.table = &table()}, x).depth_m).scale(0.0).epsilon(1e-6));
}

TEST_CASE("contact law: levels are met exactly and mixed linearly in depth between") {
    const double x = 20.0 * table().x_step;
    const double thick_m = law_at({.table = &table()}, x).depth_m;
    const auto depth_m = [&](double ratio) {
        return law_at({.table = &table(), .radius_over_thickness = ratio}, x).depth_m;
    };
    for (const double level : {1.0, 4.0, 9.0})
        CHECK(depth_m(level) ==
              doctest::Approx(thick_m / stiffening(level)).scale(0.0).epsilon(1e-12));
    CHECK(depth_m(4.25) == doctest::Approx(0.75 * depth_m(4.0) + 0.25 * depth_m(5.0)).scale(0.0));
    CHECK(depth_m(50.0) == depth_m(9.0));
}

TEST_CASE("contact law: a rigid body yields by the coupling alone") {
    const LocalLaw law{.normal_mpn = 1e-4, .tangential_mpn = -1.0, .floor_mpn = 1.25e-3};
    CHECK(law_at(law, 0.8).force_n == 0.8);
    CHECK(law_at(law, 0.8).depth_m == doctest::Approx(1e-3).scale(0.0));
    CHECK(haptics::tangential_compliance(law, 0.8) == 1.25e-3);
}

TEST_CASE("contact law: tangential compliance falls with the contact radius to the floor") {
    const LocalLaw law{.table = &table(), .floor_mpn = 1e-3};
    const double s = 0.9;
    const double x = std::cbrt(kSphere.force_n(s) / table().force_scale_n);
    const double radius_m = kSphere.radius_m * std::tanh(s);
    CHECK(haptics::tangential_compliance(law, x) ==
          doctest::Approx(table().tangential_m2pn / radius_m).scale(0.0).epsilon(1e-4));
    CHECK(std::isfinite(haptics::tangential_compliance(law, 0.0)));
    const LocalLaw floored{.table = &table(), .tangential_mpn = -10.0, .floor_mpn = 1e-3};
    CHECK(haptics::tangential_compliance(floored, x) == 1e-3);
}
