#include "assets/bake/import/import.h"

#include "assets/bake/edge_for_nodes.h"
#include "assets/bake/import/picture.h"
#include "tests/bake/import/surface_files.h"
#include "tests/bake/shapes_for_tests.h"

#include <cstring>
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace bake_tests;

namespace {

bake::ImportOptions quick(double edge_mm) {
    return {.file_name = "Some Organ.stl",
            .unit = {"mm", 1e-3},
            .material = {},
            .edge_mm = edge_mm,
            .fine = {},
            .tell = {}};
}

bake::Imported imported(const Surface& s, const bake::ImportOptions& options) {
    const std::string bytes = binary_stl(s);
    return bake::import_surface(bytes_of(bytes), options);
}

/// What the tetrahedra for quadratic shapes must be.
void check_good(const bake::QuadraticBody& q, const bake::ImportedBody& b) {
    CHECK(q.organ.order == 2);
    CHECK(q.organ.name == b.organ.name);
    CHECK(q.organ.recipe_hash != b.organ.recipe_hash);
    CHECK(q.organ.surface.rest_m == b.organ.surface.rest_m);
    CHECK(q.edge_m >= b.edge_m);
    CHECK(q.quality.worst_dihedral_deg >= bake::kLeastDihedralDeg);
    CHECK(std::abs(q.volume_m3 / b.given_m3 - 1.0) <= 0.01);
    CHECK(q.boundary_distance_m <= 0.5 * q.edge_m);
    CHECK(*std::max_element(q.organ.surface.mesh_term_n_m.begin(),
                            q.organ.surface.mesh_term_n_m.end()) == 0.0);
    CHECK_NOTHROW(tissue::read_organ(tissue::write_organ(q.organ)));
}

/// What every imported organ must be.
void check_good(const bake::Imported& i) {
    for (const auto& b : i.bodies) {
        CHECK(b.quality.worst_dihedral_deg >= bake::kLeastDihedralDeg);
        CHECK(std::abs(b.volume_m3 / b.given_m3 - 1.0) <= 0.01);
        CHECK(b.skin_distance_m <= 0.5 * b.edge_m);
        CHECK(b.boundary_distance_m <= 0.5 * b.edge_m);
        CHECK_NOTHROW(tissue::read_organ(tissue::write_organ(b.organ)));
        REQUIRE(b.quadratic);
        check_good(*b.quadratic, b);
    }
}

} // namespace

TEST_CASE("import: a ball becomes tetrahedra of its volume") {
    const auto i = imported(globe(30.0, 40, 24), quick(12.0));
    REQUIRE(i.bodies.size() == 1);
    check_good(i);
    CHECK(1e9 * i.bodies[0].volume_m3 == near(bake::volume_m3(globe(30.0, 40, 24)), 1e-3));
    CHECK(i.bodies[0].organ.name == "some_organ");
    CHECK(i.notes.repairs.empty());
}

TEST_CASE("import: the same file and options give the same bytes") {
    const auto s = globe(30.0, 24, 16);
    const auto a = imported(s, quick(14.0)), b = imported(s, quick(14.0));
    CHECK(tissue::write_organ(a.bodies[0].organ) == tissue::write_organ(b.bodies[0].organ));
    CHECK(tissue::write_organ(a.bodies[0].quadratic.value().organ) ==
          tissue::write_organ(b.bodies[0].quadratic.value().organ));
    CHECK(bake::import_json(a, quick(14.0), false) == bake::import_json(b, quick(14.0), false));
    CHECK(bake::picture_png(a) == bake::picture_png(b));
}

