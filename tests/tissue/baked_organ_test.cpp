#include "tests/tissue/organ_bytes.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <rapidcheck.h>
#include <set>
#include <stdexcept>
#include <string_view>

using namespace organ_bytes;

namespace {

// The same with rows on the ten nodes: a face's middle is 4/9 of each of its edges' nodes and -1/9
// of its corners. By ascending corners the edges are 01 02 03 12 13 23, nodes 4 to 9.
tissue::BakedOrgan quadratic_organ() {
    tissue::BakedOrgan o = small_organ();
    o.order = 2;
    o.surface.row_start = {0, 1, 2, 3, 9};
    o.surface.row_node = {0, 1, 2, 0, 1, 2, 4, 5, 7};
    o.surface.row_weight = {1.0, 1.0, 1.0, -1. / 9, -1. / 9, -1. / 9, 4. / 9, 4. / 9, 4. / 9};
    o.surface.mesh_term_n_m = o.surface.mesh_term_t_m = {0, 0, 0, 0};
    o.surface.mesh_lean_m.assign(4, {});
    return o;
}

constexpr std::size_t kOrderAt = 8 + 4 + 8 + 5 + 1; // magic, version, "probe", rigid

bool all_below(const auto& lists, std::size_t limit) {
    return std::all_of(lists.begin(), lists.end(), [&](const auto& list) {
        return std::all_of(list.begin(), list.end(), [&](auto i) { return i < limit; });
    });
}

// Corners, and with order 2 as many more as there are different edges.
std::size_t nodes_of_rows(const tissue::BakedOrgan& o) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& t : o.mesh.tets) {
        for (int a = 0; a < 4; ++a) {
            for (int b = 0; b < 4; ++b) {
                if (a != b) {
                    edges.emplace(std::min(t[a], t[b]), std::max(t[a], t[b]));
                }
            }
        }
    }
    return o.mesh.rest_m.size() + (o.order == 2 ? edges.size() : 0);
}

// What a reader of the organ relies on, stated apart from the code that checks it.
bool safe_to_use(const tissue::BakedOrgan& o) {
    const auto& s = o.surface;
    const std::size_t nodes = o.mesh.rest_m.size(), vertices = s.rest_m.size();
    bool good = all_below(o.mesh.tets, nodes) && all_below(s.triangles, vertices) &&
                all_below(s.frame_node, nodes) && s.neighbours.size() == s.triangles.size() &&
                o.anchored.size() == nodes && (o.order == 1 || o.order == 2);
    for (const auto& n : s.neighbours) {
        good = good && std::all_of(n.begin(), n.end(), [&](std::int32_t t) {
                   return t >= -1 && t < static_cast<std::int32_t>(s.triangles.size());
               });
    }
    if (o.rigid) {
        return good && nodes == 0 && s.row_start.empty() && s.row_node.empty();
    }
    good = good && s.row_start.size() == vertices + 1 && s.row_start.front() == 0 &&
           s.row_start.back() == s.row_node.size() && s.row_weight.size() == s.row_node.size() &&
           std::is_sorted(s.row_start.begin(), s.row_start.end()) &&
           std::all_of(s.row_node.begin(), s.row_node.end(),
                       [&](auto n) { return n < nodes_of_rows(o); });
    for (const auto* list :
         {&s.footprint_radius_m, &s.thickness_m, &s.mesh_term_n_m, &s.mesh_term_t_m}) {
        good = good && list->size() == vertices &&
               std::all_of(list->begin(), list->end(), [](double x) { return std::isfinite(x); });
    }
    for (const auto& lean : s.mesh_lean_m)
        good = good && std::ranges::all_of(lean, [](double x) { return std::isfinite(x); });
    return good && s.mesh_lean_m.size() == vertices && s.offset_m.size() == vertices &&
           s.frame_node.size() == vertices;
}

} // namespace

