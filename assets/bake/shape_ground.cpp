#include "assets/bake/shape_ground.h"

#include "assets/bake/shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bake {
namespace {

constexpr double kMm = 1e-3;
constexpr double kFadePerWave = 1.0; // bowl and noise begin over one wavelength
constexpr double kFineShare = 0.5;   // edges abreast of pits
constexpr int kRounds = 12;          // of the nearest point; five are enough for axes of 1 : 2

double smooth_step(double x) {
    const double t = std::clamp(x, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// Grid lines from low to high, closer together in the spans.
std::vector<double> lines_mm(double low, double high,
                             const std::vector<std::array<double, 2>>& spans, double edge_mm) {
    std::vector<double> at{low};
    while (at.back() < high) {
        const bool fine = std::any_of(spans.begin(), spans.end(), [&](const auto& s) {
            return at.back() >= s[0] && at.back() < s[1];
        });
        at.push_back(at.back() + (fine ? kFineShare : 1.0) * edge_mm);
    }
    const double fit = (high - low) / (at.back() - low);
    for (double& x : at) {
        x = low + fit * (x - low);
    }
    return at;
}

std::vector<double> lines_along(const GroundShape& shape, int axis, double edge_mm) {
    std::vector<std::array<double, 2>> spans;
    for (const Pit& pit : shape.pits) {
        spans.push_back(
            {pit.centre_mm[axis] - pit.radius_mm[axis], pit.centre_mm[axis] + pit.radius_mm[axis]});
    }
    const double half = 0.5 * shape.size_mm[axis];
    return lines_mm(shape.centre_mm[axis] - half, shape.centre_mm[axis] + half, spans, edge_mm);
}

} // namespace

double ellipse_distance(const glm::dvec2& p, const glm::dvec2& r) {
    // in the first quadrant, from the nearest point so far to the one that lies in the direction
    // of p on the circle of curvature there, and back onto the ellipse
    const glm::dvec2 q = glm::abs(p);
    glm::dvec2 t{std::numbers::sqrt2 / 2.0}; // cosine and sine of the parameter
    const double focal2 = r.x * r.x - r.y * r.y;
    for (int round = 0; round < kRounds; ++round) {
        const glm::dvec2 on = r * t;
        const glm::dvec2 middle{focal2 * t.x * t.x * t.x / r.x, -focal2 * t.y * t.y * t.y / r.y};
        const double away = glm::length(q - middle);
        if (away == 0.0) {
            break; // all of the circle is equally near
        }
        const glm::dvec2 next = middle + (q - middle) * (glm::length(on - middle) / away);
        t = glm::clamp(next / r, 0.0, 1.0);
        t /= glm::length(t);
    }
    const double distance = glm::length(q - r * t);
    return glm::length(q / r) < 1.0 ? -distance : distance;
}

double ground_height_mm(const GroundShape& shape, const glm::dvec2& place_mm) {
    double away = 1.0, depth_mm = 0.0;
    for (const Pit& pit : shape.pits) {
        const double d = ellipse_distance(place_mm - pit.centre_mm, pit.radius_mm);
        away = std::min(
            away, smooth_step((d - shape.flat_mm) / (kFadePerWave * shape.noise_wavelength_mm)));
        depth_mm = std::max(depth_mm, pit.depth_mm * smooth_step(-d / pit.wall_mm));
    }
    const glm::dvec2 from_middle = (place_mm - glm::dvec2{shape.centre_mm}) / (0.5 * shape.size_mm);
    const double bowl_mm = shape.bowl_mm * glm::dot(from_middle, from_middle);
    const double noise_mm =
        shape.noise_mm * smooth_noise({place_mm, 0.0}, shape.noise_wavelength_mm, shape.seed);
    return shape.centre_mm.z + away * (bowl_mm + noise_mm) - depth_mm;
}

Surface ground_surface(const GroundShape& shape, double edge_m) {
    const auto x_mm = lines_along(shape, 0, edge_m / kMm),
               y_mm = lines_along(shape, 1, edge_m / kMm);
    Surface surface;
    for (const double y : y_mm) {
        for (const double x : x_mm) {
            surface.point_m.push_back(kMm * glm::dvec3{x, y, ground_height_mm(shape, {x, y})});
        }
    }
    const auto across = static_cast<std::uint32_t>(x_mm.size());
    const auto length = [&](std::uint32_t i, std::uint32_t j) {
        return glm::length(surface.point_m[i] - surface.point_m[j]);
    };
    for (std::uint32_t j = 0; j + 1 < y_mm.size(); ++j) {
        for (std::uint32_t i = 0; i + 1 < across; ++i) {
            const std::uint32_t a = j * across + i, b = a + 1, c = b + across, d = a + across;
            if (length(a, c) <= length(b, d)) { // walls are followed best by the shorter diagonal
                surface.triangles.insert(surface.triangles.end(), {{a, b, c}, {a, c, d}});
            } else {
                surface.triangles.insert(surface.triangles.end(), {{a, b, d}, {b, c, d}});
            }
        }
    }
    return surface;
}

} // namespace bake
