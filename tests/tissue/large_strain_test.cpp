// tests/tissue/large_strain_test.cpp
// Nearly incompressible neo-Hooke far from rest against closed forms of the incompressible one:
// homogeneous states and the twisted rod, in the reference and in the real-time quadratic solver.
#include "tests/tissue/cylinders.h"
#include "tests/tissue/driven_bodies.h"

#include <doctest/doctest.h>

using glm::dmat3;
using glm::dvec3;
using tissue::kHeldX;
using tissue::kHeldY;
using tissue::kHeldZ;

namespace {

constexpr double kSide_m = 0.02, kYoung_pa = 9e3;

// So light that a step of a second is statics.
tissue::Material light(double poisson) {
    return bodies::elastic(kYoung_pa, poisson, 1e-6);
}
double mu_pa(double poisson) {
    return kYoung_pa / (2 + 2 * poisson);
}

// Faces of a cube at the origin whose nodes reach `side` along an axis.
bool far_face(const dvec3& x, int axis) {
    return x[axis] > kSide_m - 1e-9;
}

// Cauchy stress along the first axis where `led` axes have `stretch` and the others none to bear:
//   sigma_i = mu J^-5/3 (s_i^2 - sum s^2/3) + K (J - 1) = 0 by bisection
struct Free {
    double stress_pa, wide, side; // stretches of the second and third axis
};
Free free_sides(double poisson, double stretch, int led) {
    const double mu = mu_pa(poisson), bulk = kYoung_pa / (3 - 6 * poisson);
    const auto stress = [&](int axis, double side) {
        const dvec3 s{stretch, led > 1 ? stretch : side, side};
        const double J = s.x * s.y * s.z;
        return mu * std::pow(J, -5.0 / 3) * (s[axis] * s[axis] - glm::dot(s, s) / 3) +
               bulk * (J - 1);
    };
    double low = 0.05, high = 5.0;
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (stress(2, middle) < 0 ? low : high) = middle;
    }
    return {stress(0, low), led > 1 ? stretch : low, low};
}

} // namespace

TEST_CASE("a cube with free sides is stretched and pressed as rubber is") {
    const auto mesh = reference_bodies::irregular_box(dvec3(kSide_m), 2, 4);
    for (const double poisson : {0.45, 0.49, 0.4999}) {
        for (const int led : {1, 2}) { // axes: uniaxial, equibiaxial
            const auto held = reference_bodies::flags(mesh, [&](const dvec3& x) {
                int flag = 0;
                for (int k = 0; k < 3; ++k)
                    flag |= x[k] < 1e-9 || (k < led && far_face(x, k)) ? kHeldX << k : 0;
                return flag;
            });
            for (const double stretch : {0.6, 0.9, 1.1, 1.5, 2.0}) {
                driven::Reference body(mesh, light(poisson), held, 1.0);
                for (const double part : {0.25, 0.5, 0.75, 1.0}) {
                    const double now = 1 + part * (stretch - 1);
                    REQUIRE(body.step(
                        [&](const dvec3& x) { return dvec3(now, led > 1 ? now : 1, 1) * x; }));
                }
                const double pull_n =
                    driven::force_where_n(body, [](const dvec3& x) { return far_face(x, 0); }).x;
                const Free expected = free_sides(poisson, stretch, led);
                const double area_m2 = kSide_m * kSide_m * expected.side * expected.wide;
                CAPTURE(poisson);
                CAPTURE(stretch);
                CHECK(pull_n / area_m2 ==
                      doctest::Approx(expected.stress_pa).epsilon(1e-6).scale(0.0));
                // what rubber would do, to the share of its volume that it keeps
                const double thin = led > 1 ? std::pow(stretch, -4) : 1 / stretch;
                if (poisson > 0.4995) {
                    CHECK(pull_n / area_m2 ==
                          doctest::Approx(mu_pa(poisson) * (stretch * stretch - thin))
                              .epsilon(1e-2)
                              .scale(0.0));
                }
            }
        }
    }
}

