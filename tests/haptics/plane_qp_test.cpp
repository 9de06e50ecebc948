#include "haptics/contact/plane_qp.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <vector>

namespace {

using glm::dvec3;
using haptics::nearest_in_planes;
using haptics::Plane;
using haptics::PlaneSolution;
using Long3 = glm::tvec3<long double>;

struct Random {
    std::mt19937_64 engine;
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }
    dvec3 unit() {
        std::normal_distribution<double> n;
        return glm::normalize(dvec3{n(engine), n(engine), n(engine)});
    }
};

struct Set {
    std::vector<Plane> plane;
    dvec3 inside_m{0.0}; // in front of all
    dvec3 goal_m{0.0};
};

// Planes around a place that all keep, each at random free, on the place, or a copy (turned by
// `tilt`) of one before it. Millimetres, as a tool's tip meets them.
Set random_set(Random& random, int planes, double tilt, bool through_place) {
    Set set;
    set.inside_m = 5e-3 * random.unit();
    set.goal_m = set.inside_m + random.between(0.0, 0.02) * random.unit();
    for (int i = 0; i < planes; ++i) {
        dvec3 n = random.unit();
        if (i > 0 && random.between(0, 1) < 0.6) {
            n = set.plane[random.engine() % i].normal;
            n *= random.between(0, 1) < 0.2 ? -1.0 : 1.0;
            n = glm::normalize(n + tilt * random.unit());
        }
        const double slack_m = through_place ? 0.0 : 5e-3 * std::pow(random.between(0.0, 1.0), 3.0);
        set.plane.push_back({n, glm::dot(n, set.inside_m) - slack_m});
    }
    return set;
}

// All sets of up to three planes by Cramer's rule in long double; the nearest point of those that
// keep all planes. `found` false: none.
struct Reference {
    Long3 place{0};
    bool found = false;
};

Reference brute_force(const Set& set) {
    const Long3 goal(set.goal_m);
    const int count = static_cast<int>(set.plane.size());
    Reference best;
    const auto normal = [&](int i) { return Long3(set.plane[i].normal); };
    const auto wanted = [&](int i) { return set.plane[i].offset_m - glm::dot(normal(i), goal); };
    const auto offer = [&](const Long3& step) {
        for (const Plane& p : set.plane)
            if (glm::dot(Long3(p.normal), goal + step) < p.offset_m - 1e-17L)
                return;
        if (!best.found || glm::length(step) < glm::length(best.place - goal))
            best = {goal + step, true};
    };
    offer(Long3{0});
    for (int i = 0; i < count; ++i) {
        offer(wanted(i) / glm::dot(normal(i), normal(i)) * normal(i));
        for (int j = i + 1; j < count; ++j) {
            const Long3 line = glm::cross(normal(i), normal(j));
            const long double line2 = glm::dot(line, line);
            if (line2 > 0)
                offer((wanted(i) * glm::cross(normal(j), line) +
                       wanted(j) * glm::cross(line, normal(i))) /
                      line2);
            for (int k = j + 1; k < count; ++k)
                if (const long double volume = glm::dot(line, normal(k)); volume != 0)
                    offer((wanted(i) * glm::cross(normal(j), normal(k)) +
                           wanted(j) * glm::cross(normal(k), normal(i)) + wanted(k) * line) /
                          volume);
        }
    }
    return best;
}

// Karush, Kuhn and Tucker: kept, pushed at only where touched, never pulled.
void check_kkt(const Set& set, const PlaneSolution& s) {
    dvec3 push{0.0};
    double size = 1e-12;
    for (int a = 0; a < s.actives; ++a) {
        const Plane& p = set.plane[s.active[a]];
        push += s.multiplier[a] * p.normal;
        size = std::max(size, std::abs(s.multiplier[a]));
        CHECK(std::abs(glm::dot(p.normal, s.place_m) - p.offset_m) < 1e-9);
    }
    for (int a = 0; a < s.actives; ++a)
        CHECK(s.multiplier[a] > -1e-9 * size);
    for (const Plane& p : set.plane)
        CHECK(glm::dot(p.normal, s.place_m) - p.offset_m > -1e-9);
    CHECK(glm::length(set.goal_m + push - s.place_m) < 1e-12 + 1e-14 * size);
}

constexpr double kDegree = 0.017453292519943295;

} // namespace

TEST_CASE("plane qp: the nearest point is that of the best of all active sets") {
    Random random{std::mt19937_64(1)};
    double worst_m = 0.0;
    int by_actives[4]{};
    for (const double tilt : {1.0, 30 * kDegree, kDegree, 1e-3, 1e-6})
        for (int i = 0; i < 1500; ++i) {
            const Set set = random_set(random, 1 + i % 10, tilt, false);
            const PlaneSolution s = nearest_in_planes(set.plane, set.goal_m);
            const Reference r = brute_force(set);
            REQUIRE(r.found);
            REQUIRE(s.feasible);
            CHECK(s.violation_m == 0.0);
            ++by_actives[s.actives];
            const auto apart_m = static_cast<double>(glm::length(r.place - Long3(s.place_m)));
            worst_m = std::max(worst_m, apart_m);
            check_kkt(set, s);
        }
    MESSAGE("worst distance from brute force ", worst_m, " m");
    CHECK(worst_m < 1e-9);
    for (const int n : by_actives)
        CHECK(n > 100); // all kinds were met
}