TEST_CASE("baked organ: every field survives writing and reading") {
    const auto organ = small_organ();
    const auto read = tissue::read_organ(tissue::write_organ(organ));
    CHECK(read.name == organ.name);
    CHECK(read.rigid == organ.rigid);
    CHECK(read.order == organ.order);
    CHECK(read.mesh.rest_m == organ.mesh.rest_m);
    CHECK(read.mesh.tets == organ.mesh.tets);
    CHECK(read.anchored == organ.anchored);
    REQUIRE(read.bed.size() == 2);
    CHECK(read.bed[1].weight == organ.bed[1].weight);
    CHECK(read.bed[0].stiffness_m == 0.5);
    CHECK(read.surface.rest_m == organ.surface.rest_m);
    CHECK(read.surface.triangles == organ.surface.triangles);
    CHECK(read.surface.neighbours == organ.surface.neighbours);
    CHECK(read.surface.row_start == organ.surface.row_start);
    CHECK(read.surface.row_node == organ.surface.row_node);
    CHECK(read.surface.row_weight == organ.surface.row_weight);
    CHECK(read.surface.offset_m == organ.surface.offset_m);
    CHECK(read.surface.frame_node == organ.surface.frame_node);
    CHECK(read.surface.footprint_radius_m == organ.surface.footprint_radius_m);
    CHECK(read.surface.thickness_m == organ.surface.thickness_m);
    CHECK(read.surface.mesh_term_n_m == organ.surface.mesh_term_n_m);
    CHECK(read.surface.mesh_term_t_m == organ.surface.mesh_term_t_m);
    CHECK(read.surface.mesh_lean_m == organ.surface.mesh_lean_m);
    CHECK(read.material.young_pa == organ.material.young_pa);
    CHECK(read.material.poisson == organ.material.poisson);
    CHECK(read.material.density_kgpm3 == organ.material.density_kgpm3);
    CHECK(read.material.damping_mass_1ps == organ.material.damping_mass_1ps);
    CHECK(read.material.damping_stiffness_s == organ.material.damping_stiffness_s);
    CHECK(read.material.friction == organ.material.friction);
    CHECK(read.material.source == organ.material.source);
    CHECK(read.tip_radius_max_m == organ.tip_radius_max_m);
    CHECK(read.recipe_hash == organ.recipe_hash);
}

TEST_CASE("baked organ: the file is little endian and ends with the FNV-1a hash of the rest") {
    const auto bytes = tissue::write_organ(small_organ());
    std::string head;
    for (std::size_t i = 0; i < 8; ++i) {
        head.push_back(static_cast<char>(bytes[i]));
    }
    CHECK(head == "TROCORGN");
    CHECK(bytes[8] == std::byte{5}); // version
    CHECK(bytes[11] == std::byte{0});
    CHECK(bytes[12] == std::byte{5}); // length of the name
    CHECK(bytes[20] == std::byte{'p'});
    auto again = bytes;
    sign(again);
    CHECK(again == bytes);
}

TEST_CASE("baked organ: every shortened file is refused") {
    for (const auto& bytes :
         {tissue::write_organ(small_organ()), tissue::write_organ(quadratic_organ())}) {
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            CHECK_THROWS_AS(tissue::read_organ(std::span(bytes).first(size)),
                            std::invalid_argument);
        }
    }
}

TEST_CASE("baked organ: a shortened file with a right checksum is refused") {
    const auto bytes = tissue::write_organ(small_organ());
    for (std::size_t size = 20; size < bytes.size(); ++size) {
        auto cut = bytes;
        cut.resize(size);
        sign(cut);
        CHECK_THROWS_AS(tissue::read_organ(cut), std::invalid_argument);
    }
}

TEST_CASE("baked organ: every single wrong bit is refused") {
    auto bytes = tissue::write_organ(small_organ());
    for (auto& byte : bytes) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            byte ^= static_cast<std::byte>(1U << bit);
            CHECK_THROWS_AS(tissue::read_organ(bytes), std::invalid_argument);
            byte ^= static_cast<std::byte>(1U << bit);
        }
    }
}

