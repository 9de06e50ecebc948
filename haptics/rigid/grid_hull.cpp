#include "haptics/rigid/grid_hull.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace haptics {
namespace {

__extension__ using Wide = __int128;
using Vector = std::array<double, 3>;

struct Facet {
    GridTriangle corner;
    std::array<std::uint32_t, 3> across{}; // facet beyond the edge corner[i], corner[i + 1]
    double twice_area = 0.0;
    std::vector<std::uint32_t> outside{}; // points this facet sees
    bool alive = true;
};

Vector minus(const GridPoint& a, const GridPoint& b) {
    return {double(a[0] - b[0]), double(a[1] - b[1]), double(a[2] - b[2])};
}

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double length(const Vector& a) {
    return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

// Six times the volume of a, b, c, p: positive if p is on the outer side. Exact.
Wide volume(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& p) {
    const auto d = [&](const GridPoint& q, int i) { return Wide(q[i] - a[i]); };
    return (d(b, 1) * d(c, 2) - d(b, 2) * d(c, 1)) * d(p, 0) +
           (d(b, 2) * d(c, 0) - d(b, 0) * d(c, 2)) * d(p, 1) +
           (d(b, 0) * d(c, 1) - d(b, 1) * d(c, 0)) * d(p, 2);
}

class Builder {
  public:
    Builder(std::span<const GridPoint> point, double tolerance)
        : point_(point), tolerance_(tolerance) {}

    std::vector<GridTriangle> run() {
        if (!start())
            return {};
        // facets are only appended: those without points are passed once
        for (std::uint32_t f = 0; f < facet_.size(); ++f) {
            if (facet_[f].alive && !facet_[f].outside.empty())
                insert(f);
        }
        std::vector<GridTriangle> result;
        for (const Facet& facet : facet_)
            if (facet.alive)
                result.push_back(facet.corner);
        return result;
    }

  private:
    template <class Measure> std::uint32_t farthest(const Measure& measure) const {
        std::uint32_t best = 0;
        for (std::uint32_t i = 1; i < point_.size(); ++i)
            if (measure(point_[i]) > measure(point_[best]))
                best = i;
        return best;
    }

    double height(const Facet& facet, std::uint32_t p) const {
        const auto [a, b, c] = facet.corner;
        return static_cast<double>(volume(point_[a], point_[b], point_[c], point_[p])) /
               facet.twice_area;
    }

    bool sees(std::uint32_t p, const Facet& facet) const {
        const auto [a, b, c] = facet.corner;
        return volume(point_[a], point_[b], point_[c], point_[p]) > 0;
    }

    std::uint32_t add(const GridTriangle& corner) {
        const Vector ab = minus(point_[corner[1]], point_[corner[0]]);
        const Vector ac = minus(point_[corner[2]], point_[corner[0]]);
        facet_.push_back({.corner = corner, .twice_area = length(cross(ab, ac))});
        return static_cast<std::uint32_t>(facet_.size() - 1);
    }

    // Gives each point to the facet that it is highest above.
    void hand_out(std::span<const std::uint32_t> points, std::uint32_t first_facet) {
        for (const std::uint32_t p : points) {
            double most = tolerance_;
            Facet* owner = nullptr;
            for (std::size_t f = first_facet; f < facet_.size(); ++f) {
                const double h = height(facet_[f], p);
                if (h > most) {
                    most = h;
                    owner = &facet_[f];
                }
            }
            if (owner)
                owner->outside.push_back(p);
        }
    }

    // A tetrahedron of far points; false if there is none thicker than the tolerance.
    bool start() {
        const std::uint32_t a = farthest([](const GridPoint& p) { return double(-p[0]); });
        const auto from_a = [&](const GridPoint& p) { return length(minus(p, point_[a])); };
        const std::uint32_t b = farthest(from_a);
        const Vector ab = minus(point_[b], point_[a]);
        const auto from_line = [&](const GridPoint& p) {
            return length(cross(ab, minus(p, point_[a])));
        };
        std::uint32_t c = farthest(from_line);
        if (from_line(point_[c]) <= tolerance_ * length(ab))
            return false;
        const double twice = from_line(point_[c]);
        const auto from_plane = [&](const GridPoint& p) {
            return std::abs(static_cast<double>(volume(point_[a], point_[b], point_[c], p)));
        };
        const std::uint32_t d = farthest(from_plane);
        if (from_plane(point_[d]) <= tolerance_ * twice)
            return false;
        std::uint32_t base = b;
        if (volume(point_[a], point_[b], point_[c], point_[d]) > 0)
            std::swap(base, c);
        add({a, base, c});
        add({a, c, d});
        add({c, base, d});
        add({base, a, d});
        facet_[0].across = {3, 2, 1};
        facet_[1].across = {0, 2, 3};
        facet_[2].across = {0, 3, 1};
        facet_[3].across = {0, 1, 2};
        std::vector<std::uint32_t> all(point_.size());
        for (std::uint32_t i = 0; i < all.size(); ++i)
            all[i] = i;
        hand_out(all, 0);
        return true;
    }

    // Replaces the facets seen from the highest point above facet f by a fan to their outline.
    void insert(std::uint32_t f) {
        std::uint32_t top = facet_[f].outside.front();
        for (const std::uint32_t p : facet_[f].outside)
            if (height(facet_[f], p) > height(facet_[f], top))
                top = p;
        std::vector<std::uint32_t> seen{f}, homeless;
        facet_[f].alive = false;
        std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> outline; // from: to, facet
        for (std::size_t i = 0; i < seen.size(); ++i) {
            const Facet at = facet_[seen[i]];
            homeless.insert(homeless.end(), at.outside.begin(), at.outside.end());
            for (std::uint32_t e = 0; e < 3; ++e) {
                Facet& next = facet_[at.across[e]];
                if (next.alive && sees(top, next)) {
                    next.alive = false;
                    seen.push_back(at.across[e]);
                } else if (next.alive) {
                    outline[at.corner[e]] = {at.corner[(e + 1) % 3], at.across[e]};
                }
            }
        }
        const auto first = static_cast<std::uint32_t>(facet_.size());
        fan(outline, top);
        hand_out(homeless, first);
    }

    void fan(const std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>>& outline,
             std::uint32_t top) {
        const auto first = static_cast<std::uint32_t>(facet_.size());
        const auto count = static_cast<std::uint32_t>(outline.size());
        std::uint32_t from = outline.begin()->first;
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto [to, beyond] = outline.at(from);
            const std::uint32_t made = add({from, to, top});
            facet_[made].across = {beyond, first + (i + 1) % count,
                                   first + (i + count - 1) % count};
            for (std::uint32_t e = 0; e < 3; ++e)
                if (facet_[beyond].corner[(e + 1) % 3] == from && facet_[beyond].corner[e] == to)
                    facet_[beyond].across[e] = made;
            from = to;
        }
    }

    std::span<const GridPoint> point_;
    double tolerance_;
    std::vector<Facet> facet_;
};

} // namespace

std::vector<GridTriangle> grid_hull(std::span<const GridPoint> point, double tolerance) {
    return point.size() < 4 ? std::vector<GridTriangle>{} : Builder(point, tolerance).run();
}

} // namespace haptics
