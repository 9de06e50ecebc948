// tests/haptics/force_shading_test.cpp
// Force shading of the virtual proxy on prisms, whose shading normals have closed forms: a facet
// of a prism inscribed in a cylinder of radius R lies at A = R cos(pi/N) from the axis, and what is
// interpolated between the normals of its edges, which are radial, points from the axis too: at s
// beside the facet's middle it leans by tan(phi) = s / A.
#include "haptics/contact/vertex_normals.h"
#include "haptics/contact/virtual_proxy.h"
#include "tests/haptics/effort.h"
#include "tests/haptics/proxy_bench.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <random>

namespace {

using glm::dvec3;
using haptics::step_virtual_proxy;
using proxy_bench::Bench;

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadius_m = 5e-4, kBig_m = 0.02; // of the ball, of the cylinder
constexpr int kFacets = 12;
constexpr double kAngle = 2.0 * kPi / kFacets, kHalf = 0.5 * kAngle;
const double kApothem_m = kBig_m * std::cos(kHalf);
const double kFacetHalf_m = kBig_m * std::sin(kHalf);
// Where a proxy stops: within a hover of its subgoal, a hover off the surface; steps get shorter
// by a half at least, so what is left is below as much again.
constexpr double kStop_m = 4.0 * 4e-6 * kRadius_m;

struct Shaded : Bench {
    std::vector<dvec3> normal;

