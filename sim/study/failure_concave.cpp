// sim/study/failure_concave.cpp
// F5, concave corners: two walls at 90 to 10 degrees, a cube corner, a fold and a pit of 1 degree.
// What is allowed is convex, so the right proxy is the nearest allowed point, and it moves no
// further than the device: both are exact. Penalty is right here: the nearest point of a convex
// set's surface is that point. Projecting on one plane after another is not; nor is holding on to
// a plane that pulls, as a god-object does in a blunt fold.
#include "sim/study/failure_bench.h"

#include "haptics/contact/plane_qp.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace sim::failure {
namespace {

constexpr double kSize_m = 0.03, kRadius_m = 1e-3, kWalk_m = 2e-3;
constexpr double kDegree = kPi / 180.0;

struct Corner {
    std::string name;
    Scene scene{};
    std::vector<dvec3> normal{}; // of the walls, through the origin, in the order of the quads
    double sine = 1.0;           // between walls: an error grows by 1 over it where they meet
    bool blunt = false;
};

Corner two_walls(double angle) {
    Corner c{.name = fmt::format("{:.0f} deg", angle / kDegree), .sine = std::sin(0.5 * angle)};
    const double s = kSize_m;
    const dvec3 up = s * dvec3{std::cos(angle), 0.0, std::sin(angle)};
    c.scene.quad({0, -s, 0}, {s, -s, 0}, {s, s, 0}, {0, s, 0});
    c.scene.quad({0, -s, 0}, {0, s, 0}, up + dvec3{0, s, 0}, up + dvec3{0, -s, 0});
    c.normal = {{0, 0, 1}, {std::sin(angle), 0.0, -std::cos(angle)}};
    return c;
}

Corner cube() {
    Corner c{.name = "cube corner"};
    const double s = kSize_m;
    c.scene.quad({0, 0, 0}, {s, 0, 0}, {s, s, 0}, {0, s, 0});
    c.scene.quad({0, 0, 0}, {0, s, 0}, {0, s, s}, {0, 0, s});
    c.scene.quad({0, 0, 0}, {0, 0, s}, {s, 0, s}, {s, 0, 0});
    c.normal = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    return c;
}

/// `walls` sides that rise from the origin by one degree: normals nearly parallel.
Corner pit(int walls) {
    Corner c{.name = walls == 2 ? "fold of 1 deg" : "pit of 1 deg", .blunt = true};
    const double tilt = walls == 2 ? 0.5 * kDegree : kDegree;
    const auto height_m = [&](const dvec3& p) {
        double z = 0.0;
        for (const dvec3& n : c.normal)
            z = std::max(z, -(n.x * p.x + n.y * p.y) / n.z);
        return z;
    };
    for (int k = 0; k < walls; ++k) {
        const double turn = 2.0 * kPi * k / walls;
        c.normal.push_back(
            {std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt)});
    }
    for (int k = 0; k < walls; ++k) { // the wall that faces `turn` lies on the other side
        const auto rim = [&](double aside) {
            const double turn = kPi * (2.0 * k / walls + 1.0) + aside * kPi / walls;
            dvec3 p = kSize_m * dvec3{std::cos(turn), std::sin(turn), 0.0};
            p.z = height_m(p);
            return p;
        };
        c.scene.quad({0, 0, 0}, rim(-1.0), rim(0.0), rim(1.0));
    }
    c.sine = std::sin(tilt);
    return c;
}

struct Walked {
    double off_m = 0.0;     // from the nearest allowed point
    double further_m = 0.0; // a step beyond the device's
};

