#include "haptics/rigid/rigid_coupling.h"

#include "tests/haptics/sampled_face.h"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>

namespace {

using glm::dvec3;
using haptics::CoupledTool;
using haptics::CouplingSpring;
using haptics::RigidPose;
using haptics::ToolContact;

constexpr double kSide_m = 20e-3, kContact_npm = 5000.0;
constexpr CouplingSpring kSpring{800.0, 0.4};

// Contacts of a square face at the tool's origin with the plane z = 0.
std::vector<ToolContact> face_contacts(const RigidPose& tool) {
    haptics::ContactList contacts;
    haptics::cluster_contacts(sampled_face(2, kSide_m, -tool.position_m.z, tool.rotation), {},
                              contacts);
    std::vector<ToolContact> list;
    for (const haptics::RepresentativeContact& c : contacts)
        list.push_back({.contact = c, .second = 0});
    return list;
}

// Ticks until nothing moves.
CoupledTool settled(const RigidPose& device, const CouplingSpring& spring, int ticks = 200) {
    std::array<CoupledTool, 1> tool{{{.device = device, .tool = device, .spring = spring}}};
    for (int i = 0; i < ticks; ++i)
        REQUIRE(haptics::balance(tool, face_contacts(tool[0].tool), kContact_npm));
    return tool[0];
}

} // namespace

TEST_CASE("rigid coupling: pressed on a plane the springs are in series, in push and in tilt") {
    const double press_m = 1e-3;
    const CoupledTool flat = settled({glm::dmat3(1.0), {0, 0, -press_m}}, kSpring);
    const double series_npm =
        kSpring.stiffness_npm * kContact_npm / (kSpring.stiffness_npm + kContact_npm);
    CHECK(flat.wrench.force_n.z == doctest::Approx(series_npm * press_m).scale(0.0).epsilon(1e-9));
    CHECK(glm::length(flat.wrench.torque_nm) < 1e-12);
    const double tilt_rad = 1e-5; // further over a face pushes back more, see below
    const CoupledTool tilted = settled({turn({0, 1, 0}, tilt_rad), {0, 0, -press_m}}, kSpring);
    const double face = kContact_npm * kSide_m * kSide_m / 12.0;
    const double series = kSpring.torsion_nmprad * face / (kSpring.torsion_nmprad + face);
    CHECK(tilted.wrench.torque_nm.y ==
          doctest::Approx(-series * tilt_rad).scale(0.0).epsilon(1e-6));
}

TEST_CASE("rigid coupling: a face that leans far lies where the law's own integrals balance") {
    // theta is the tool's, d the depth of the face's middle, m = side^2/12: depth is linear, so
    //   D = d + sin^2(theta) m/d, and k D acts at P = sin(theta) cos(theta) m/d
    // as long as all of the face is in contact. Balance, relaxed to rounding:
    const double press_m = 1e-3, m = kSide_m * kSide_m / 12.0, face = kContact_npm * m;
    for (const double tilt_rad : {2e-3, 5e-3, 1e-2}) {
        double d_m = press_m, theta = 0.0, force_n = 0.0, torque_nm = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const double s = std::sin(theta), c = std::cos(theta);
            force_n = kContact_npm * (d_m + s * s * m / d_m);
            torque_nm = force_n * s * c * m / d_m;
            d_m += 0.1 * (kSpring.stiffness_npm * (press_m - d_m) - force_n) /
                   (kSpring.stiffness_npm + kContact_npm);
            theta += 0.1 * (kSpring.torsion_nmprad * (tilt_rad - theta) - torque_nm) /
                     (kSpring.torsion_nmprad + face);
        }
        REQUIRE(d_m > 0.5 * kSide_m * std::sin(theta));
        const CoupledTool at = settled({turn({0, 1, 0}, tilt_rad), {0, 0, -press_m}}, kSpring);
        CHECK(at.wrench.force_n.z == doctest::Approx(force_n).scale(0.0).epsilon(1e-9));
        CHECK(at.wrench.torque_nm.y == doctest::Approx(-torque_nm).scale(0.0).epsilon(1e-9));
    }
}

TEST_CASE("rigid coupling: the stiffness it says the device feels is the one it feels") {
    const RigidPose device{turn({1, 2, 0}, 3e-3), {0, 0, -1e-3}};
    const CoupledTool at = settled(device, kSpring);
    for (int axis = 0; axis < 6; ++axis) {
        const double by = 1e-7;
        RigidPose moved = device;
        if (axis < 3)
            moved.position_m[axis] += by;
        else
            moved.rotation = turn(dvec3{axis == 3, axis == 4, axis == 5}, by) * device.rotation;
        std::array<CoupledTool, 1> tool{at};
        tool[0].device = moved; // one tick: what the sampled loop reacts by
        REQUIRE(haptics::balance(tool, face_contacts(at.tool), kContact_npm));
        for (int i = 0; i < 6; ++i) {
            const double change = i < 3 ? (tool[0].wrench.force_n - at.wrench.force_n)[i]
                                        : (tool[0].wrench.torque_nm - at.wrench.torque_nm)[i - 3];
            CHECK(-change / by == doctest::Approx(at.felt[i][axis]).epsilon(0.02).scale(0.1));
        }
    }
}

