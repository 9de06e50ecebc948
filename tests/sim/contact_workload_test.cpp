// tests/sim/contact_workload_test.cpp
// The work that contact is measured on is what it says it is: closed, outward, of the stated size,
// breathing as a formula; the path presses, trembles and hops; its judge of sides agrees with the
// winding number.
#include "sim/study/contact_workload.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <stdexcept>

namespace {

using glm::dvec3;

using Edge = std::pair<std::uint32_t, std::uint32_t>;

double signed_volume_m3(const sim::ContactWorkload& work) {
    double sum = 0.0;
    for (const auto& [a, b, c] : work.triangle)
        sum += glm::dot(work.rest_m[a], glm::cross(work.rest_m[b], work.rest_m[c])) / 6.0;
    return sum;
}

/// How often a closed surface winds around a place (Van Oosterom, Strackee 1983).
double winding(const sim::ContactWorkload& work, std::span<const dvec3> vertex_m,
               const dvec3& place) {
    double sum = 0.0;
    for (const auto& t : work.triangle) {
        const dvec3 a = vertex_m[t[0]] - place, b = vertex_m[t[1]] - place,
                    c = vertex_m[t[2]] - place;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        sum += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc +
                                                                   glm::dot(b, c) * la +
                                                                   glm::dot(c, a) * lb);
    }
    return sum / (4.0 * std::numbers::pi);
}

/// Height of a ball's centre over the smooth resting skin, along the skin's normal, by Newton
/// steps to the foot.
double height_over_organ_m(const sim::ContactWorkload& work, const dvec3& centre) {
    dvec3 unit = glm::normalize(centre);
    sim::SkinPlace skin = organ_skin(work.ripples, unit);
    for (int i = 0; i < 200; ++i) {
        const dvec3 off = centre - skin.place_m;
        unit = glm::normalize(skin.place_m + off - glm::dot(off, skin.normal) * skin.normal);
        skin = organ_skin(work.ripples, unit);
    }
    return glm::dot(centre - skin.place_m, skin.normal);
}

} // namespace

TEST_CASE("contact work: both meshes are closed, wound outward and as large as asked") {
    for (const auto& [name, count] : {std::pair{"organ:1k", 980},
                                      {"organ:10k", 9680},
                                      {"organ:100k", 100820},
                                      {"sheet:1k", 1020},
                                      {"sheet:10k", 9996}}) {
        CAPTURE(name);
        const auto work = sim::make_contact_workload(name, 5);
        CHECK(work.triangle.size() == count);
        std::map<Edge, int> used;
        for (const auto& t : work.triangle)
            for (int k = 0; k < 3; ++k)
                ++used[{t[k], t[(k + 1) % 3]}];
        int open = 0;
        for (const auto& [edge, n] : used)
            open += n != 1 || used.count({edge.second, edge.first}) != 1;
        CHECK(open == 0);
        // Euler: of a sphere
        CHECK(work.rest_m.size() + work.triangle.size() == used.size() / 2 + 2);
        CHECK(signed_volume_m3(work) > 0.0);
    }
}

TEST_CASE("contact work: the organ is a sphere of 60 mm give or take a few") {
    const auto work = sim::make_contact_workload("organ:10k", 5);
    double least = 1.0, most = 0.0;
    for (const dvec3& v : work.rest_m) {
        least = std::min(least, glm::length(v));
        most = std::max(most, glm::length(v));
    }
    CHECK(least > 0.0556);
    CHECK(most < 0.0644);
    CHECK(most - least > 0.002);
    int inward = 0;
    for (const auto& [a, b, c] : work.triangle) {
        const dvec3 p = work.rest_m[a], q = work.rest_m[b], r = work.rest_m[c];
        inward += glm::dot(glm::cross(q - p, r - p), p + q + r) <= 0.0;
    }
    CHECK(inward == 0);
}