    explicit Shaded(Bench b) : Bench(std::move(b)), normal(vertex.size()) {
        haptics::angle_weighted_normals(mesh(), normal);
        input.radius_m = kRadius_m;
    }
    void shade(bool on) {
        input.vertex_normal = on ? std::span<const dvec3>(normal) : std::span<const dvec3>();
    }
};

/// The sides of a prism about the z axis, facing out; edges at the multiples of kAngle.
Bench prism() {
    Bench b;
    for (int k = 0; k < kFacets; ++k)
        for (const double z_m : {-0.05, 0.05})
            b.vertex.push_back({kBig_m * std::cos(kAngle * k), kBig_m * std::sin(kAngle * k), z_m});
    for (std::uint32_t k = 0; k < kFacets; ++k) {
        const std::uint32_t a = 2 * k, c = 2 * ((k + 1) % kFacets);
        b.triangle.push_back({a, c, c + 1});
        b.triangle.push_back({a, c + 1, a + 1});
    }
    b.index = haptics::make_index("brute-force", b.mesh());
    return b;
}

dvec3 around(double angle) {
    return {std::cos(angle), std::sin(angle), 0.0};
}

/// On the first facet: beside its middle, and as deep as the ball's surface is behind it, pressed
/// from outside (1) or from within (-1).
dvec3 on_facet(int side, double beside_m, double deep_m) {
    return (kApothem_m + side * (kRadius_m - deep_m)) * around(kHalf) +
           beside_m * around(kHalf + 0.5 * kPi);
}

double angle_between(const dvec3& a, const dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

} // namespace

TEST_CASE("vertex normals: radial on a prism and diagonal on a cube, however faces are cut") {
    const Shaded s(prism());
    for (std::size_t v = 0; v < s.vertex.size(); ++v)
        CHECK(glm::length(s.normal[v] - around(kAngle * static_cast<double>(v / 2))) < 1e-14);

    std::vector<dvec3> corner, normal(9, dvec3{7.0});
    for (int i = 0; i < 8; ++i)
        corner.push_back({i & 1, i >> 1 & 1, i >> 2 & 1});
    corner.push_back({5, 5, 5}); // of no triangle
    const std::uint32_t face[6][4]{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                   {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int cut = 0; cut < 64; ++cut) { // each face along either diagonal
        std::vector<haptics::Corners> triangle;
        for (int f = 0; f < 6; ++f) {
            const auto at = [&](int k) { return face[f][(k + (cut >> f & 1)) % 4]; };
            triangle.push_back({at(0), at(1), at(2)});
            triangle.push_back({at(0), at(2), at(3)});
        }
        haptics::angle_weighted_normals({corner, triangle, {}}, normal);
        for (int v = 0; v < 8; ++v)
            CHECK(glm::length(normal[v] - (2.0 * corner[v] - 1.0) / std::sqrt(3.0)) < 1e-14);
        CHECK(normal[8] == dvec3{0.0});
    }
}

TEST_CASE("force shading: on a facet the force is along the interpolated normal, from both sides") {
    // proxy - device is along the normal at the proxy:  s - x = d s / A,  so  s = x / (1 - d / A)
    for (const int side : {1, -1})
        for (const double deep_m : {0.2e-3, 1e-3, 2e-3}) {
            Shaded b(prism());
            b.shade(true);
            b.lead(step_virtual_proxy, on_facet(side, 0.0, -1e-3));
            for (int i = -20; i <= 20; ++i) {
                const double beside_m = 0.035 * i * kFacetHalf_m; // to 0.7 of the way to the edge
                b.lead(step_virtual_proxy, on_facet(side, beside_m, deep_m));
                const double lean_n =
                    b.input.stiffness_npm * side * beside_m * deep_m / (kApothem_m - side * deep_m);
                const dvec3 wanted_n = side * b.input.stiffness_npm * deep_m * around(kHalf) +
                                       lean_n * around(kHalf + 0.5 * kPi);
                CHECK(glm::length(b.state.force_n - wanted_n) < b.input.stiffness_npm * kStop_m);
            }
        }
}

TEST_CASE("force shading: round a prism the force turns no faster than the normals allow") {
    // device = p - f n(p), p on a facet: with |dn/ds| = cos^2(phi) / A and the facet at phi to the
    // device's way, |turn| = |way| / (A / cos(phi) - f) <= |way| / (A - f); round an edge, none.
    // Without shading all of the turn is at the edges, where a device deeper than the ball's radius
    // lets the proxy fall from one facet to the next.
    constexpr int kTicks = kFacets * 40;
    constexpr double kDeep_m = 1e-3;
    const double device_m = kApothem_m + kRadius_m - kDeep_m;
    const double least_m = kDeep_m, most_m = kBig_m + kRadius_m - device_m; // proxy to device
    double most_turn[2]{};
    for (const bool on : {false, true}) {
        Shaded b(prism());
        b.shade(on);
        b.lead(step_virtual_proxy, (kBig_m + 2.0 * kRadius_m) * around(kHalf));
        dvec3 before_n{0.0};
        double all = 0.0, least_n = INFINITY, most_n = 0.0;
        for (int i = 0; i <= kTicks; ++i) {
            const dvec3 force_n =
                b.lead(step_virtual_proxy, device_m * around(kHalf + 2.0 * kPi * i / kTicks))
                    .force_n;
            if (i > 0) {
                most_turn[on] = std::max(most_turn[on], angle_between(before_n, force_n));
                all += angle_between(before_n, force_n);
            }
            before_n = force_n;
            least_n = std::min(least_n, glm::length(force_n));
            most_n = std::max(most_n, glm::length(force_n));
        }
        CHECK(all == doctest::Approx(2.0 * kPi).scale(0.0));
        // what shading does not smooth: how deep the device is still follows the facets
        if (on) {
            CHECK(std::abs(least_n - b.input.stiffness_npm * least_m) <
                  b.input.stiffness_npm * kStop_m);
            CHECK(std::abs(most_n - b.input.stiffness_npm * most_m) <
                  b.input.stiffness_npm * kStop_m);
        }
    }
    const double way_m = 2.0 * kPi * device_m / kTicks;
    CHECK(most_turn[1] <= way_m / (kApothem_m - most_m) + 2.0 * kStop_m / least_m);
    CHECK(most_turn[0] == doctest::Approx(kAngle).scale(0.0));
}

TEST_CASE("force shading: a loop over a facet gains what the curl of the shaded force says") {
    // F = k (x d / (A - d), d): out at one depth and back at another leaves k X^2 / 2 times the
    // difference of d / (A - d), so shading is not passive; both forces are linear on each leg.
    const double far_m = 0.6 * kFacetHalf_m, deep_m = 2e-3, shallow_m = 0.5e-3;
    for (const bool on : {false, true}) {
        Shaded b(prism());
        b.shade(on);
        b.lead(step_virtual_proxy, on_facet(1, 0.0, -1e-3));
        const double corner[5][2]{
            {0.0, deep_m}, {far_m, deep_m}, {far_m, shallow_m}, {0.0, shallow_m}, {0.0, deep_m}};
        b.lead(step_virtual_proxy, on_facet(1, 0.0, deep_m));
        double work_j = 0.0, way_m = 0.0;
        for (int leg = 0; leg < 4; ++leg)
            for (int i = 1; i <= 100; ++i) {
                const auto at = [&](int k) {
                    return corner[leg][k] + 0.01 * i * (corner[leg + 1][k] - corner[leg][k]);
                };
                const dvec3 device_m = on_facet(1, at(0), at(1));
                const dvec3 moved_m = device_m - b.input.device_m, before_n = b.state.force_n;
                b.lead(step_virtual_proxy, device_m);
                work_j += 0.5 * glm::dot(before_n + b.state.force_n, moved_m);
                way_m += glm::length(moved_m);
            }
        const double k = b.input.stiffness_npm;
        const auto lean = [](double d_m) { return d_m / (kApothem_m - d_m); };
        const double gain_j = on ? 0.5 * k * far_m * far_m * (lean(deep_m) - lean(shallow_m)) : 0.0;
        CHECK(std::abs(work_j - gain_j) < k * kStop_m * way_m);
        CHECK((!on || gain_j > 10.0 * k * kStop_m * way_m)); // the tolerance does not hide it
    }
}

TEST_CASE("force shading: the proxy never gets below a triangle, in friction or without") {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        Shaded b(proxy_bench::crumpled_ball(seed));
        b.input.radius_m = 1e-3;
        b.shade(true);
        b.input.static_friction = seed % 2 ? 0.0 : 0.4;
        b.input.dynamic_friction = seed % 2 ? 0.0 : 0.3;
        proxy_bench::Hand hand{std::mt19937_64(seed)};
        int touched = 0, leaning = 0;
        double inside_m = -1.0, nearest_m = b.input.radius_m;
        for (int i = 0; i < effort::cases(4000); ++i) {
            const auto& s = b.lead(step_virtual_proxy, hand.next());
            touched += s.touching;
            leaning += s.touching && s.contacts == 1 &&
                       angle_between(s.force_n, s.contact[0].normal) > 0.05;
            CHECK(s.force_n == b.input.stiffness_npm * (s.proxy_m - b.input.device_m));
            inside_m = std::max(inside_m, proxy_bench::inside_m(b, s.proxy_m));
            const auto skin = haptics::closest_within(b.index, b.mesh(), s.proxy_m, 1e-3);
            if (skin.hit())
                nearest_m = std::min(nearest_m, skin.distance_m);
        }
        CHECK(touched > effort::cases(1000));
        CHECK(leaning > effort::cases(300));
        CHECK(inside_m < 0.0);
        CHECK(nearest_m > b.input.radius_m * (1.0 - 1e-9));
    }
}

TEST_CASE("force shading: a flat plane and a mesh of creases are felt as they are, to the bit") {
    // a plane in general position, of 20 x 20 squares with vertices in common
    Bench plane;
    const dvec3 u = glm::normalize(dvec3{1, 2, 3}), v = glm::normalize(glm::cross(u, {0, 1, 0}));
    for (int i = 0; i <= 20; ++i)
        for (int j = 0; j <= 20; ++j)
            plane.vertex.push_back(0.02 * (i - 10) * u + 0.02 * (j - 10) * v + dvec3{0.3});
    for (std::uint32_t i = 0; i < 20; ++i)
        for (std::uint32_t j = 0; j < 20; ++j) {
            const std::uint32_t a = 21 * i + j;
            plane.triangle.push_back({a, a + 21, a + 22});
            plane.triangle.push_back({a, a + 22, a + 1});
        }
    plane.index = haptics::make_index("ours", plane.mesh());
    // a block whose faces have vertices of their own: its edges are creases
    Bench block;
    const auto face = [&](const dvec3& out, const dvec3& side) {
        const dvec3 o = 0.007 * out, a = 0.007 * side, c = glm::cross(out, a);
        block.quad(o - a - c, o + a - c, o + a + c, o - a + c);
    };
    for (const double s : {-1.0, 1.0}) {
        face({s, 0, 0}, {0, 1, 0});
        face({0, s, 0}, {0, 0, 1});
        face({0, 0, s}, {1, 0, 0});
    }
    for (const Bench& mesh : {plane, block}) {
        const dvec3 middle_m = mesh.vertex.size() > 24 ? dvec3{0.3} : dvec3{0.0};
        Shaded with(mesh), without(mesh);
        with.shade(true);
        for (Shaded* b : {&with, &without})
            b->input.static_friction = b->input.dynamic_friction = 0.2;
        proxy_bench::Hand hand{std::mt19937_64(5)};
        int touched = 0, edges = 0;
        for (int i = 0; i < 8000; ++i) {
            // a hand, then turns about an edge and past its ends
            const dvec3 at_edge_m = 0.007 * dvec3{1, 1, 1.2 * std::sin(0.003 * i)};
            const dvec3 device_m =
                middle_m + (i < 4000 ? hand.next() : at_edge_m + 4e-4 * around(0.01 * i));
            with.lead(step_virtual_proxy, device_m);
            without.lead(step_virtual_proxy, device_m);
            REQUIRE(with.state.proxy_m == without.state.proxy_m);
            REQUIRE(with.state.force_n == without.state.force_n);
            touched += with.state.touching;
            const dvec3& n = with.state.contact[0].normal;
            edges += with.state.touching &&
                     std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}) < 0.99;
        }
        CHECK(touched > 1000);
        CHECK(edges > 300); // of the block; no normal of the plane is near an axis
    }
}

