#include "assets/bake/import/clean.h"

#include "assets/bake/import/box_tree.h"
#include "assets/bake/import/holes.h"
#include "assets/bake/import/weld.h"

#include <algorithm>

namespace bake {
namespace {

constexpr double kSmallest_m = 5e-3, kLargest_m = 1.0; // of the longest side of all bodies
constexpr double kLooseShare = 0.01; // open scraps of less than this share of the area are dropped
constexpr double kAllHolesShare = 0.1;

void require_plausible_size(const Surface& s, const Notes& notes) {
    const Box box = box_of(s);
    const glm::dvec3 size = box.high - box.low;
    const double longest_m = std::max({size.x, size.y, size.z});
    if (longest_m >= kSmallest_m && longest_m <= kLargest_m) {
        return;
    }
    std::string fits;
    for (const auto& [name, m] :
         {std::pair{"mm", 1e-3}, std::pair{"cm", 1e-2}, std::pair{"m", 1.0}}) {
        const double would_m = longest_m / notes.unit.m * m;
        if (would_m >= kSmallest_m && would_m <= kLargest_m) {
            fits += fmt::format("{}--unit {} ({:.3g} mm long)", fits.empty() ? "" : " or ", name,
                                1e3 * would_m);
        }
    }
    throw ImportRefused(fmt::format(
        "--unit {}: the surface is {:.3g} m long, from {} to {}: accepted: 5 mm to 1 m{}",
        notes.unit.name, longest_m, notes.place(box.low), notes.place(box.high),
        fits.empty() ? "" : "; " + fits + " would fit"));
}

/// Fills what may be filled; true if anything was.
bool fill_holes(Surface& s, const Topology& topology, Notes& notes) {
    const double whole_m2 = area_m2(s);
    double filled_m2 = 0.0;
    std::size_t count = 0, largest = 0;
    const auto holes = find_holes(s, topology);
    for (std::size_t i = 0; i < holes.size(); ++i) {
        const Hole& hole = holes[i];
        if (hole.patch.empty() || hole.area_m2 > kHoleShare * whole_m2 ||
            filled_m2 + hole.area_m2 > kAllHolesShare * whole_m2) {
            continue;
        }
        largest = count++ == 0 ? i : largest;
        filled_m2 += hole.area_m2;
        s.triangles.insert(s.triangles.end(), hole.patch.begin(), hole.patch.end());
    }
    if (count > 0) {
        const Hole& hole = holes[largest];
        notes.repairs.push_back(fmt::format(
            "{} holes filled, {:.2g} % of the area; the largest, {} around, at {}", count,
            100.0 * filled_m2 / whole_m2, notes.length(hole.length_m), notes.place(hole.centre_m)));
    }
    return count > 0;
}

/// Large pieces that are still open are refused if their openings are; small ones are dropped.
void judge_open(const Surface& s, const Topology& topology, const std::vector<std::uint32_t>& piece,
                std::vector<std::int32_t>& part, std::size_t& parts, Notes& notes) {
    std::vector<double> area(part.size(), 0.0);
    std::vector<char> open(part.size(), 0);
    double whole_m2 = 0.0;
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        const auto& c = s.triangles[t];
        const glm::dvec3 a = s.point_m[c[0]];
        const double m2 = 0.5 * glm::length(glm::cross(s.point_m[c[1]] - a, s.point_m[c[2]] - a));
        area[piece[t]] += m2;
        whole_m2 += m2;
        for (std::size_t h = 3 * t; h < 3 * t + 3; ++h) {
            if (topology.twin[h] < 0) {
                open[piece[t]] = 1;
            }
        }
    }
    std::size_t dropped = 0, triangles = 0;
    std::vector<char> drop(part.size(), 0);
    for (std::size_t p = 0; p < part.size(); ++p) {
        drop[p] = open[p] && area[p] < kLooseShare * whole_m2 ? 1 : 0;
        dropped += drop[p] ? 1 : 0;
        part[p] = drop[p] ? -2 : open[p] ? -1 : static_cast<std::int32_t>(parts++);
    }
    if (dropped == part.size()) {
        throw ImportRefused(fmt::format("nothing of it is closed: {} open scraps, the first at {}: "
                                        "accepted: a closed surface",
                                        dropped, notes.place(s.point_m[s.triangles[0][0]])));
    }
    if (dropped > 0) {
        glm::dvec3 at{0.0};
        for (std::size_t t = 0; t < s.triangles.size(); ++t) {
            at = drop[piece[t]] && triangles++ == 0 ? s.point_m[s.triangles[t][0]] : at;
        }
        notes.repairs.push_back(
            fmt::format("{} open scraps ({} triangles) dropped, the first at {}", dropped,
                        triangles, notes.place(at)));
    }
    for (const Hole& hole : find_holes(s, topology)) {
        const std::size_t p = piece[hole.triangle];
        if (part[p] == -1 && hole.area_m2 > kHoleShare * area[p]) {
            throw ImportRefused(fmt::format(
                "it is open: a hole {} around, {:.3g} % of the surface, at {}: accepted: a closed "
                "surface; holes of up to {:.0f} % each are filled",
                notes.length(hole.length_m), 100.0 * hole.area_m2 / area[p],
                notes.place(hole.centre_m), 100.0 * kHoleShare));
        }
    }
}

} // namespace

Pieces clean(const Soup& soup, Notes& notes) {
    Surface s = weld_equal(soup, notes.unit.m);
    require_plausible_size(s, notes);
    drop_useless(s, notes);
    if (s.triangles.empty()) {
        throw ImportRefused("no triangle of it has an area: accepted: a closed surface");
    }
    close_seams(s, notes);

    Topology topology = make_manifold(s);
    const auto refuse_one_sided = [&] {
        if (topology.one_sided_at) {
            const auto corner = s.triangles[*topology.one_sided_at][0];
            throw ImportRefused(fmt::format("it has one side only, like a Moebius strip, found at "
                                            "{}: accepted: a surface with an inside",
                                            notes.place(s.point_m[corner])));
        }
    };
    refuse_one_sided();
    if (topology.turned > 0) {
        notes.repairs.push_back(fmt::format(
            "{} triangles turned over to agree with their neighbours", topology.turned));
    }
    if (topology.shared_edges > 0) {
        notes.repairs.push_back(
            fmt::format("{} edges of more than two triangles taken apart", topology.shared_edges));
    }
    if (topology.open_edges > 0 && fill_holes(s, topology, notes)) {
        topology = make_manifold(s);
        refuse_one_sided();
    }

    std::size_t count = 0, parts = 0;
    const auto piece = pieces(topology, count);
    std::vector<std::int32_t> part(count, 0);
    judge_open(s, topology, piece, part, parts, notes);
    Pieces result{.closed = split(s, piece, part, parts), .broken = {}};
    std::size_t open = 0;
    for (auto& p : part) { // the open ones, together
        p = p == -1 ? 0 : -1;
        open += p == 0 ? 1 : 0;
    }
    if (open > 0) {
        result.broken = split(s, piece, part, 1).front();
    }
    return result;
}

} // namespace bake