TEST_CASE("baked organ: damage behind a right checksum is refused or harmless") {
    const std::array good{tissue::write_organ(small_organ()),
                          tissue::write_organ(quadratic_organ())};
    CHECK(rc::check([&good] {
        auto bytes = good[*rc::gen::inRange<std::size_t>(0, good.size())];
        const int changes = *rc::gen::inRange(1, 5);
        for (int i = 0; i < changes; ++i) {
            const auto at = *rc::gen::inRange<std::size_t>(12, bytes.size() - kHashSize);
            const int value = *rc::gen::element(0, 1, 2, 3, 5, 0x7F, 0x80, 0xF0, 0xFF);
            bytes[at] = static_cast<std::byte>(value);
        }
        sign(bytes);
        try {
            const auto organ = tissue::read_organ(bytes);
            RC_ASSERT(safe_to_use(organ));
            RC_ASSERT(tissue::write_organ(organ) == bytes);
        } catch (const std::invalid_argument&) {
            RC_TAG("refused");
        }
    }));
}

TEST_CASE("baked organ: arbitrary bytes are refused") {
    CHECK(rc::check([](const std::vector<std::uint8_t>& raw) {
        std::vector<std::byte> bytes;
        for (const auto b : raw) {
            bytes.push_back(static_cast<std::byte>(b));
        }
        RC_ASSERT_THROWS_AS(tissue::read_organ(bytes), std::invalid_argument);
    }));
}

TEST_CASE("baked organ: a list longer than the file is refused before memory is asked for") {
    auto bytes = tissue::write_organ(small_organ());
    for (std::size_t i = 12; i < 20; ++i) { // length of the name
        bytes[i] = std::byte{0xFF};
    }
    sign(bytes);
    CHECK(refusal(bytes).find("byte 12: a list of 18446744073709551615 items") !=
          std::string::npos);
}

TEST_CASE("baked organ: an index out of range is named with its byte") {
    auto organ = small_organ();
    organ.mesh.tets[0][2] = 4; // there are nodes 0 to 3
    const auto bytes = tissue::write_organ(organ);
    const std::string why = refusal(bytes);
    CHECK(why.find("node of a tetrahedron 4 is out of range") != std::string::npos);

    // the byte it names holds the 4
    const auto at = static_cast<std::size_t>(std::stoul(why.substr(why.find("byte ") + 5)));
    CHECK(bytes[at] == std::byte{4});
}

TEST_CASE("baked organ: a number that is not finite is refused") {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        auto organ = small_organ();
        organ.surface.thickness_m[1] = bad;
        CHECK(refusal(tissue::write_organ(organ)).find("not a finite number") != std::string::npos);
    }
}

TEST_CASE("baked organ: a bed in a tetrahedron that is not there is refused") {
    auto organ = small_organ();
    organ.bed[1].tet = 1;
    CHECK(refusal(tissue::write_organ(organ)).find("tetrahedron of the bed 1") !=
          std::string::npos);
}

TEST_CASE("baked organ: a file of another version is refused by its number") {
    auto bytes = tissue::write_organ(small_organ());
    for (const int version : {6, 1}) {
        bytes[8] = static_cast<std::byte>(version);
        sign(bytes);
        CHECK(refusal(bytes).find("version " + std::to_string(version) +
                                  ", this build reads versions 2 to 5") != std::string::npos);
    }
}

namespace {

// As an older build wrote it: with neither what leans nor, before version 4, a line.
std::vector<std::byte> older(const tissue::BakedOrgan& organ, int version) {
    auto bytes = tissue::write_organ(organ);
    bytes[8] = static_cast<std::byte>(version);
    const auto end = bytes.end() - kHashSize, line = end - kLineSize;
    if (version < 4)
        bytes.erase(line, end);
    bytes.erase(line - kLeanSize, line);
    if (version < 3)
        bytes.erase(bytes.begin() + kOrderAt, bytes.begin() + kOrderAt + 4);
    sign(bytes);
    return bytes;
}

} // namespace

