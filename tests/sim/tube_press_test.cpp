// tests/sim/tube_press_test.cpp
// A tip on a tube that is a rod: the trainer's own step beside the reference solver on the same
// full cylinder, lying in the same bed. What yields under the tip is the local law's alone, what
// bends is the rod's.
#include "sim/study/reference_press.h"
#include "sim/study/trainer_press.h"
#include "tests/tissue/cylinders.h"

#include <doctest/doctest.h>

using glm::dvec3;

namespace {

constexpr int kSides = 12;
constexpr double kLength_m = 36e-3, kHold_m = 5e-3; // some twelve radii; L of the bed

tissue::Material soft(double poisson) {
    tissue::Material material;
    material.young_pa = 40e3;
    material.poisson = poisson;
    return material;
}

// Corners of a full cylinder along z, twelve-sided, as large as the round one.
tissue::TetMesh cylinder(double radius_m) {
    const double turn_rad = 2 * std::numbers::pi / kSides;
    const double corner_m = radius_m * std::sqrt(turn_rad / std::sin(turn_rad));
    cylinders::Rings rings{.radius_m = {0.0, 0.5 * corner_m, corner_m},
                           .segments = kSides,
                           .arc_rad = 2 * std::numbers::pi,
                           .round = false};
    for (int i = 0; i <= 12; ++i)
        rings.z_m.push_back(kLength_m * i / 12);
    const tissue::QuadraticMesh ten = cylinders::mesh(rings);
    tissue::TetMesh mesh;
    std::uint32_t corners = 0;
    for (const tissue::Tet10& t : ten.tets) {
        mesh.tets.push_back({t[0], t[1], t[2], t[3]});
        corners = std::max({corners, t[0] + 1, t[1] + 1, t[2] + 1, t[3] + 1});
    }
    mesh.rest_m.assign(ten.rest_m.begin(), ten.rest_m.begin() + corners);
    return mesh;
}

bool everywhere(const dvec3&) {
    return true;
}

tissue::BakedOrgan full(double radius_m, const tissue::Material& material) {
    tissue::BakedOrgan organ;
    organ.name = "cylinder";
    organ.mesh = cylinder(radius_m);
    organ.anchored.assign(organ.mesh.rest_m.size(), 0);
    organ.bed = tissue::make_bed(organ.mesh, everywhere, kHold_m);
    organ.material = material;
    return organ;
}

tissue::BakedOrgan rod(double radius_m, const tissue::Material& material) {
    const tissue::TetMesh mesh = cylinder(radius_m);
    tissue::BakedOrgan organ;
    organ.name = "rod";
    organ.surface.rest_m = mesh.rest_m;
    organ.surface.triangles = tissue::boundary_triangles(mesh);
    organ.surface.neighbours = tissue::triangle_neighbours(organ.surface.triangles);
    organ.material = material;
    organ.tip_radius_max_m = 3e-3;
    for (int i = 0; i <= 18; ++i) {
        organ.line.node_m.push_back({0.0, 0.0, kLength_m * i / 18});
        organ.line.radius_m.push_back(radius_m);
    }
    organ.line.held.assign(organ.line.node_m.size(), 0);
    tissue::hold_line(everywhere, kHold_m, organ.line);
    return organ;
}

} // namespace

TEST_CASE("tube: a tip pressed into a rod feels what it feels on the full cylinder") {
    struct Case {
        double radius_m, tip_m, poisson;
    };
    const double infinite = std::numeric_limits<double>::infinity();
    for (const auto& [radius_m, tip_m, poisson] :
         {Case{3e-3, 1.5e-3, 0.45}, Case{2e-3, 1e-3, 0.3}, Case{2e-3, 1.5e-3, 0.49}}) {
        CAPTURE(radius_m);
        CAPTURE(tip_m);
        CAPTURE(poisson);
        const tissue::Material material = soft(poisson);
        const std::vector<double> depth_m{0.25 * radius_m, 0.5 * radius_m};
        const double side_rad = std::numbers::pi / kSides; // middle of a flat side
        const dvec3 out{std::cos(side_rad), std::sin(side_rad), 0.0};
        const dvec3 place_m = radius_m * out + dvec3{0.0, 0.0, 0.5 * kLength_m};
        const auto reference =
            sim::press_reference(full(radius_m, material), material, place_m, -out,
                                 {.radius_m = tip_m,
                                  .friction = infinite,
                                  .depth_m = depth_m,
                                  .edge_share = 0.8,
                                  .core_share = 1.0,
                                  .down_share = 0.0,
                                  .onto_skin = false});
        sim::TrainerTip tip(std::make_shared<tissue::BakedOrgan>(rod(radius_m, material)), material,
                            tip_m, infinite, tissue::Tier::corotated);
        const auto ours = tip.press(place_m, -out, depth_m);
        REQUIRE(reference.force_n.size() == depth_m.size());
        for (std::size_t i = 0; i < depth_m.size(); ++i) {
            CAPTURE(depth_m[i]);
            const double ours_n = glm::length(ours.force_n[i]),
                         reference_n = glm::length(reference.force_n[i]);
            MESSAGE("r ", radius_m, " tip ", tip_m, " nu ", poisson, " at ", depth_m[i], ": ",
                    ours_n / reference_n);
            CHECK(std::abs(ours_n / reference_n - 1.0) < 0.07); // what a hand tells apart
        }
    }
}