TEST_CASE("force shading: normals of another mesh are not used") {
    Shaded b(prism());
    b.input.vertex_normal = std::span<const dvec3>(b.normal).first(b.normal.size() - 1);
    b.lead(step_virtual_proxy, on_facet(1, 0.0, -1e-3));
    b.lead(step_virtual_proxy, on_facet(1, 2e-3, 1e-3));
    CHECK(angle_between(b.state.force_n, around(kHalf)) < 1e-6);
}

TEST_CASE("force shading: friction is about the shading normal, what it holds stays where it is") {
    // half of the way to the edge the normal leans by phi; the pull by 0.9 of the friction's angle
    // to either side of it
    const double beside_m = 0.5 * kFacetHalf_m, deep_m = 1e-3, friction = 0.4;
    const double phi = std::atan(beside_m / kApothem_m);
    for (const double side : {1.0, -1.0}) {
        Shaded b(prism());
        b.shade(true);
        b.input.static_friction = b.input.dynamic_friction = friction;
        b.lead(step_virtual_proxy, on_facet(1, beside_m, -1e-4));
        const dvec3 stuck_m = b.lead(step_virtual_proxy, on_facet(1, beside_m, deep_m)).proxy_m;
        CHECK(glm::length(stuck_m - on_facet(1, beside_m, 0.0)) < kStop_m);
        for (int i = 0; i <= 1000; ++i) {
            const double lean = phi + side * 0.9e-3 * i * std::atan(friction);
            b.lead(step_virtual_proxy, on_facet(1, beside_m - deep_m * std::tan(lean), deep_m));
        }
        CHECK(glm::length(b.state.proxy_m - stuck_m) < kStop_m);
        CHECK_FALSE(b.state.sliding);
    }
    // along the axis there is nothing to shade: what is left drags by the dynamic coefficient
    Shaded b(prism());
    b.shade(true);
    b.input.static_friction = friction;
    b.input.dynamic_friction = 0.3;
    b.lead(step_virtual_proxy, on_facet(1, 0.0, -1e-4));
    for (int i = 0; i < 200; ++i)
        b.lead(step_virtual_proxy, on_facet(1, 0.0, deep_m) + dvec3{0, 0, 1e-5 * i});
    CHECK(b.state.sliding);
    const double push_n = glm::dot(b.state.force_n, around(kHalf));
    CHECK(-b.state.force_n.z / push_n == doctest::Approx(0.3).scale(0.0).epsilon(1e-3));
}
