// sim/view/open_sky.cpp
#include "sim/view/open_sky.h"

#include <algorithm>
#include <numbers>

#include <glm/geometric.hpp>

namespace view {
namespace {

struct Disc {
    glm::vec3 place_m, normal;
    float area_m2;
};

float area_m2(const SurfaceView& surface) {
    float sum = 0.0F;
    for (const auto& t : surface.triangles) {
        const glm::vec3& a = surface.rest_m[t[0]];
        sum += 0.5F * glm::length(glm::cross(surface.rest_m[t[1]] - a, surface.rest_m[t[2]] - a));
    }
    return sum;
}

/// At most this many discs per surface: 1 cm wide on a liver, finer than the shadows matter.
std::vector<Disc> discs(std::span<const SurfaceView> surfaces) {
    constexpr std::size_t kMost = 700;
    std::vector<Disc> all;
    for (const SurfaceView& s : surfaces) {
        const std::size_t n = std::min(s.rest_m.size(), s.normal.size());
        const std::size_t stride = n / kMost + 1;
        const float each_m2 = area_m2(s) / static_cast<float>(std::max<std::size_t>(1, n / stride));
        for (std::size_t i = 0; i < n; i += stride)
            all.push_back({s.rest_m[i], s.normal[i], each_m2});
    }
    return all;
}

} // namespace

std::vector<float> open_sky(std::span<const SurfaceView> surfaces, std::size_t index) {
    const SurfaceView& to = surfaces[index];
    const std::vector<Disc> all = discs(surfaces);
    std::vector<float> open(to.rest_m.size(), 1.0F);
    for (std::size_t i = 0; i < std::min(open.size(), to.normal.size()); ++i) {
        float hidden = 0.0F;
        for (const Disc& disc : all) {
            const glm::vec3 w = disc.place_m - to.rest_m[i];
            const float here = glm::dot(w, to.normal[i]), there = -glm::dot(w, disc.normal);
            if (here <= 0.0F || there <= 0.0F)
                continue; // below the horizon, or seen from its back
            const float d2 = glm::dot(w, w);
            hidden += disc.area_m2 * here * there /
                      (d2 * (std::numbers::pi_v<float> * d2 + disc.area_m2));
        }
        open[i] = std::clamp(1.0F - hidden, 0.0F, 1.0F);
    }
    return open;
}

} // namespace view
