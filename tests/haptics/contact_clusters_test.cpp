#include "haptics/rigid/contact_clusters.h"

#include "tests/haptics/sampled_face.h"

#include <doctest/doctest.h>

namespace {

using glm::dvec3;
using haptics::Wrench;

constexpr double kSide_m = 20e-3, kStiffness_npm = 300.0, kDegree = 0.017453292519943295;
constexpr double kMass_kg = 0.1, kDamping_nspm = 0.5, kTick_s = 1e-3;

double spread_percent(const std::vector<double>& v) {
    const auto [low, high] = std::minmax_element(v.begin(), v.end());
    return 100.0 * (*high / *low - 1.0);
}

} // namespace

TEST_CASE("clusters: a flat contact is as stiff with 1 point as with 64, in push and in tilt") {
    std::vector<double> push, tilt;
    for (const int n : {1, 2, 4, 8}) {
        for (const double cluster_m : {1e-3, 5e-3, 50e-3}) { // cut in few clusters or many
            const auto at = [&](double depth_m, double angle) {
                return face_wrench(n, kSide_m, depth_m, turn({0, 1, 0}, angle), kStiffness_npm,
                                   cluster_m);
            };
            push.push_back((at(1.01e-3, 0).force_n.z - at(0.99e-3, 0).force_n.z) / 0.02e-3);
            tilt.push_back(-(at(1e-3, 1e-3).torque_nm.y - at(1e-3, -1e-3).torque_nm.y) / 2e-3);
        }
    }
    MESSAGE("spread of push stiffness " << spread_percent(push) << " %, of tilt stiffness "
                                        << spread_percent(tilt) << " %");
    for (std::size_t i = 0; i < push.size(); ++i) {
        CHECK(push[i] == doctest::Approx(kStiffness_npm).scale(0.0).epsilon(1e-6));
        CHECK(tilt[i] ==
              doctest::Approx(kStiffness_npm * kSide_m * kSide_m / 12).scale(0.0).epsilon(0.05));
    }
    CHECK(spread_percent(tilt) < 5.0);
}

TEST_CASE("clusters: doubling the samples changes the wrench by less than 5 %, on edges too") {
    double worst_percent = 0.0;
    for (const double degrees : {0.0, 1.0, 3.0, 8.0}) {
        for (const double depth_m : {-0.5e-3, 0.1e-3, 0.5e-3, 1e-3}) {
            for (const int i : {0, 1, 2, 3, 4, 5, 6, 7}) {
                const int n = 1 << (i % 4); // about an edge, then about a diagonal
                const glm::dmat3 turned = turn({i / 4, 1, 0}, degrees * kDegree);
                const Wrench some = face_wrench(n, kSide_m, depth_m, turned, kStiffness_npm);
                const Wrench more = face_wrench(2 * n, kSide_m, depth_m, turned, kStiffness_npm);
                const double force = glm::length(more.force_n);
                if (force == 0.0)
                    continue;
                worst_percent = std::max(
                    {worst_percent, 100.0 * glm::length(more.force_n - some.force_n) / force,
                     100.0 * glm::length(more.torque_nm - some.torque_nm) / (force * kSide_m / 2)});
            }
        }
    }
    MESSAGE("worst change of the wrench " << worst_percent << " %");
    CHECK(worst_percent < 5.0);
}

TEST_CASE("clusters: nothing jumps when points enter one after the other") {
    for (const int n : {1, 2, 4, 8}) {
        for (const dvec3 axis : {dvec3{0, 1, 0}, dvec3{1, 1, 0}}) {
            const glm::dmat3 turned = turn(axis, 1.0 * kDegree);
            constexpr double kStep_m = 1e-6;
            Wrench last;
            for (double depth_m = -0.5e-3; depth_m < 0.5e-3; depth_m += kStep_m) {
                const Wrench now = face_wrench(n, kSide_m, depth_m, turned, kStiffness_npm);
                CHECK(glm::length(now.force_n - last.force_n) <= 1.5 * kStiffness_npm * kStep_m);
                CHECK(glm::length(now.torque_nm - last.torque_nm) <=
                      2.0 * kStiffness_npm * kStep_m * kSide_m);
                last = now;
            }
        }
    }
}

TEST_CASE("clusters: n points of 300 N/m each ring from four on, one shared stiffness never") {
    const std::array<double, 5> published{0.99825, 0.99900, 0.99975, 1.00050, 1.00124};
    for (int n = 1; n <= 5; ++n) {
        const double naive =
            sampled_wall_radius(kMass_kg, kDamping_nspm, n * kStiffness_npm, kTick_s);
        CHECK(naive == doctest::Approx(published[n - 1]).scale(0.0).epsilon(1e-5));
        CHECK((naive < 1.0) == (n < 4));
    }
    for (const int n : {1, 2, 4, 8}) {
        const auto force_n = [&](double depth_m) {
            return face_wrench(n, kSide_m, depth_m, glm::dmat3(1.0), kStiffness_npm).force_n.z;
        };
        const double stiffness_npm = (force_n(1.01e-3) - force_n(1e-3)) / 0.01e-3;
        CHECK(sampled_wall_radius(kMass_kg, kDamping_nspm, stiffness_npm, kTick_s) ==
              doctest::Approx(published[0]).scale(0.0).epsilon(1e-5));
    }
}

TEST_CASE("clusters: faces at right angles and opposite each keep their own stiffness") {
    std::vector<haptics::ContactPatch> patch;
    for (const dvec3 n : {dvec3{1, 0, 0}, dvec3{-1, 0, 0}, dvec3{0, 0, 1}})
        patch.push_back({.middle_m = -0.01 * n, .normal = n, .depth_m = 1e-3, .area_m2 = 1e-6});
    haptics::ContactList contacts;
    haptics::cluster_contacts(patch, {}, contacts);
    REQUIRE(contacts.count == 3);
    for (const haptics::RepresentativeContact& c : contacts) {
        CHECK(c.share == doctest::Approx(1.0).scale(0.0));
        CHECK(c.depth_m == doctest::Approx(1e-3).scale(0.0));
    }
    CHECK(contact_wrench(contacts, 1000.0, {}).force_n.z == doctest::Approx(1.0).scale(0.0));
}

TEST_CASE("clusters: more clusters than there is room for still carry the whole force") {
    std::vector<haptics::ContactPatch> patch;
    for (int i = 0; i < 100; ++i)
        patch.push_back({.middle_m = {0.1 * i, 0, 0}, .depth_m = 1e-3, .area_m2 = 1e-6});
    haptics::ContactList contacts;
    haptics::cluster_contacts(patch, {}, contacts);
    CHECK(contacts.count == 16);
    CHECK(contact_wrench(contacts, 1000.0, {}).force_n.z == doctest::Approx(1.0).scale(0.0));
    haptics::cluster_contacts({}, {}, contacts);
    CHECK(contacts.count == 0);
}