TEST_CASE("import: for quadratic shapes a body gets about a hundred corners, at most its own") {
    const auto ball = globe(30.0, 40, 24);
    auto options = quick(0.0); // about 400 nodes
    const auto usual = imported(ball, options);
    const auto& b = usual.bodies.at(0);
    REQUIRE(b.quadratic);
    CHECK(b.quadratic->organ.mesh.rest_m.size() > 50);
    CHECK(b.quadratic->organ.mesh.rest_m.size() < 200);
    CHECK(b.organ.mesh.rest_m.size() > 250);
    const auto coarse = imported(ball, quick(20.0));
    REQUIRE(coarse.bodies.at(0).quadratic);
    CHECK(coarse.bodies[0].quadratic->edge_m >= 20e-3);

    const auto j = nlohmann::json::parse(bake::import_json(usual, options, false));
    CHECK(j["files"][1] == "some_organ.quadratic.organ");
    CHECK(j["body"][0]["quadratic"]["nodes"] == b.quadratic->organ.mesh.rest_m.size());
    CHECK(bake::import_text(usual, options).find("some_organ.quadratic.organ") !=
          std::string::npos);

    options.rigid = true;
    CHECK_FALSE(imported(ball, options).bodies.at(0).quadratic);
}

TEST_CASE("import: a brick keeps its edges and a torus its hole") {
    const auto brick_made = imported(brick({0, 0, 0}, {50, 40, 30}), quick(14.0));
    check_good(brick_made);
    CHECK(brick_made.bodies[0].skin_distance_m < 1e-4);

    Surface ring; // tube of 12 mm on a circle of 40 mm
    constexpr std::uint32_t kU = 48, kV = 20;
    for (std::uint32_t u = 0; u < kU; ++u) {
        for (std::uint32_t v = 0; v < kV; ++v) {
            const double a = 2 * std::numbers::pi * u / kU, b = 2 * std::numbers::pi * v / kV;
            const double r = 40.0 + 12.0 * std::cos(b);
            ring.point_m.emplace_back(r * std::cos(a), r * std::sin(a), 12.0 * std::sin(b));
            const std::uint32_t u1 = (u + 1) % kU, v1 = (v + 1) % kV;
            ring.triangles.push_back({u * kV + v, u1 * kV + v, u1 * kV + v1});
            ring.triangles.push_back({u * kV + v, u1 * kV + v1, u * kV + v1});
        }
    }
    const auto i = imported(ring, quick(11.0));
    check_good(i);
    // Euler: points - edges + triangles = 0 for a ring
    const auto& b = i.bodies[0].boundary;
    std::vector<char> used(b.point_m.size(), 0);
    for (const auto& t : b.triangles) {
        for (const auto v : t) {
            used[v] = 1;
        }
    }
    CHECK(2 * std::count(used.begin(), used.end(), 1) ==
          static_cast<std::ptrdiff_t>(b.triangles.size()));
}

TEST_CASE("import: a hollow ball keeps its cavity") {
    auto i = imported(both(globe(30.0, 32, 20), globe(15.0, 24, 14)), quick(12.0));
    REQUIRE(i.bodies.size() == 1);
    check_good(i);
    CHECK(i.found == 1);
    for (const auto& p : i.bodies[0].organ.mesh.rest_m) {
        CHECK(glm::length(p) > 12e-3);
    }
}

TEST_CASE("import: two bodies become two organs, or the largest by request") {
    const auto s = both(globe(30.0, 24, 16), globe(20.0, 24, 16, {70, 0, 0}));
    const auto two = imported(s, quick(14.0));
    REQUIRE(two.bodies.size() == 2);
    check_good(two);
    CHECK(two.bodies[1].organ.name == "some_organ_2");
    auto options = quick(14.0);
    options.largest = true;
    const auto one = imported(s, options);
    REQUIRE(one.bodies.size() == 1);
    CHECK(one.found == 2);
    REQUIRE(one.notes.repairs.size() == 1);
    CHECK(one.notes.repairs[0].find("--largest") != std::string::npos);
    CHECK(one.bodies[0].volume_m3 == near(two.bodies[0].volume_m3, 1e-6));
}

TEST_CASE("import: bodies that overlap become one, bodies that touch stay two") {
    const auto joined =
        imported(both(globe(30.0, 32, 20), globe(30.0, 32, 20, {40, 0.3, 0.2})), quick(14.0));
    CHECK(joined.bodies.size() == 1);
    check_good(joined);
    const auto apart = imported(
        both(brick({0, 0, 0}, {40, 30, 30}), brick({40, 0, 0}, {80, 30, 30})), quick(14.0));
    CHECK(apart.bodies.size() == 2);
    check_good(apart);
    REQUIRE(apart.notes.problems.size() == 1);
    CHECK(apart.notes.problems[0].find("bodies 1 and 2 touch at (40.00") != std::string::npos);
}