TEST_CASE("contact work: the sheet is 1 mm thick along its normal everywhere") {
    const auto work = sim::make_contact_workload("sheet:10k", 5);
    const std::size_t half = work.rest_m.size() / 2;
    for (std::size_t v = 0; v < half; ++v) {
        const dvec3 top = work.rest_m[v], under = work.rest_m[v + half];
        const double z = sim::sheet_skin(work.ripples, top.x, top.y).normal.z;
        REQUIRE((top - under).z * z == doctest::Approx(0.001).scale(0.0).epsilon(1e-12));
        REQUIRE(glm::length(dvec3{top.x - under.x, top.y - under.y, 0.0}) == 0.0);
    }
    // and so the nearest place of the smooth lower skin is 1 mm away, up to its curvature
    double least = 1.0;
    const sim::SkinPlace top = sim::sheet_skin(work.ripples, 0.01, -0.02);
    for (int i = -100; i <= 100; ++i)
        for (int j = -100; j <= 100; ++j) {
            const auto s = sim::sheet_skin(work.ripples, 0.01 + 1e-5 * i, -0.02 + 1e-5 * j);
            const dvec3 under = s.place_m - dvec3{0.0, 0.0, 0.001 / s.normal.z};
            least = std::min(least, glm::length(under - top.place_m));
        }
    CHECK(least == doctest::Approx(0.001).scale(0.0).epsilon(0.02));
}

TEST_CASE("contact work: a normal stands on the smooth skin's finite differences") {
    const auto organ = sim::organ_ripples(3);
    const auto sheet = sim::sheet_ripples(3);
    for (const double turn : {0.3, 1.7, 4.0}) {
        const auto at = [&](double a, double b) {
            return sim::organ_skin(
                organ, {std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)});
        };
        const auto over = [&](double a, double b) {
            return sim::sheet_skin(sheet, 0.01 * a, 0.01 * b);
        };
        constexpr double h = 1e-6;
        const dvec3 da = at(turn + h, 0.4).place_m - at(turn - h, 0.4).place_m;
        const dvec3 db = at(turn, 0.4 + h).place_m - at(turn, 0.4 - h).place_m;
        CHECK(std::abs(glm::dot(glm::normalize(da), at(turn, 0.4).normal)) < 1e-6);
        CHECK(std::abs(glm::dot(glm::normalize(db), at(turn, 0.4).normal)) < 1e-6);
        // of the sheet: its middle's; half a millimetre off the slope has changed by little
        const dvec3 dx = over(turn + h, 0.4).place_m - over(turn - h, 0.4).place_m;
        CHECK(std::abs(glm::dot(glm::normalize(dx), over(turn, 0.4).normal)) < 0.02);
    }
}

TEST_CASE("contact work: sides agree with the winding number, at rest and breathing") {
    for (const char* name : {"organ:1k", "sheet:1k"}) {
        CAPTURE(name);
        const auto work = sim::make_contact_workload(name, 7);
        for (const sim::Wave wave : {sim::Wave::radial, sim::Wave::travelling}) {
            sim::MovingSkin skin;
            sim::Dice dice(11);
            for (int tick = 0; tick < 400; ++tick) {
                follow(work, {0.005, wave}, tick, skin);
                dvec3 place = (0.060 + dice.between(-0.01, 0.01)) * dice.direction();
                if (!work.organ)
                    place = {dice.between(-0.058, 0.058), dice.between(-0.058, 0.058),
                             dice.between(-0.01, 0.01)};
                const bool within = winding(work, skin.now_m, place) > 0.5;
                REQUIRE((side_of(work, skin.now_m, place) == 0) == within);
            }
        }
    }
    const auto sheet = sim::make_contact_workload("sheet:1k", 7);
    CHECK(side_of(sheet, sheet.rest_m, {0.0, 0.0, 0.02}) == 1);
    CHECK(side_of(sheet, sheet.rest_m, {0.0, 0.0, -0.02}) == -1);
}

TEST_CASE("contact work: the mesh breathes by its formula, 60 times a second") {
    const auto work = sim::make_contact_workload("organ:1k", 1);
    sim::MovingSkin skin;
    int moves = 0;
    double most_m = 0.0;
    for (int tick = 0; tick < 1000; ++tick) {
        follow(work, {0.002, sim::Wave::radial}, tick, skin);
        moves += skin.moved;
        CHECK(skin.view(work).before_m.empty() != skin.moved);
        const double out_m = glm::length(skin.now_m[17]) - glm::length(work.rest_m[17]);
        most_m = std::max(most_m, out_m);
        if (skin.moved) {
            const double turn = 2.0 * std::numbers::pi * (tick * 60 / 1000) / 60.0;
            CHECK(out_m == doctest::Approx(0.002 * std::sin(turn)).epsilon(1e-9).scale(0.002));
            const double step_m = glm::length(skin.now_m[17] - skin.before_m[17]);
            CHECK(step_m < 0.002 * 2.0 * std::numbers::pi / 60.0);
        }
    }
    CHECK(moves == 59); // frame 0 is where it begins
    CHECK(most_m == doctest::Approx(0.002).scale(0.0).epsilon(1e-9));

    follow(work, {0.0, sim::Wave::radial}, 0, skin);
    CHECK(skin.now_m == work.rest_m);
    follow(work, {0.0, sim::Wave::radial}, 17, skin);
    CHECK(!skin.moved);
}

