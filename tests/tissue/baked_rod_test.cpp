// tests/tissue/baked_rod_test.cpp
// The organ file of a tube that is a rod.
#include "tests/tissue/organ_bytes.h"

#include <doctest/doctest.h>

using namespace organ_bytes;

namespace {

// A straight tube of three nodes in a skin of four faces.
tissue::BakedOrgan rod_organ() {
    tissue::BakedOrgan o = small_organ();
    o.mesh = {};
    o.anchored.clear();
    o.bed.clear();
    const auto skin = o.surface;
    o.surface = {};
    o.surface.rest_m = skin.rest_m;
    o.surface.triangles = skin.triangles;
    o.surface.neighbours = skin.neighbours;
    o.line = {.node_m = {{0, 0, 0}, {0.01, 0, 0}, {0.02, 0.001, 0}},
              .radius_m = {2e-3, 3e-3, 4e-3},
              .held = {1, 1, 0},
              .hold_m = {0.0, 0.25, 0.5},
              .bed_pa = 1500.0};
    return o;
}

} // namespace

TEST_CASE("baked organ: a tube comes back as the rod it was, and its skin has no rows") {
    const auto organ = rod_organ();
    const auto bytes = tissue::write_organ(organ);
    const auto read = tissue::read_organ(bytes);
    CHECK(tissue::is_rod(read));
    CHECK(read.line.node_m == organ.line.node_m);
    CHECK(read.line.radius_m == organ.line.radius_m);
    CHECK(read.line.held == organ.line.held);
    CHECK(read.line.hold_m == organ.line.hold_m);
    CHECK(read.line.bed_pa == organ.line.bed_pa);
    CHECK(tissue::write_organ(read) == bytes);
}

TEST_CASE("baked organ: a rod that cannot be stepped is refused, whatever its bytes say") {
    const auto refused = [](auto change) {
        auto organ = rod_organ();
        change(organ);
        return refusal(tissue::write_organ(organ));
    };
    CHECK(refused([](auto& o) { o.line.radius_m.pop_back(); }).find("radii of the line") !=
          std::string::npos);
    CHECK(refused([](auto& o) { o.line.held[1] = 2; }).find("held node of the line") !=
          std::string::npos);
    CHECK(refused([](auto& o) { o.line.radius_m[1] = -3e-3; }).find("radius_m") !=
          std::string::npos);
    CHECK(refused([](auto& o) { o.line.node_m[1] = o.line.node_m[0]; }).find("at one place") !=
          std::string::npos);
    CHECK(refused([](auto& o) { o.line.hold_m[2] = -1.0; }).find("spring 2") != std::string::npos);
    CHECK(refused([](auto& o) { o.line.node_m.resize(1); }) != "");
    CHECK(refused([](auto& o) { o.rigid = true; }).find("line of a rod") != std::string::npos);
    CHECK(refused([](auto& o) { o.mesh.rest_m = {{0, 0, 0}}; }) != "");
    // any byte changed, signed anew: refused or good to step
    const auto bytes = tissue::write_organ(rod_organ());
    for (std::size_t at = 12; at + kHashSize < bytes.size(); ++at) {
        for (const int flip : {1, 0x80, 0xFF}) {
            auto bad = bytes;
            bad[at] ^= static_cast<std::byte>(flip);
            sign(bad);
            try {
                const auto read = tissue::read_organ(bad);
                if (tissue::is_rod(read))
                    CHECK_NOTHROW(tissue::make_rod(read.line, read.material, glm::dvec3{0.0}));
            } catch (const std::invalid_argument&) {
            }
        }
    }
}