TEST_CASE("rigid coupling: the passivity bound is 2 b / T in force and in torque, by lever too") {
    const haptics::DeviceDamping device{0.5, 1e-4, 1e-3};
    const CouplingSpring spring = haptics::safe_spring(device, 1.0);
    CHECK(spring.stiffness_npm == doctest::Approx(1000.0).scale(0.0));
    CHECK(spring.torsion_nmprad == doctest::Approx(0.2).scale(0.0));
    haptics::RepresentativeContact c{.share = 1.0};
    for (const int n : {1, 2, 4, 8}) { // parallel contacts of 300 N/m: n k < 2 b / T
        haptics::Matrix6 k{};
        for (int i = 0; i < n; ++i)
            haptics::add_stiffness(k, c, 300.0, {});
        CHECK(haptics::passivity_share(k, device) ==
              doctest::Approx(n * 300.0 / 1000.0).scale(0.0));
    }
    // at arm r: the matrix has rank one, so its eigenvalue is k (1 / b + r^2 / b_rot) T / 2
    c.place_m = {0.02, 0, 0};
    haptics::Matrix6 k{};
    haptics::add_stiffness(k, c, 300.0, {});
    CHECK(haptics::passivity_share(k, device) ==
          doctest::Approx(300.0 * (1 / 0.5 + 0.02 * 0.02 / 1e-4) * 1e-3 / 2).scale(0.0));
}

TEST_CASE("rigid coupling: on a bare device stable up to 2 b / T against any contact, not beyond") {
    for (const double contact_npm : {1e3, 1e5, 1e7}) {
        for (const double spring_npm : {500.0, 900.0, 990.0, 1100.0}) {
            std::array<CoupledTool, 1> tool{{{.spring = {spring_npm, 0.1}}}};
            const ToolContact wall{.contact = {.depth_m = 0.0, .share = 1.0}, .second = 0};
            haptics::balance(tool, {&wall, 1}, contact_npm);
            const double felt_npm = tool[0].felt[2][2];
            CHECK(
                felt_npm ==
                doctest::Approx(spring_npm * contact_npm / (spring_npm + contact_npm)).scale(0.0));
            CHECK((sampled_wall_radius(0.1, 0.5, felt_npm, 1e-3) < 1.0) == (felt_npm < 1000.8));
        }
    }
}

TEST_CASE("rigid coupling: two tools push each other by the same force and torque") {
    RandomPieces random(50);
    for (int i = 0; i < 100; ++i) {
        std::array<CoupledTool, 2> tool;
        for (CoupledTool& t : tool)
            t = {.device = {random.rotation(), 0.02 * random.in_ball()}, .spring = kSpring};
        for (CoupledTool& t : tool)
            t.tool = t.device;
        const dvec3 place_m = 0.02 * random.in_ball();
        const ToolContact c{.contact = {.place_m = place_m,
                                        .normal = glm::normalize(random.in_ball()),
                                        .depth_m = 1e-3,
                                        .share = 1.0,
                                        .spread_m2 = glm::dmat3(3e-5)},
                            .first = 0,
                            .second = 1};
        REQUIRE(haptics::balance(tool, {&c, 1}, kContact_npm));
        const auto& a = tool[0].wrench;
        const auto& b = tool[1].wrench;
        CHECK(glm::length(a.force_n) > 0.0);
        CHECK(glm::length(a.force_n + b.force_n) < 1e-12);
        // about one and the same point, where the tools were when they met
        const dvec3 about_a = a.torque_nm + glm::cross(tool[0].device.position_m, a.force_n);
        const dvec3 about_b = b.torque_nm + glm::cross(tool[1].device.position_m, b.force_n);
        CHECK(glm::length(about_a + about_b) < 1e-12);
    }
}

TEST_CASE("rigid coupling: leaving a contact fast never pulls, and nothing is felt in the free") {
    std::array<CoupledTool, 1> tool{{settled({glm::dmat3(1.0), {0, 0, -2e-3}}, kSpring)}};
    for (int tick = 0; tick < 20; ++tick) {
        tool[0].device.position_m.z += 0.5e-3; // 0.5 m/s
        REQUIRE(haptics::balance(tool, face_contacts(tool[0].tool), kContact_npm));
        CHECK(tool[0].wrench.force_n.z > -1e-12);
    }
    CHECK(glm::length(tool[0].wrench.force_n) < 1e-12);
    CHECK(haptics::largest_eigenvalue(tool[0].felt) == 0.0);
}

TEST_CASE("rigid coupling: a pose that is not finite feels nothing and moves nothing") {
    std::array<CoupledTool, 1> tool{{settled({glm::dmat3(1.0), {0, 0, -2e-3}}, kSpring)}};
    const dvec3 before_m = tool[0].tool.position_m;
    tool[0].device.position_m.x = std::numeric_limits<double>::quiet_NaN();
    CHECK(!haptics::balance(tool, face_contacts(tool[0].tool), kContact_npm));
    CHECK(tool[0].wrench.force_n == dvec3{0.0});
    CHECK(tool[0].tool.position_m == before_m);
}
