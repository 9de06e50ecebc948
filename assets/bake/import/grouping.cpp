#include "assets/bake/import/grouping.h"

#include "assets/bake/import/box_tree.h"
#include "assets/bake/import/crossing.h"
#include "assets/bake/import/distance.h"
#include "assets/bake/import/resample.h"
#include "assets/bake/import/topology.h"
#include "assets/bake/import/winding.h"
#include "assets/bake/nearest.h"
#include "assets/bake/remesh.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace bake {
namespace {

constexpr double kCellPerEdge = 1.0 / 6.0; // of sampling
constexpr std::size_t kMostCrossings = 20'000;
constexpr std::size_t kMostChecked = 1'000'000; // triangles; larger bodies are coarsened first
constexpr double kCoarseAway = 0.5;             // of the edge it is coarsened to
constexpr double kOverlapShare = 1e-3;          // of the smaller diagonal; below it they touch

double diagonal_m(const Surface& s) {
    const Box box = box_of(s);
    return glm::length(box.high - box.low);
}

/// How deep places of triangle `t` of `a` lie inside `b`.
double depth_m(const Surface& a, std::uint32_t t, const Surface& b, const NearestOnSurface& near) {
    const auto& c = a.triangles[t];
    const glm::dvec3 p = a.point_m[c[0]], q = a.point_m[c[1]], r = a.point_m[c[2]];
    double deepest_m = 0.0;
    for (const auto& x :
         {p, q, r, 0.5 * (p + q), 0.5 * (q + r), 0.5 * (r + p), (p + q + r) / 3.0}) {
        const double m = near(x).distance_m;
        if (m > deepest_m && winding_number(b, x) > 0.5) {
            deepest_m = m;
        }
    }
    return deepest_m;
}

struct Contacts {
    std::vector<std::vector<Crossing>> own; // of each body with itself
    std::map<std::pair<std::size_t, std::size_t>, std::vector<Crossing>> mutual; // local triangles
};

Contacts find_contacts(const std::vector<Body>& bodies) {
    std::vector<const Surface*> parts;
    std::vector<std::uint32_t> first;
    std::uint32_t count = 0;
    for (const auto& b : bodies) {
        parts.push_back(&b.surface);
        first.push_back(count);
        count += static_cast<std::uint32_t>(b.surface.triangles.size());
    }
    const auto body_of = [&](std::uint32_t t) {
        return static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), t) -
                                        first.begin() - 1);
    };
    Contacts contacts;
    contacts.own.resize(bodies.size());
    for (Crossing c : find_crossings(joined(parts), kMostCrossings)) {
        const std::size_t i = body_of(c.a), j = body_of(c.b);
        c.a -= first[i];
        c.b -= first[j];
        if (i == j) {
            contacts.own[i].push_back(c);
        } else {
            contacts.mutual[{i, j}].push_back(c);
        }
    }
    return contacts;
}

bool overlap(const Body& a, const Body& b, const std::vector<Crossing>& where) {
    const double limit_m = kOverlapShare * std::min(diagonal_m(a.surface), diagonal_m(b.surface));
    const NearestOnSurface near_a(a.surface), near_b(b.surface);
    const std::size_t step = where.size() / 300 + 1;
    for (std::size_t i = 0; i < where.size(); i += step) {
        if (depth_m(a.surface, where[i].a, b.surface, near_b) > limit_m ||
            depth_m(b.surface, where[i].b, a.surface, near_a) > limit_m) {
            return true;
        }
    }
    return false;
}

/// Number of the group of every body: those that overlap are one.
std::vector<std::size_t> group_overlapping(const std::vector<Body>& bodies,
                                           const Contacts& contacts, Notes& notes) {
    std::vector<std::size_t> group(bodies.size());
    std::iota(group.begin(), group.end(), std::size_t{0});
    for (const auto& [pair, where] : contacts.mutual) {
        const auto [i, j] = pair;
        if (overlap(bodies[i], bodies[j], where)) {
            const std::size_t from = group[j], to = group[i];
            std::replace(group.begin(), group.end(), std::max(from, to), std::min(from, to));
            notes.repairs.push_back(fmt::format("bodies {} and {} overlap at {}: joined to one",
                                                i + 1, j + 1, notes.place(where[0].at_m)));
        } else {
            notes.problems.push_back(fmt::format("bodies {} and {} touch at {}: kept apart", i + 1,
                                                 j + 1, notes.place(where[0].at_m)));
        }
    }
    return group;
}

/// Triangles of `seen` to the bodies they are nearest to.
void share_out(const Surface& seen, std::vector<GivenBody>& bodies) {
    if (bodies.size() == 1) {
        bodies[0].seen = seen;
        return;
    }
    std::vector<NearestOnSurface> nearest;
    nearest.reserve(bodies.size());
    for (auto& b : bodies) {
        b.seen.point_m = seen.point_m;
        nearest.emplace_back(b.body.surface);
    }
    for (const auto& t : seen.triangles) {
        const glm::dvec3 middle =
            (seen.point_m[t[0]] + seen.point_m[t[1]] + seen.point_m[t[2]]) / 3.0;
        std::size_t best = 0;
        double least_m = std::numeric_limits<double>::max();
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            const double m = nearest[i](middle).distance_m;
            if (m < least_m) {
                least_m = m;
                best = i;
            }
        }
        bodies[best].seen.triangles.push_back(t);
    }
}

