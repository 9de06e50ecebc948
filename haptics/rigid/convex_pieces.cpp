#include "haptics/rigid/convex_pieces.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <stdexcept>

namespace haptics {
namespace {

using glm::dvec3;
using Patch = std::vector<std::uint32_t>; // triangles, in the order in which they joined

constexpr double kFlat = 1e-5;  // of the extent: this much out of plane is flat
constexpr double kNudge = 1e-3; // of a hull's size: samples lie so far inside, or outside
constexpr int kThinnings = 7;   // thickness, 1/2, ... 1/64 of it

class Cutter {
  public:
    Cutter(const RigidSurface& surface, double thickness_m)
        : s_(surface), thickness_m_(thickness_m), flat_m_(kFlat * surface.extent_m),
          taken_(surface.triangle.size(), false) {}

    std::vector<ConvexHull> run() {
        std::vector<ConvexHull> pieces;
        for (std::uint32_t seed = 0; seed < s_.triangle.size(); ++seed) {
            if (taken_[seed])
                continue;
            Patch patch = grown(seed);
            ConvexHull hull = cut_back(patch, pieces.size());
            for (const std::uint32_t t : patch)
                taken_[t] = true;
            mark_inner(hull);
            pieces.push_back(std::move(hull));
        }
        return pieces;
    }

  private:
    // Every vertex of each behind the planes of the other.
    bool convex_with(const Patch& patch, std::uint32_t t) const {
        const auto behind = [&](std::uint32_t vertices_of, std::uint32_t plane_of) {
            const dvec3 on_plane = s_.vertex_m[s_.triangle[plane_of][0]];
            return std::all_of(s_.triangle[vertices_of].begin(), s_.triangle[vertices_of].end(),
                               [&](std::uint32_t v) {
                                   return glm::dot(s_.normal[plane_of],
                                                   s_.vertex_m[v] - on_plane) <= flat_m_;
                               });
        };
        return std::all_of(patch.begin(), patch.end(), [&](std::uint32_t other) {
            return behind(t, other) && behind(other, t);
        });
    }

    // Breadth first, so that patches are round.
    Patch grown(std::uint32_t seed) const {
        std::vector<bool> seen = taken_;
        seen[seed] = true;
        Patch patch{seed};
        for (std::size_t i = 0; i < patch.size(); ++i) {
            for (const std::uint32_t next : s_.across[patch[i]]) {
                if (next == kRim || seen[next] || !convex_with(patch, next))
                    continue;
                seen[next] = true;
                patch.push_back(next);
            }
        }
        return patch;
    }

    std::vector<dvec3> points(std::span<const std::uint32_t> patch, double thickness_m) const {
        std::vector<dvec3> p;
        dvec3 outward{0.0};
        for (const std::uint32_t t : patch) {
            const auto [a, b, c] = s_.triangle[t];
            outward += glm::cross(s_.vertex_m[b] - s_.vertex_m[a], s_.vertex_m[c] - s_.vertex_m[a]);
            p.insert(p.end(), {s_.vertex_m[a], s_.vertex_m[b], s_.vertex_m[c]});
        }
        if (!(glm::length(outward) > flat_m_ * flat_m_)) // closed: thick enough
            return p;
        outward = glm::normalize(outward);
        double low_m = glm::dot(outward, p[0]), high_m = low_m;
        for (const dvec3& q : p) {
            low_m = std::min(low_m, glm::dot(outward, q));
            high_m = std::max(high_m, glm::dot(outward, q));
        }
        if (high_m - low_m < thickness_m)
            for (std::size_t i = 0, n = p.size(); i < n; ++i)
                p.push_back(p[i] - thickness_m * outward);
        return p;
    }

    // Inside, or for an open surface clearly behind what is nearest.
    bool in_solid(const dvec3& place_m) const {
        if (s_.closed)
            return winding_number(s_, place_m) > 0.5;
        const NearestPoint q = nearest_point(s_, place_m);
        return glm::dot(place_m - q.place_m, s_.normal[q.triangle]) < -0.1 * q.distance_m;
    }

    // Whether a face of the hull is nothing but triangles of the patch.
    bool own(const ConvexHull& hull, std::size_t face, std::span<const std::uint32_t> patch) const {
        const auto corner = hull.corners(face);
        const auto twice_area = [](const dvec3& a, const dvec3& b, const dvec3& c) {
            return glm::length(glm::cross(b - a, c - a));
        };
        double wanted = 0.0, covered = 0.0;
        for (std::size_t i = 2; i < corner.size(); ++i)
            wanted += twice_area(hull.vertex_m[corner[0]], hull.vertex_m[corner[i - 1]],
                                 hull.vertex_m[corner[i]]);
        for (const std::uint32_t t : patch) {
            const auto [a, b, c] = s_.triangle[t];
            const auto level = [&](std::uint32_t v) {
                return glm::dot(hull.normal[face], s_.vertex_m[v]) >= hull.offset_m[face] - flat_m_;
            };
            if (level(a) && level(b) && level(c) &&
                glm::dot(hull.normal[face], s_.normal[t]) > 0.99)
                covered += twice_area(s_.vertex_m[a], s_.vertex_m[b], s_.vertex_m[c]);
        }
        return covered > (1.0 - kNudge) * wanted;
    }

