#include "haptics/rigid/penetration.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

namespace haptics {
namespace {

using glm::dvec3;

// Corners of a cone of directions: cutting a polygon adds at most one corner per cut.
constexpr std::size_t kMostRays = 2 * kMostAround + 2;
constexpr std::size_t kMostTied = 2 * kMostAround;
constexpr double kTiedShare = 8.0 * kFlatShare; // joined faces are flat to half of this
constexpr int kMostSteps = 200;                 // never reached: each step lowers the depth
constexpr std::size_t kFaceStarts = 32;         // per piece
constexpr std::size_t kWalks = 8;
constexpr std::size_t kMostPairs = 64; // of tied vertices looked at one by one

struct Rays {
    std::array<dvec3, kMostRays> at;
    std::size_t count = 0;
};

// Keeps the part of the cone with n . side >= 0.
void cut(Rays& rays, const dvec3& side, double slack) noexcept {
    Rays kept;
    for (std::size_t i = 0; i < rays.count && kept.count + 1 < kMostRays; ++i) {
        const dvec3& from = rays.at[i];
        const dvec3& to = rays.at[i + 1 == rays.count ? 0 : i + 1];
        const double p = glm::dot(from, side), q = glm::dot(to, side);
        if (p >= -slack)
            kept.at[kept.count++] = from;
        if ((p > slack && q < -slack) || (p < -slack && q > slack))
            kept.at[kept.count++] = glm::normalize((p * to - q * from) * (p > q ? 1.0 : -1.0));
    }
    rays.count = kept.count;
    std::copy_n(kept.at.begin(), kept.count, rays.at.begin());
}

// All vertices of the hull as far along n as v, as far as faces and edges at v lead to them; v is
// the first.
struct Tied {
    std::array<std::uint32_t, kMostTied> vertex;
    std::size_t count = 0;
    bool inner = false; // n is the normal of an inner face

    void add(std::uint32_t v) noexcept {
        if (count < kMostTied && std::find(vertex.begin(), vertex.begin() + count, v) ==
                                     vertex.begin() + static_cast<std::ptrdiff_t>(count))
            vertex[count++] = v;
    }
};

void find_tied(Tied& tied, const ConvexHull& hull, std::uint32_t v, const dvec3& n) noexcept {
    const double slack = kTiedShare * hull.radius_m;
    const auto neighbour = hull.neighbours(v);
    const auto face = hull.faces_round(v);
    tied.count = 0;
    tied.inner = false;
    tied.add(v);
    const auto level = [&](std::uint32_t u) {
        return glm::dot(n, hull.vertex_m[v] - hull.vertex_m[u]) <= slack;
    };
    bool here = level(neighbour[0]);
    for (std::size_t i = 0; i < neighbour.size(); ++i) {
        const std::size_t j = i + 1 == neighbour.size() ? 0 : i + 1;
        const bool there = level(neighbour[j]);
        if (here)
            tied.add(neighbour[i]);
        if (here && there) {
            tied.inner = tied.inner || hull.inner[face[i]] != 0;
            for (const std::uint32_t u : hull.corners(face[i]))
                tied.add(u);
        }
        here = there;
    }
}

class Walk {
  public:
    Walk(const ConvexHull& a, const ConvexHull& b, const RigidPose& b_in_a) noexcept
        : a_(a), b_(b), b_in_a_(b_in_a), to_b_(glm::transpose(b_in_a.rotation)) {
        for (const ConvexHull* hull : {&a, &b})
            any_inner_ = any_inner_ ||
                         std::find(hull->inner.begin(), hull->inner.end(), 1) != hull->inner.end();
    }

    /// Extreme vertices along a direction of a's frame.
    void support(const dvec3& n, std::uint32_t& va, std::uint32_t& vb) const noexcept {
        va = farthest_vertex(a_, n, va);
        vb = farthest_vertex(b_, to_b_ * -n, vb);
    }

    double depth(const dvec3& n, std::uint32_t va, std::uint32_t vb) const noexcept {
        return glm::dot(n, a_.vertex_m[va] - to_world(b_in_a_, b_.vertex_m[vb]));
    }

    /// Best corner of the directions in which both vertices are extreme, if better than `best`.
    bool look(std::uint32_t va, std::uint32_t vb, Penetration& best) noexcept {
        ++best.hubs;
        rays_.count = 0;
        for (const std::uint32_t f : a_.faces_round(va))
            rays_.at[rays_.count++] = a_.normal[f];
        const double slack = 1e-9 * b_.radius_m;
        for (const std::uint32_t u : b_.neighbours(vb)) {
            cut(rays_, b_in_a_.rotation * (b_.vertex_m[u] - b_.vertex_m[vb]), slack);
            if (rays_.count == 0)
                return false;
        }
        const dvec3 way_m = a_.vertex_m[va] - to_world(b_in_a_, b_.vertex_m[vb]);
        const double least_gain_m = 1e-12 * (a_.radius_m + b_.radius_m);
        bool better = false;
        for (std::size_t i = 0; i < rays_.count; ++i) {
            const double depth_m = glm::dot(rays_.at[i], way_m);
            if (best.found && depth_m >= best.depth_m - least_gain_m)
                continue;
            if (any_inner_ && at_inner_face(rays_.at[i], va, vb))
                continue;
            best.normal = rays_.at[i];
            best.depth_m = depth_m;
            best.vertex_a = va;
            best.vertex_b = vb;
            best.found = better = true;
        }
        return better;
    }