TEST_CASE_TEMPLATE("differences of stress in a cube of given stretches are those of rubber", Body,
                   driven::Reference, driven::Quadratic) {
    // all of the surface led, volume kept: what pressure there is does not count
    const auto mesh = reference_bodies::irregular_box(dvec3(kSide_m), 2, 4);
    const auto held = reference_bodies::flags(mesh, [](const dvec3& x) {
        return reference_bodies::on_box(x, dvec3(kSide_m)) ? tissue::kHeld : 0;
    });
    for (const double poisson : {0.49, 0.499}) {
        const auto piola_pa = [&](const dmat3& F) {
            Body body(mesh, light(poisson), held, 1.0);
            for (int i = 1; i <= 8; ++i) {
                const dmat3 now = dmat3(1.0) + i / 8.0 * (F - dmat3(1.0));
                REQUIRE(body.step([&](const dvec3& x) { return now * x; }));
            }
            // Cauchy stress: P F^T, det F = 1
            dmat3 P;
            for (int k = 0; k < 3; ++k) {
                P[k] = driven::force_where_n(body, [k](const dvec3& x) { return far_face(x, k); }) /
                       (kSide_m * kSide_m);
            }
            return P;
        };
        const double mu = mu_pa(poisson);
        for (const double stretch : {0.7, 1.2, 1.6}) {
            // force on far edges belongs to two faces: use what they do not share
            const double side = 1 / std::sqrt(stretch);
            const dmat3 F{stretch, 0, 0, 0, side, 0, 0, 0, side};
            const dmat3 P = piola_pa(F);
            const double found = P[0][0] * stretch - P[1][1] * side;
            CHECK(found ==
                  doctest::Approx(mu * (stretch * stretch - 1 / stretch)).epsilon(1e-4).scale(0.0));
        }
        for (const double shear : {0.3, 1.0}) {
            dmat3 F(1.0);
            F[2][0] = shear;
            CHECK(piola_pa(F)[2][0] == doctest::Approx(mu * shear).epsilon(1e-4).scale(0.0));
        }
    }
}

TEST_CASE_TEMPLATE("a rod twisted far has Saint-Venant's torque and wants to grow longer", Body,
                   driven::Reference, driven::Quadratic) {
    // incompressible neo-Hooke: T = mu pi r^4/2 (theta/L), N = -pi/4 mu r^4 (theta/L)^2 (Rivlin
    // 1949), plane ends, free side. Straight edges, because only they have the linear part of the
    // field exactly, and K makes a pressure of what is missing; twelve corners out so far that
    // their polar moment is the rod's. K = 500 mu, and held ends, cost 2 % of N.
    constexpr double kRadius_m = 0.01, kLength_m = 0.01, kPoisson = 0.499;
    constexpr int kCorners = 12, kLayers = 16;
    const double angle = 2 * std::numbers::pi / kCorners;
    const double out =
        std::pow(6 * std::numbers::pi / (kCorners * std::sin(angle) * (2 + std::cos(angle))), 0.25);
    cylinders::Rings rings{.segments = kCorners, .arc_rad = 2 * std::numbers::pi, .round = false};
    for (const double share : {0.02, 0.4, 0.75, 1.0})
        rings.radius_m.push_back(share * out * kRadius_m);
    for (int i = 0; i <= kLayers; ++i)
        rings.z_m.push_back(kLength_m * i / kLayers);
    const auto mesh = cylinders::mesh(rings);
    const auto top = [](const dvec3& x) { return x.z > kLength_m - 1e-9; };
    const auto held = reference_bodies::flags(mesh, [&](const dvec3& x) {
        const bool axis = cylinders::radius_m(x) < 0.03 * kRadius_m;
        return axis || x.z < 1e-9 || top(x) ? tissue::kHeld : 0;
    });
    Body body(mesh, light(kPoisson), held, 1.0);
    for (const double rate : {25.0, 50.0}) { // 0.25 and 0.5 at the rim
        const auto turned = [&](const dvec3& x) {
            return bodies::rotation({0, 0, 1}, rate * x.z) * x;
        };
        driven::carry(body, turned);
        for (dvec3& v : body.state.velocity_mps)
            v = dvec3(0.0);
        REQUIRE(body.step(turned));
        const auto f = body.forces_n();
        double torque_nm = 0.0, axial_n = 0.0;
        for (std::size_t k = 0; k < f.size(); ++k) {
            if (!top(mesh.rest_m[k]))
                continue;
            torque_nm += glm::cross(body.state.position_m[k], f[k]).z;
            axial_n += f[k].z;
        }
        const double stiff_nm2 = mu_pa(kPoisson) * std::numbers::pi / 2 * std::pow(kRadius_m, 4);
        CHECK(torque_nm == doctest::Approx(stiff_nm2 * rate).epsilon(5e-3).scale(0.0));
        CHECK(axial_n == doctest::Approx(-stiff_nm2 / 2 * rate * rate).epsilon(3e-2).scale(0.0));
    }
}
