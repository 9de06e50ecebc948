// assets/bake/shape_lobed.cpp
// Organs of ellipsoids melted into one, wrinkled by lobes: distance and its bounds.
#include "assets/bake/shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bake {
namespace {

constexpr double kMmPerM = 1e3;

/// First-order distance to an ellipsoid: exact on it, good near it.
double ellipsoid_mm(const Ellipsoid& e, const glm::dmat3& to_local, const glm::dvec3& p_mm) {
    const glm::dvec3 x = to_local * (p_mm - e.centre_mm);
    const double k0 = glm::length(x / e.radius_mm);
    const double k1 = glm::length(x / (e.radius_mm * e.radius_mm));
    const double smallest = std::min({e.radius_mm.x, e.radius_mm.y, e.radius_mm.z});
    return k1 > 0.0 ? k0 * (k0 - 1.0) / k1 : -smallest;
}

/// min(a, b) with the concave corner filled by a quadratic of width `blend`.
double smooth_min(double a, double b, double blend) {
    if (blend <= 0.0) {
        return std::min(a, b);
    }
    const double h = std::max(blend - std::abs(a - b), 0.0) / blend;
    return std::min(a, b) - 0.25 * h * h * blend;
}

/// max(a, b) with the sharp edge rounded: the zero surface stays where a or b is below -blend.
double round_max(double a, double b, double blend) {
    const double u = std::max(a + blend, 0.0), v = std::max(b + blend, 0.0);
    return std::min(-blend, std::max(a, b)) + std::hypot(u, v);
}

struct Part {
    Ellipsoid ellipsoid;
    glm::dmat3 to_local;
};

std::vector<Part> parts(const std::vector<Ellipsoid>& ellipsoids) {
    std::vector<Part> out;
    for (const auto& e : ellipsoids) {
        out.push_back({e, glm::transpose(turn(e.tilt_deg))});
    }
    return out;
}

} // namespace

glm::dmat3 turn(const glm::dvec3& tilt_deg) {
    const glm::dvec3 t = tilt_deg * (std::numbers::pi / 180.0);
    const double cx = std::cos(t.x), sx = std::sin(t.x), cy = std::cos(t.y), sy = std::sin(t.y),
                 cz = std::cos(t.z), sz = std::sin(t.z);
    const glm::dmat3 rx{{1, 0, 0}, {0, cx, sx}, {0, -sx, cx}}; // columns
    const glm::dmat3 ry{{cy, 0, -sy}, {0, 1, 0}, {sy, 0, cy}};
    const glm::dmat3 rz{{cz, sz, 0}, {-sz, cz, 0}, {0, 0, 1}};
    return rz * ry * rx;
}

Field lobed_field(const LobedShape& shape) {
    return
        [shape, lobes = parts(shape.lobes), hollows = parts(shape.hollows)](const glm::dvec3& p_m) {
            const glm::dvec3 p = kMmPerM * p_m;
            double d = 1e6;
            for (const auto& [e, to_local] : lobes) {
                d = smooth_min(d, ellipsoid_mm(e, to_local, p), e.blend_mm);
            }
            for (const auto& [e, to_local] : hollows) {
                d = round_max(d, -ellipsoid_mm(e, to_local, p), e.blend_mm);
            }
            if (shape.noise_mm > 0.0) {
                const double wave = shape.noise_wavelength_mm;
                d += shape.noise_mm * (smooth_noise(p, wave, shape.seed) +
                                       0.4 * smooth_noise(p, 0.45 * wave, shape.seed + 1));
            }
            return d / kMmPerM;
        };
}

std::array<glm::dvec3, 2> lobed_bounds_m(const LobedShape& shape) {
    glm::dvec3 low{1e9}, high{-1e9};
    double blend = 0.0;
    for (const auto& e : shape.lobes) {
        const glm::dmat3 m = turn(e.tilt_deg);
        glm::dvec3 reach{0.0}; // of a turned ellipsoid along the axes: norm of the scaled rows
        for (int d = 0; d < 3; ++d) {
            reach[d] = glm::length(glm::dvec3{m[0][d], m[1][d], m[2][d]} * e.radius_mm);
        }
        low = glm::min(low, e.centre_mm - reach);
        high = glm::max(high, e.centre_mm + reach);
        blend += 0.25 * e.blend_mm;
    }
    const double room = blend + 1.5 * shape.noise_mm + 5.0;
    return {(low - room) / kMmPerM, (high + room) / kMmPerM};
}

double smooth_noise(const glm::dvec3& p_mm, double wavelength_mm, std::uint64_t seed) {
    // value noise on a lattice of half a wavelength, quintic between the lattice points
    const glm::dvec3 x = p_mm / (0.5 * wavelength_mm);
    const glm::dvec3 base = glm::floor(x), f = x - base;
    const glm::dvec3 s = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    const auto lattice = [&](int i, int j, int k) {
        std::uint64_t h = seed * 0x9E3779B97F4A7C15ULL; // splitmix64 over the cell (Steele 2014)
        for (const double c : {base.x + i, base.y + j, base.z + k}) {
            h += 0x9E3779B97F4A7C15ULL +
                 static_cast<std::uint64_t>(static_cast<std::int64_t>(c)) * 0xD1B54A32D192ED03ULL;
            h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ULL;
            h = (h ^ (h >> 27)) * 0x94D049BB133111EBULL;
            h ^= h >> 31;
        }
        return static_cast<double>(h >> 11) * 0x1p-52 - 1.0;
    };
    double sum = 0.0;
    for (int c = 0; c < 8; ++c) {
        const int i = c & 1, j = c >> 1 & 1, k = c >> 2 & 1;
        sum += (i ? s.x : 1.0 - s.x) * (j ? s.y : 1.0 - s.y) * (k ? s.z : 1.0 - s.z) *
               lattice(i, j, k);
    }
    return sum;
}

} // namespace bake
