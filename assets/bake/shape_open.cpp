// The shapes with a closed formula for their triangles: the vault and the box.
#include "assets/bake/shape.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace bake {
namespace {

/// Disc of `rings` rings of equal triangles, ring k of 6 k points; radius 1, angle in radians.
struct Disc {
    std::vector<std::array<double, 2>> polar;
    std::vector<tissue::Triangle> triangles; // counter-clockwise
};

Disc make_disc(int rings) {
    Disc disc;
    disc.polar.push_back({0.0, 0.0});
    const auto first = [](int k) { return k == 0 ? 0 : 1 + 3 * k * (k - 1); };
    const auto at = [&](int k, int i) {
        return static_cast<std::uint32_t>(k == 0 ? 0 : first(k) + i % (6 * k));
    };
    for (int k = 1; k <= rings; ++k) {
        for (int i = 0; i < 6 * k; ++i) {
            disc.polar.push_back(
                {static_cast<double>(k) / rings, 2.0 * std::numbers::pi * i / (6.0 * k)});
        }
        for (int side = 0; side < 6; ++side) {
            for (int i = 0; i < k; ++i) {
                const auto inner = at(k - 1, side * (k - 1) + i);
                const auto outer = at(k, side * k + i), next = at(k, side * k + i + 1);
                disc.triangles.push_back({inner, outer, next});
                if (i + 1 < k) {
                    disc.triangles.push_back({inner, next, at(k - 1, side * (k - 1) + i + 1)});
                }
            }
        }
    }
    return disc;
}

/// Adds the grid of one face, with `u x v` outwards; points are shared through `known`.
void add_face(const glm::dvec3& origin, const glm::dvec3& u, const glm::dvec3& v, int nu, int nv,
              std::map<std::array<std::int64_t, 3>, std::uint32_t>& known, Surface& out) {
    const auto point = [&](int i, int j) {
        const glm::dvec3 p =
            origin + u * (static_cast<double>(i) / nu) + v * (static_cast<double>(j) / nv);
        const std::array<std::int64_t, 3> key{std::llround(p.x * 1e9), std::llround(p.y * 1e9),
                                              std::llround(p.z * 1e9)};
        const auto [it, fresh] = known.emplace(key, static_cast<std::uint32_t>(out.point_m.size()));
        if (fresh) {
            out.point_m.push_back(p);
        }
        return it->second;
    };
    for (int j = 0; j < nv; ++j) {
        for (int i = 0; i < nu; ++i) {
            const auto a = point(i, j), b = point(i + 1, j), c = point(i + 1, j + 1),
                       d = point(i, j + 1);
            if ((i + j) % 2 == 0) { // diagonals alternate
                out.triangles.insert(out.triangles.end(), {{a, b, c}, {a, c, d}});
            } else {
                out.triangles.insert(out.triangles.end(), {{a, b, d}, {b, c, d}});
            }
        }
    }
}

std::array<int, 3> cells(const glm::dvec3& size_m, double edge_m) {
    std::array<int, 3> n{};
    for (int d = 0; d < 3; ++d) {
        n[d] = std::max(1, static_cast<int>(std::lround(size_m[d] / edge_m)));
    }
    return n;
}

} // namespace

Surface vault_surface(const VaultShape& shape, double edge_m) {
    const double opening = shape.opening_deg * std::numbers::pi / 180.0;
    const double reach_m =
        1e-3 * opening * std::max({shape.radius_mm.x, shape.radius_mm.y, shape.radius_mm.z});
    const Disc disc = make_disc(std::max(2, static_cast<int>(std::ceil(reach_m / edge_m))));

    Surface surface;
    surface.triangles = disc.triangles; // seen from +z, that is from inside
    for (const auto& [radius, angle] : disc.polar) {
        const double polar = radius * opening;
        const glm::dvec3 out{std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                             -std::cos(polar)};
        glm::dvec3 p = shape.centre_mm + out * shape.radius_mm;
        p -= out * (shape.noise_mm *
                    (smooth_noise(p, shape.noise_wavelength_mm, shape.seed) +
                     0.3 * smooth_noise(p, 0.4 * shape.noise_wavelength_mm, shape.seed + 1)));
        surface.point_m.push_back(1e-3 * p);
    }
    return surface;
}

Surface box_surface(const glm::dvec3& s, double edge_m) {
    const auto n = cells(s, edge_m);
    const glm::dvec3 x{s.x, 0, 0}, y{0, s.y, 0}, z{0, 0, s.z}, o{0.0};
    Surface out;
    std::map<std::array<std::int64_t, 3>, std::uint32_t> known;
    add_face(z, x, y, n[0], n[1], known, out);
    add_face(o, y, x, n[1], n[0], known, out);
    add_face(o, x, z, n[0], n[2], known, out);
    add_face(y, z, x, n[2], n[0], known, out);
    add_face(o, z, y, n[2], n[1], known, out);
    add_face(x, y, z, n[1], n[2], known, out);
    return out;
}

Surface box_top(const glm::dvec3& s, double edge_m) {
    const auto n = cells(s, edge_m);
    Surface out;
    std::map<std::array<std::int64_t, 3>, std::uint32_t> known;
    add_face({0, 0, s.z}, {s.x, 0, 0}, {0, s.y, 0}, n[0], n[1], known, out);
    return out;
}

} // namespace bake