/// New surfaces for what is inside `given`.
std::vector<GivenBody> sample_anew(const Surface& given, double edge_m, Notes& notes) {
    const double cell_m = kCellPerEdge * edge_m;
    Resampled sampled;
    try {
        sampled = resample(given, cell_m);
    } catch (const std::invalid_argument&) {
        throw ImportRefused(fmt::format("nothing is inside it, around {}: accepted: a surface with "
                                        "an inside",
                                        notes.place(given.point_m[given.triangles[0][0]])));
    }
    notes.repairs.push_back(
        fmt::format("its inside sampled in cells of {} and given a new surface; {:.2g} % of the "
                    "area given lies within the body and is gone",
                    notes.length(cell_m), 100.0 * sampled.hidden_share));
    if (sampled.seen.triangles.empty()) {
        throw ImportRefused("none of its triangles has an inside on one side and an outside on the "
                            "other: accepted: a surface around a body");
    }
    Topology topology = make_manifold(sampled.surface);
    std::size_t count = 0;
    const auto piece = pieces(topology, count);
    std::vector<std::int32_t> part(count);
    std::iota(part.begin(), part.end(), 0);
    std::vector<GivenBody> bodies;
    for (auto& b : make_bodies(split(sampled.surface, piece, part, count), notes)) {
        bodies.push_back({std::move(b), {}});
    }
    share_out(sampled.seen, bodies);
    for (const auto& b : bodies) {
        const Far far = farthest(b.seen, b.body.surface);
        if (far.distance_m > 0.5 * edge_m) {
            throw ImportRefused(fmt::format(
                "repair by sampling loses what is at {}, {} away: accepted: half an edge, {}; a "
                "surface that does not cross itself, or a smaller --edge",
                notes.place(far.at_m), notes.length(far.distance_m), notes.length(0.5 * edge_m)));
        }
    }
    return bodies;
}

/// Coarser by steps, so that no thin part is lost and no triangles get across each other that were
/// not before, if possible.
Surface coarsen_cleanly(const Surface& given, double edge_m) {
    Surface coarse;
    for (const double share : {1.0, 0.6, 0.3}) {
        coarse = coarsen(given, share * edge_m);
        if (farthest(given, coarse).distance_m < kCoarseAway * edge_m &&
            find_crossings(coarse, 1).empty()) {
            break;
        }
    }
    return coarse;
}

} // namespace

std::vector<GivenBody> separate_bodies(Pieces given, double edge_m, Notes& notes,
                                       PhaseClock& clock) {
    std::vector<Body> bodies;
    if (!given.closed.empty()) {
        bodies = make_bodies(std::move(given.closed), notes);
    }
    std::vector<Surface> seen;
    for (auto& b : bodies) {
        seen.push_back(b.surface);
        if (b.surface.triangles.size() > kMostChecked) {
            clock.begin("coarsening");
            b.surface = coarsen_cleanly(b.surface, kCellPerEdge * edge_m);
        }
    }
    clock.begin("intersections");
    const Contacts contacts = find_contacts(bodies);
    const auto group = group_overlapping(bodies, contacts, notes);

    std::vector<GivenBody> result;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (group[i] != i) {
            continue;
        }
        std::vector<const Surface*> members;
        std::string crossing;
        for (std::size_t j = i; j < bodies.size(); ++j) {
            if (group[j] == i) {
                members.push_back(&bodies[j].surface);
                const auto own = describe(contacts.own[j], edge_m, notes);
                crossing += crossing.empty() ? own : "";
            }
        }
        if (!crossing.empty()) {
            notes.repairs.push_back(crossing);
        }
        if (members.size() == 1 && crossing.empty()) {
            result.push_back({std::move(bodies[i]), std::move(seen[i])});
            continue;
        }
        clock.begin("sampling");
        for (auto& b : sample_anew(joined(members), edge_m, notes)) {
            result.push_back(std::move(b));
        }
    }
    if (!given.broken.triangles.empty()) {
        clock.begin("sampling");
        notes.repairs.push_back(fmt::format("{} triangles do not fit together, around {}",
                                            given.broken.triangles.size(),
                                            notes.place(given.broken.point_m[0])));
        for (auto& b : sample_anew(given.broken, edge_m, notes)) {
            result.push_back(std::move(b));
        }
    }
    std::stable_sort(result.begin(), result.end(), [](const GivenBody& a, const GivenBody& b) {
        return a.body.volume_m3 > b.body.volume_m3;
    });
    return result;
}

} // namespace bake