TEST_CASE("import: a surface that crosses itself is sampled anew and the place is said") {
    // a sausage bent by more than a full turn: its end lies inside its beginning
    Surface s;
    constexpr std::uint32_t kAlong = 60, kRound = 20;
    for (std::uint32_t u = 0; u < kAlong; ++u) {
        const double a = 2.08 * std::numbers::pi * u / (kAlong - 1);
        for (std::uint32_t v = 0; v < kRound; ++v) {
            const double b = 2.0 * std::numbers::pi * v / kRound;
            const double r = 40.0 + 0.4 * a + 12.0 * std::cos(b);
            s.point_m.emplace_back(r * std::cos(a), r * std::sin(a), 12.0 * std::sin(b) + 0.3 * a);
            const std::uint32_t v1 = (v + 1) % kRound, at = u * kRound;
            if (u + 1 < kAlong) {
                s.triangles.push_back({at + v, at + kRound + v, at + kRound + v1});
                s.triangles.push_back({at + v, at + kRound + v1, at + v1});
            }
            if (v > 1) { // the ends
                const std::uint32_t first = (kAlong - 1) * kRound;
                s.triangles.push_back({0, v - 1, v});
                s.triangles.push_back({first, first + v, first + v - 1});
            }
        }
    }
    const auto i = imported(s, quick(10.0));
    std::string said;
    for (const auto& line : i.notes.repairs) {
        said += line + "\n";
    }
    CAPTURE(said);
    CHECK(said.find("triangles cross or touch others in") != std::string::npos);
    CHECK(said.find("its inside sampled in cells") != std::string::npos);
    CHECK(i.bodies.size() == 1);
    check_good(i);
}

TEST_CASE("import: --fine makes edges shorter there and not elsewhere") {
    const auto s = globe(30.0, 40, 24);
    auto options = quick(14.0);
    const auto plain = imported(s, options);
    options.fine.push_back({.centre_mm = {0, 0, 30}, .radius_mm = 10.0});
    const auto fine = imported(s, options);
    const auto count = [](const bake::Imported& i, double sign) {
        std::size_t n = 0;
        for (const auto& p : i.bodies[0].organ.mesh.rest_m) {
            n += sign * p.z > 20e-3 ? 1 : 0;
        }
        return n;
    };
    CHECK(count(fine, 1.0) > 2 * count(plain, 1.0));
    CHECK(count(fine, -1.0) < 2 * count(plain, -1.0));
}

TEST_CASE("import: the report has its keys, and no times unless asked") {
    const auto i = imported(globe(30.0, 24, 16), quick(14.0));
    const auto j = nlohmann::json::parse(bake::import_json(i, quick(14.0), true));
    for (const char* key : {"bodies", "triangles", "repairs", "problems", "tets", "nodes",
                            "volume_m3", "worst_dihedral_deg", "seconds", "hausdorff_m",
                            "volume_change_percent", "aspect", "edge_mm", "phases", "files"}) {
        CAPTURE(key);
        CHECK(j.contains(key));
    }
    CHECK(j["triangles"] == 2 * 24 * 15);
    const auto still = nlohmann::json::parse(bake::import_json(i, quick(14.0), false));
    CHECK_FALSE(still.contains("seconds"));
    CHECK_FALSE(still.contains("phases"));
}

TEST_CASE("import: the edge for a number of nodes is the edge of that many cells") {
    // a cube of n cells a side has about (n + 1)^3 nodes of a lattice as dense as even tetrahedra
    const double side_m = 0.1;
    const double edge_m =
        bake::edge_for_nodes(side_m * side_m * side_m, 6 * side_m * side_m, 1000.0);
    const double inner = std::pow(side_m - edge_m, 3) * std::sqrt(2.0) / std::pow(edge_m, 3);
    const double outer = 6 * side_m * side_m / (0.5 * std::sqrt(3.0) * edge_m * edge_m);
    CHECK(inner + outer == doctest::Approx(1000.0).scale(0.0).epsilon(0.1));
}