/// A minute of random walk about the place where all walls hold the ball, `rest_m` off them.
template <class Place>
Walked walk(const Corner& corner, double rest_m, std::uint64_t seed, const Place& place_of) {
    std::vector<haptics::Plane> plane;
    dvec3 middle_m{0.0};
    for (const dvec3& n : corner.normal)
        plane.push_back({n, rest_m});
    for (const dvec3& n : corner.normal)
        middle_m += n;
    const dvec3 inwards = glm::normalize(middle_m);
    middle_m *= rest_m / glm::dot(middle_m, corner.normal[0]);
    Random random{std::mt19937_64(seed)};
    constexpr double kMemory_s = 1.0, keep = 1.0 - kTick_s / kMemory_s;
    const double kick_m = kWalk_m * std::sqrt(1.0 - keep * keep);
    Walked out;
    dvec3 offset_m = 4.0 * kWalk_m * inwards; // it begins in the open
    dvec3 device_before_m{0.0}, proxy_before_m{0.0};
    for (int i = 0; i < 60000; ++i) {
        offset_m =
            keep * offset_m + kick_m * dvec3{random.normal(), random.normal(), random.normal()};
        const dvec3 device_m = middle_m + offset_m, proxy_m = place_of(device_m);
        const dvec3 exact_m = haptics::nearest_in_planes(plane, device_m).place_m;
        out.off_m = std::max(out.off_m, glm::length(proxy_m - exact_m));
        if (i > 0)
            out.further_m = std::max(out.further_m, glm::length(proxy_m - proxy_before_m) -
                                                        glm::length(device_m - device_before_m));
        device_before_m = device_m;
        proxy_before_m = proxy_m;
    }
    return out;
}

/// How far off a wall the middle of a ball rests, pressed 2 mm: the radius and what a method keeps
/// beyond it so that rounding does not matter. It is part of the ball here.
double rest_m(const ContactMethod& method, Corner& corner) {
    Scene& scene = corner.scene;
    const auto [a, b, c] = scene.triangle[0];
    const dvec3 middle_m = (scene.vertex[a] + scene.vertex[b] + scene.vertex[c]) / 3.0;
    const dvec3 n = corner.normal[0];
    scene.state = {};
    for (int i = 0; i <= 50; ++i)
        scene.tick(method, middle_m + (scene.input.radius_m + 5e-4 - 5e-5 * i) * n);
    const double rests_m = glm::dot(n, scene.state.proxy_m);
    scene.state = {};
    return rests_m;
}

/// What rounding, a sweep and the hover may leave; a point's hover varies with its depth.
double gap_m(const Corner& corner, double radius_m, double hover_m) {
    const double least_m = 1e-5 * (radius_m > 0.0 ? radius_m : 5.0 * kWalk_m);
    return std::max(least_m, hover_m) / corner.sine;
}

const std::string kOff = ": off the nearest allowed point, m";
const std::string kFurther = ": steps longer than the device's, m";

} // namespace

void concave(const ContactMethod& method, std::uint64_t seed, Rows& rows) {
    for (Corner corner : {two_walls(90 * kDegree), two_walls(60 * kDegree), two_walls(30 * kDegree),
                          two_walls(10 * kDegree), cube(), pit(2), pit(3)}) {
        Scene& scene = corner.scene;
        scene.ready();
        scene.input.radius_m = ball_m(method, kRadius_m);
        const double rests_m = rest_m(method, corner);
        rows.at_most("F5", method.name, corner.name + ": rests off a wall beyond its radius, m",
                     rests_m - scene.input.radius_m, 1e-6, false);
        const Walked walked = walk(corner, rests_m, seed, [&](const dvec3& device_m) {
            const auto& state = scene.tick(method, device_m);
            return state.proxy_m;
        });
        const bool wrong = method.name == "god-object" && corner.blunt;
        const double bound_m = gap_m(corner, scene.input.radius_m, rests_m - scene.input.radius_m);
        rows.at_most("F5", method.name, corner.name + kOff, walked.off_m, bound_m, wrong);
        rows.at_most("F5", method.name, corner.name + kFurther, walked.further_m, 2.0 * bound_m,
                     wrong);
    }
}

void projections(std::uint64_t seed, Rows& rows) {
    for (const Corner& corner : {two_walls(60 * kDegree), two_walls(10 * kDegree), pit(3)}) {
        const Walked walked = walk(corner, 0.0, seed, [&](dvec3 p) {
            for (const dvec3& n : corner.normal)
                p -= std::min(0.0, glm::dot(n, p)) * n;
            return p;
        });
        rows.at_most("F5", "one plane after another", corner.name + kOff, walked.off_m,
                     gap_m(corner, 0.0, 0.0), true);
    }
}

} // namespace sim::failure