TEST_CASE("contact path: presses 4 mm, trembles at 8 Hz, hops 20 mm every 2 s") {
    const auto work = sim::make_contact_workload("organ:1k", 1);
    const double radius_m = 0.002;
    const auto path = contact_path(work, 8.0, 4, radius_m);
    REQUIRE(path.size() == 8000);
    double deepest_m = -1.0, fastest_m = 0.0;
    std::vector<double> height_m;
    for (std::size_t i = 0; i < path.size(); ++i) {
        height_m.push_back(height_over_organ_m(work, path[i]));
        deepest_m = std::max(deepest_m, radius_m - height_m.back());
        if (i > 0)
            fastest_m = std::max(fastest_m, glm::length(path[i] - path[i - 1]));
    }
    CHECK(deepest_m > 0.0039);
    CHECK(deepest_m < 0.0041); // the skin is curved: the foot is not quite below
    CHECK(fastest_m < 0.0004);
    for (int hop = 0; hop < 4; ++hop) {
        CHECK(height_m[2000 * hop] - radius_m > 0.020 - 0.0042);
        CHECK(height_m[2000 * hop] - radius_m < 0.020 + 0.0013);
        CHECK(height_m[2000 * hop + 150] - radius_m < 0.0013);
        CHECK(height_m[2000 * hop + 1000] - radius_m < 0.0013);
    }
    // The amplitude at 8 Hz over a quiet second: that of the trembling. Hann's window, because the
    // slow swing does not close in a second, and without it leaks 0.1 mm and more to 8 Hz
    double cosine = 0.0, sine = 0.0;
    for (int i = 0; i < 1000; ++i) {
        const double second = 2.0 * std::numbers::pi * i / 1000.0;
        const double part_m = height_m[500 + i] * (1.0 - std::cos(second)) / 500.0;
        cosine += part_m * std::cos(8.0 * second);
        sine += part_m * std::sin(8.0 * second);
    }
    CHECK(std::hypot(cosine, sine) == doctest::Approx(0.0002).scale(0.0).epsilon(0.02));
}

TEST_CASE("contact work: the same seed gives the same bits, another one others") {
    for (const char* name : {"organ:1k", "sheet:1k"}) {
        const auto one = sim::make_contact_workload(name, 3),
                   same = sim::make_contact_workload(name, 3),
                   other = sim::make_contact_workload(name, 4);
        CHECK(one.rest_m == same.rest_m);
        CHECK(one.rest_m != other.rest_m);
        CHECK(contact_path(one, 1.0, 3, 0.002) == contact_path(same, 1.0, 3, 0.002));
        CHECK(contact_path(one, 1.0, 3, 0.002) != contact_path(one, 1.0, 4, 0.002));
    }
}

TEST_CASE("contact work: what is not a workload is refused with what would be") {
    for (const char* name : {"organ:", "organ:10q", "organ:5", "sheet:1e9", "sheet:100M",
                             "liver:1k", "organ:nan", "organ:-10k", "organ:10kk"}) {
        CAPTURE(name);
        CHECK_THROWS_WITH_AS(sim::make_contact_workload(name, 1), doctest::Contains("organ:10k"),
                             std::invalid_argument);
    }
    CHECK_THROWS_WITH_AS(sim::wave_of("round"), doctest::Contains("travelling"),
                         std::invalid_argument);
    const auto work = sim::make_contact_workload("sheet:1k", 1);
    CHECK_THROWS_AS(contact_path(work, 0.0, 1, 0.002), std::invalid_argument);
    CHECK_THROWS_AS(contact_path(work, 1.0, 1, -0.002), std::invalid_argument);
}
