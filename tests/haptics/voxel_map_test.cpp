#include "haptics/rigid/voxel_map.h"

#include "tests/haptics/rigid_scenes.h"

#include <doctest/doctest.h>
#include <stdexcept>

namespace {

using glm::dvec3;
using haptics::VoxelDistance;
using haptics::VoxelMap;

constexpr double kVoxel_m = 0.5e-3;

} // namespace

TEST_CASE("voxel map: at a plane face distance and normal are exact") {
    const VoxelMap map = haptics::make_voxel_map(cube_surface(0.01), kVoxel_m);
    RandomPieces random(80);
    for (int i = 0; i < 500; ++i) {
        // above and below the middle of the top
        const double z_m = random.number(-0.8e-3, 0.8e-3);
        const dvec3 p{random.number(-7e-3, 7e-3), random.number(-7e-3, 7e-3), 0.01 + z_m};
        const VoxelDistance d = haptics::distance_at(map, p);
        CHECK(std::abs(d.distance_m - z_m) < 1e-8); // distances are floats
        CHECK(degrees_between(d.gradient, {0, 0, 1}) < 0.01);
    }
}

TEST_CASE("voxel map: at a sphere the distance is off by no more than its bend in a voxel") {
    const double radius_m = 0.01;
    const VoxelMap map = haptics::make_voxel_map(sphere_surface(radius_m, 24), kVoxel_m);
    RandomPieces random(81);
    double worst_m = 0.0, worst_deg = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const dvec3 p = radius_m * random.number(0.6, 1.08) * glm::normalize(random.in_ball());
        const VoxelDistance d = haptics::distance_at(map, p);
        worst_m = std::max(worst_m, std::abs(d.distance_m - (glm::length(p) - radius_m)));
        worst_deg = std::max(worst_deg, degrees_between(d.gradient, p));
    }
    // trilinear: three axes of h^2 / 8 times the curvature 1 / (0.6 R); facets: e^2 / 8 R
    const double edge_m = radius_m * 1.5708 / 24 * 1.42;
    const double bound_m =
        3 * kVoxel_m * kVoxel_m / (8 * 0.6 * radius_m) + edge_m * edge_m / (8 * radius_m);
    MESSAGE("sphere: off by " << 1e6 * worst_m << " um (bound " << 1e6 * bound_m << ") and "
                              << worst_deg << " degrees");
    CHECK(worst_m < bound_m);
    CHECK(worst_deg < 8.0);
}

TEST_CASE("voxel map: every node has the distance and the side of the surface itself") {
    for (const haptics::RigidSurface& surface :
         {l_surface(), u_surface(), torus_surface(0.02, 0.006, 16, 10)}) {
        const VoxelMap map = haptics::make_voxel_map(surface, 2e-3);
        double worst_m = 0.0;
        for (std::uint32_t i = 0; i < map.distance_m.size(); i += 7) {
            const dvec3 p =
                map.first_m + map.voxel_m * dvec3{i % map.size[0], i / map.size[0] % map.size[1],
                                                  i / map.size[0] / map.size[1]};
            const double far_m = haptics::nearest_point(surface, p).distance_m;
            worst_m = std::max(worst_m, std::abs(std::abs(map.distance_m[i]) - far_m));
            if (far_m > 1e-7)
                CHECK((map.distance_m[i] < 0.0f) == (haptics::winding_number(surface, p) > 0.5));
        }
        CHECK(worst_m < 1e-4);
    }
}

TEST_CASE("voxel map: off the grid is far outside; what cannot be is refused") {
    const VoxelMap map = haptics::make_voxel_map(cube_surface(0.01), 2e-3);
    for (const dvec3 p : {dvec3{1, 0, 0}, dvec3{0, -1, 0}, dvec3{0, 0, std::nan("")}})
        CHECK(haptics::distance_at(map, p).distance_m > 1e100);
    CHECK_THROWS_AS(haptics::make_voxel_map(cube_surface(0.01), 0.0), std::invalid_argument);
    CHECK_THROWS_AS(haptics::make_voxel_map(cube_surface(0.01), 1e-5, 1 << 20),
                    std::invalid_argument);
    const std::vector<dvec3> vertex{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    CHECK_THROWS_AS(
        haptics::make_voxel_map(haptics::make_surface("leaf", vertex, Triangles{{0, 1, 2}}), 0.1),
        std::invalid_argument);
}