    bool stays_inside(const ConvexHull& hull, std::span<const std::uint32_t> patch) const {
        for (std::size_t f = 0; f < hull.normal.size(); ++f)
            if (!own(hull, f, patch) && !face_inside(hull, f))
                return false;
        return true;
    }

    bool face_inside(const ConvexHull& hull, std::size_t face) const {
        const auto inside = [&](const dvec3& on_hull) {
            return in_solid(on_hull + kNudge * (hull.centre_m - on_hull));
        };
        const auto corner = hull.corners(face);
        dvec3 middle{0.0};
        for (const std::uint32_t v : corner)
            middle += hull.vertex_m[v] / static_cast<double>(corner.size());
        if (!inside(middle))
            return false;
        for (std::size_t i = 0; i < corner.size(); ++i) {
            const dvec3 a = hull.vertex_m[corner[i]];
            const dvec3 b = hull.vertex_m[corner[(i + 1) % corner.size()]];
            for (const double share : {0.25, 0.5, 0.75})
                if (!inside(a + share * (b - a)))
                    return false;
            if (!inside(0.5 * (middle + a)) || !inside((middle + a + b) / 3.0))
                return false;
        }
        return true;
    }

    std::optional<ConvexHull> fits(std::span<const std::uint32_t> patch, double thickness_m,
                                   const std::string& name) const {
        ConvexHull hull = convex_hull(points(patch, thickness_m), name);
        return stays_inside(hull, patch) ? std::optional(std::move(hull)) : std::nullopt;
    }

    // The longest start of the patch whose hull stays in the solid, by halving.
    ConvexHull cut_back(Patch& patch, std::size_t number) const {
        const std::string name = s_.name + ", piece " + std::to_string(number);
        if (auto whole = fits(patch, thickness_m_, name))
            return *std::move(whole);
        std::size_t good = 0, bad = patch.size();
        std::optional<ConvexHull> best;
        while (good + 1 < bad) {
            const std::size_t middle = (good + bad) / 2;
            if (auto hull = fits(std::span(patch).first(middle), thickness_m_, name)) {
                best = std::move(hull);
                good = middle;
            } else {
                bad = middle;
            }
        }
        if (best) {
            patch.resize(good);
            return *std::move(best);
        }
        patch.resize(1); // a triangle is covered in any case
        double thickness_m = thickness_m_;
        for (int i = 1; i < kThinnings; ++i) {
            thickness_m *= 0.5;
            if (auto hull = fits(patch, thickness_m, name))
                return *std::move(hull);
        }
        return convex_hull(points(patch, thickness_m), name);
    }

    void mark_inner(ConvexHull& hull) const {
        const double nudge_m = kNudge * hull.radius_m;
        for (std::size_t f = 0; f < hull.normal.size(); ++f) {
            dvec3 middle{0.0};
            for (const std::uint32_t v : hull.corners(f))
                middle += hull.vertex_m[v] / static_cast<double>(hull.corners(f).size());
            const dvec3 beyond_m = middle + nudge_m * hull.normal[f];
            bool inner = in_solid(beyond_m);
            if (inner && !s_.closed) { // in the shell of a neighbour: straight below its triangle
                const NearestPoint q = nearest_point(s_, beyond_m);
                const double below_m = glm::dot(q.place_m - beyond_m, s_.normal[q.triangle]);
                const double aside_m =
                    std::sqrt(std::max(0.0, q.distance_m * q.distance_m - below_m * below_m));
                inner = below_m < thickness_m_ * (1.0 - kNudge) && aside_m < 0.5 * nudge_m;
            }
            hull.inner[f] = inner;
        }
    }

    const RigidSurface& s_;
    double thickness_m_, flat_m_;
    std::vector<bool> taken_;
};

} // namespace

std::vector<ConvexHull> convex_pieces(const RigidSurface& surface, double thickness_m) {
    if (!(thickness_m > 0.0))
        throw std::invalid_argument("convex pieces: thickness of " + surface.name +
                                    " must be above 0");
    return Cutter(surface, thickness_m).run();
}

} // namespace haptics