TEST_CASE("baked organ: a file of version 2 is read as order 1") {
    auto organ = small_organ();
    const auto read = tissue::read_organ(older(organ, 2));
    CHECK(read.order == 1);
    CHECK(read.tip_radius_max_m == organ.tip_radius_max_m);
    organ.surface.mesh_lean_m.assign(4, {});
    CHECK(tissue::write_organ(read) == tissue::write_organ(organ)); // all else is there
}

TEST_CASE("baked organ: a file of version 3 is read as a body without a rod") {
    const auto organ = quadratic_organ();
    const auto read = tissue::read_organ(older(organ, 3));
    CHECK_FALSE(tissue::is_rod(read));
    CHECK(tissue::write_organ(read) == tissue::write_organ(organ));
}

TEST_CASE("baked organ: a file of version 4 is read as one whose mesh terms do not lean") {
    auto organ = small_organ();
    const auto read = tissue::read_organ(older(organ, 4));
    organ.surface.mesh_lean_m.assign(4, {});
    CHECK(tissue::write_organ(read) == tissue::write_organ(organ));
}

TEST_CASE("baked organ: what leans has six numbers for each vertex") {
    auto organ = small_organ();
    organ.surface.mesh_lean_m.pop_back();
    CHECK(refusal(tissue::write_organ(organ)).find("leaning mesh terms: 3 items, 4 expected") !=
          std::string::npos);
}

TEST_CASE("baked organ: rows of order 2 may name nodes on edges, frames and tets may not") {
    const auto organ = quadratic_organ();
    const auto read = tissue::read_organ(tissue::write_organ(organ));
    CHECK(read.order == 2);
    CHECK(read.surface.row_node == organ.surface.row_node);
    CHECK(read.surface.row_weight == organ.surface.row_weight);

    auto beyond = organ;
    beyond.surface.row_node.back() = 9; // the last edge
    CHECK_NOTHROW(tissue::read_organ(tissue::write_organ(beyond)));
    beyond.surface.row_node.back() = 10;
    CHECK(refusal(tissue::write_organ(beyond)).find("node of a row 10 is out of range") !=
          std::string::npos);
    beyond = organ;
    beyond.surface.frame_node[1][2] = 4;
    CHECK(refusal(tissue::write_organ(beyond)).find("node of a frame 4 is out of range") !=
          std::string::npos);
    beyond = small_organ(); // order 1 has no nodes on edges
    beyond.surface.row_node.back() = 4;
    CHECK(refusal(tissue::write_organ(beyond)).find("node of a row 4 is out of range") !=
          std::string::npos);
}

TEST_CASE("baked organ: an order that there is not is refused at its byte") {
    for (const int order : {0, 3, -1}) {
        auto organ = small_organ();
        organ.order = order;
        const std::string why = refusal(tissue::write_organ(organ));
        CHECK(why.find("byte " + std::to_string(kOrderAt) + ": order " + std::to_string(order) +
                       " of a soft body") != std::string::npos);
    }
}

TEST_CASE("baked organ: a rigid body has a surface and nothing else") {
    tissue::BakedOrgan wall;
    wall.rigid = true;
    wall.surface.rest_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    wall.surface.triangles = {{0, 1, 2}};
    wall.surface.neighbours = tissue::triangle_neighbours(wall.surface.triangles);
    const auto read = tissue::read_organ(tissue::write_organ(wall));
    CHECK(read.rigid);
    CHECK(read.surface.triangles == wall.surface.triangles);

    wall.mesh.rest_m = {{0, 0, 0}};
    wall.anchored = {0};
    CHECK(refusal(tissue::write_organ(wall)).find("rigid") != std::string::npos);

    wall = read;
    wall.order = 2;
    CHECK(refusal(tissue::write_organ(wall)).find("order 2 of a rigid body") != std::string::npos);
}
