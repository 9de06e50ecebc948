#include "assets/bake/import/distance.h"

#include "assets/bake/nearest.h"

#include <algorithm>

namespace bake {

namespace {
constexpr std::size_t kMostTriangles = 100'000; // seven places each
} // namespace

Far farthest(const Surface& from, const Surface& to) {
    const NearestOnSurface nearest(to);
    const std::size_t step = from.triangles.size() / kMostTriangles + 1;
    Far far;
    for (std::size_t i = 0; i < from.triangles.size(); i += step) {
        const auto& t = from.triangles[i];
        const glm::dvec3 a = from.point_m[t[0]], b = from.point_m[t[1]], c = from.point_m[t[2]];
        for (const auto& p :
             {a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (a + b + c) / 3.0}) {
            const double distance_m = nearest(p).distance_m;
            if (distance_m > far.distance_m) {
                far = {distance_m, p};
            }
        }
    }
    return far;
}

Far hausdorff(const Surface& a, const Surface& b) {
    const Far there = farthest(a, b), back = farthest(b, a);
    return there.distance_m > back.distance_m ? there : back;
}

void add_far_places(const Surface& from, const Surface& to, double limit_m,
                    std::vector<glm::dvec3>& places) {
    const NearestOnSurface nearest(to);
    const std::size_t step = from.triangles.size() / kMostTriangles + 1;
    for (std::size_t i = 0; i < from.triangles.size(); i += step) {
        const auto& t = from.triangles[i];
        const glm::dvec3 corner = from.point_m[t[0]];
        const glm::dvec3 middle = (corner + from.point_m[t[1]] + from.point_m[t[2]]) / 3.0;
        for (const auto& p : {corner, middle}) {
            if (nearest(p).distance_m > limit_m &&
                std::none_of(places.begin(), places.end(), [&](const glm::dvec3& q) {
                    return glm::length(p - q) < 2.0 * limit_m;
                })) {
                places.push_back(p);
            }
        }
    }
}

} // namespace bake