TEST_CASE("plane qp: sixty-four planes and a warm start give the same point") {
    Random random{std::mt19937_64(2)};
    for (int i = 0; i < 300; ++i) {
        Set set = random_set(random, 64, i % 2 ? kDegree : 1.0, false);
        const PlaneSolution cold = nearest_in_planes(set.plane, set.goal_m);
        REQUIRE(cold.feasible);
        check_kkt(set, cold);
        const std::array<int, 3> junk{static_cast<int>(random.engine() % 64), 5, 99};
        for (const std::array<int, 3>& warm : {cold.active, junk}) {
            const PlaneSolution again = nearest_in_planes(set.plane, set.goal_m, warm);
            REQUIRE(again.feasible);
            CHECK(glm::length(again.place_m - cold.place_m) < 1e-10);
        }
    }
}

TEST_CASE("plane qp: planes through one place, as at a vertex of many triangles") {
    Random random{std::mt19937_64(3)};
    for (const double tilt : {1.0, kDegree, 1e-6})
        for (int i = 0; i < 2000; ++i) {
            const Set set = random_set(random, 1 + i % 12, tilt, true);
            const PlaneSolution s = nearest_in_planes(set.plane, set.goal_m);
            REQUIRE(s.feasible);
            check_kkt(set, s);
        }
}

TEST_CASE("plane qp: the answer moves no further than the goal") {
    Random random{std::mt19937_64(4)};
    for (int i = 0; i < 3000; ++i) {
        const Set set = random_set(random, 2 + i % 9, i % 3 ? kDegree : 1.0, i % 2 == 0);
        const dvec3 other = set.goal_m + std::pow(10.0, random.between(-9, -2)) * random.unit();
        const dvec3 a = nearest_in_planes(set.plane, set.goal_m).place_m,
                    b = nearest_in_planes(set.plane, other).place_m;
        CHECK(glm::length(a - b) <= glm::length(set.goal_m - other) + 1e-11);
    }
}

TEST_CASE("plane qp: any unit of length, any order of the planes, the same point") {
    Random random{std::mt19937_64(5)};
    for (int i = 0; i < 1000; ++i) {
        Set set = random_set(random, 6, i % 2 ? kDegree : 1.0, false);
        const dvec3 place = nearest_in_planes(set.plane, set.goal_m).place_m;
        for (const double unit : {0x1p-60, 0x1p60}) { // powers of two: exactly the same
            Set other = set;
            for (Plane& p : other.plane)
                p.offset_m *= unit;
            CHECK(nearest_in_planes(other.plane, unit * set.goal_m).place_m == unit * place);
        }
        std::shuffle(set.plane.begin(), set.plane.end(), random.engine);
        CHECK(glm::length(nearest_in_planes(set.plane, set.goal_m).place_m - place) < 1e-10);
    }
}

TEST_CASE("plane qp: a slit of no width, a tube of planes and doubled planes are feasible") {
    const dvec3 z{0, 0, 1};
    std::vector<Plane> slit{{z, 0.3}, {-z, -0.3}, {z, 0.3}, {z, 0.2}};
    const PlaneSolution s = nearest_in_planes(slit, {1, 2, 5});
    CHECK(s.feasible);
    CHECK(glm::length(s.place_m - dvec3{1, 2, 0.3}) < 1e-15);
    CHECK(s.actives == 1);
    // three planes about one line leave only the line
    std::vector<Plane> tube;
    for (int i = 0; i < 3; ++i)
        tube.push_back({{std::cos(120 * i * kDegree), std::sin(120 * i * kDegree), 0}, 0.0});
    const PlaneSolution t = nearest_in_planes(tube, {0.3, -0.4, 7});
    CHECK(t.feasible);
    CHECK(glm::length(t.place_m - dvec3{0, 0, 7}) < 1e-14);
}

TEST_CASE("plane qp: what leaves no place is told, with the violation of the place given") {
    const dvec3 z{0, 0, 1};
    const std::vector<Plane> gap{{z, 1.0}, {-z, 0.0}};
    const PlaneSolution s = nearest_in_planes(gap, {0, 0, 0.4});
    CHECK_FALSE(s.feasible);
    CHECK(s.violation_m == doctest::Approx(0.6).scale(0.0));
    // an inside-out tetrahedron
    Random random{std::mt19937_64(6)};
    for (int i = 0; i < 200; ++i) {
        std::vector<Plane> out;
        for (const dvec3 n : {dvec3{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}})
            out.push_back({glm::normalize(n), 0.01});
        const PlaneSolution o = nearest_in_planes(out, 0.02 * random.unit());
        CHECK_FALSE(o.feasible);
        double worst_m = 0.0;
        for (const Plane& p : out)
            worst_m = std::max(worst_m, p.offset_m - glm::dot(p.normal, o.place_m));
        CHECK(o.violation_m == doctest::Approx(worst_m).scale(0.0));
    }
}

TEST_CASE("plane qp: nothing to keep, and what is not finite") {
    CHECK(nearest_in_planes({}, {1, 2, 3}).place_m == dvec3{1, 2, 3});
    CHECK(nearest_in_planes({}, {1, 2, 3}).feasible);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Plane> plane{{{0, 0, 1}, 1.0}, {{0, 0, 1}, nan}};
    CHECK_FALSE(nearest_in_planes(plane, {0, 0, 0}).feasible);
    CHECK_FALSE(nearest_in_planes(std::span(plane).first(1), {0, nan, 0}).feasible);
}