    Penetration run(const dvec3& start, std::uint32_t va, std::uint32_t vb) noexcept {
        Penetration best;
        best.normal = glm::normalize(start);
        support(best.normal, va, vb);
        best.vertex_a = va;
        best.vertex_b = vb;
        best.depth_m = depth(best.normal, va, vb);
        if (!look(va, vb, best) && !look_round(va, vb, best.normal, best))
            return best;
        for (int step = 0; step < kMostSteps; ++step) {
            if (!look_round(best.vertex_a, best.vertex_b, best.normal, best))
                break;
        }
        return best;
    }

  private:
    // All pairs of vertices extreme along n: those that share this corner of the overlay.
    bool look_round(std::uint32_t va, std::uint32_t vb, dvec3 n, Penetration& best) noexcept {
        find_tied(tied_a_, a_, va, n);
        find_tied(tied_b_, b_, vb, to_b_ * -n);
        if (tied_a_.count * tied_b_.count > kMostPairs)
            return look_beside(va, vb, n, best);
        bool better = false;
        for (std::size_t i = 0; i < tied_a_.count; ++i)
            for (std::size_t j = 0; j < tied_b_.count; ++j)
                if (i + j > 0 && look(tied_a_.vertex[i], tied_b_.vertex[j], best))
                    better = true;
        return better;
    }

    // Two faces of many corners on each other: of the pairs of their corners few have directions in
    // common but n itself. Those are met by leaning from n to where each corner points.
    bool look_beside(std::uint32_t va, std::uint32_t vb, const dvec3& n,
                     Penetration& best) noexcept {
        constexpr double kLean = 1e-3;
        bool better = false;
        for (std::size_t i = 0; i < tied_a_.count; ++i) {
            const std::uint32_t v = tied_a_.vertex[i];
            vb = farthest_vertex(b_, to_b_ * -(n + kLean * points_to(a_, v)), vb);
            better = look(v, vb, best) || better;
        }
        for (std::size_t i = 0; i < tied_b_.count; ++i) {
            const std::uint32_t v = tied_b_.vertex[i];
            const dvec3 lean = b_in_a_.rotation * points_to(b_, v);
            va = farthest_vertex(a_, n - kLean * lean, va);
            better = look(va, v, best) || better;
        }
        return better;
    }

    static dvec3 points_to(const ConvexHull& hull, std::uint32_t v) noexcept {
        dvec3 sum{0.0};
        for (const std::uint32_t f : hull.faces_round(v))
            sum += hull.normal[f];
        return sum;
    }

    bool at_inner_face(const dvec3& n, std::uint32_t va, std::uint32_t vb) noexcept {
        Tied tied;
        find_tied(tied, a_, va, n);
        if (tied.inner)
            return true;
        find_tied(tied, b_, vb, to_b_ * -n);
        return tied.inner;
    }

    const ConvexHull& a_;
    const ConvexHull& b_;
    const RigidPose& b_in_a_;
    glm::dmat3 to_b_;
    bool any_inner_ = false;
    Rays rays_;
    Tied tied_a_, tied_b_;
};

// The best few of many directions, best first.
struct Starts {
    std::array<dvec3, kWalks> direction;
    std::array<double, kWalks> depth_m;
    std::size_t count = 0;

    void offer(const dvec3& n, double depth) noexcept {
        std::size_t i = count;
        if (count == kWalks && depth >= depth_m[kWalks - 1])
            return;
        if (count < kWalks)
            ++count;
        else
            i = kWalks - 1;
        for (; i > 0 && depth_m[i - 1] > depth; --i) {
            depth_m[i] = depth_m[i - 1];
            direction[i] = direction[i - 1];
        }
        depth_m[i] = depth;
        direction[i] = n;
    }
};

dvec3 any_way(const dvec3& v) noexcept {
    return glm::dot(v, v) > 0.0 ? v : dvec3{0.0, 0.0, 1.0};
}

} // namespace

Penetration walk_penetration(const ConvexHull& a, const ConvexHull& b, const RigidPose& b_in_a,
                             const dvec3& start) noexcept {
    return Walk(a, b, b_in_a).run(any_way(start), 0, 0);
}

Penetration penetration(const ConvexHull& a, const ConvexHull& b,
                        const RigidPose& b_in_a) noexcept {
    Walk walk(a, b, b_in_a);
    Starts starts;
    std::uint32_t va = 0, vb = 0;
    const auto offer = [&](const dvec3& n) {
        walk.support(n, va, vb);
        starts.offer(n, walk.depth(n, va, vb));
    };
    for (std::size_t i = 0; i < std::min(kFaceStarts, a.normal.size()); ++i)
        offer(a.normal[i * a.normal.size() / std::min(kFaceStarts, a.normal.size())]);
    for (std::size_t i = 0; i < std::min(kFaceStarts, b.normal.size()); ++i)
        offer(-(b_in_a.rotation *
                b.normal[i * b.normal.size() / std::min(kFaceStarts, b.normal.size())]));
    Penetration best = walk.run(any_way(to_world(b_in_a, b.centre_m) - a.centre_m), va, vb);
    for (std::size_t i = 0; i < starts.count; ++i) {
        const Penetration other = walk.run(starts.direction[i], va, vb);
        const int hubs = best.hubs + other.hubs;
        if (other.found && (!best.found || other.depth_m < best.depth_m))
            best = other;
        best.hubs = hubs;
    }
    return best;
}

} // namespace haptics
