#include "assets/bake/import/bodies.h"

#include "assets/bake/import/box_tree.h"
#include "assets/bake/import/topology.h"
#include "assets/bake/import/winding.h"

#include <algorithm>
#include <cmath>

namespace bake {
namespace {

struct Shell {
    Surface surface;
    Box box;
    double volume_m3 = 0.0; // positive after turning
    int depth = 0;          // in how many others it lies
    std::size_t inside = 0; // the smallest of them
};

void turn_over(Surface& s) {
    for (auto& t : s.triangles) {
        std::swap(t[1], t[2]);
    }
}

bool holds(const Shell& outer, const Shell& inner) {
    for (int d = 0; d < 3; ++d) {
        if (inner.box.low[d] < outer.box.low[d] || inner.box.high[d] > outer.box.high[d]) {
            return false;
        }
    }
    // shells may touch: most of a few places decide
    constexpr std::size_t kPlaces = 9;
    std::size_t in = 0;
    for (std::size_t i = 0; i < kPlaces; ++i) {
        const auto& t = inner.surface.triangles[i * inner.surface.triangles.size() / kPlaces];
        const auto& x = inner.surface.point_m;
        in += winding_number(outer.surface, (x[t[0]] + x[t[1]] + x[t[2]]) / 3.0) > 0.5 ? 1 : 0;
    }
    return 2 * in > kPlaces;
}

/// A place just below the largest triangle of a shell that faces outwards.
glm::dvec3 place_inside(const Surface& s) {
    double largest = 0.0;
    glm::dvec3 place{0.0};
    for (const auto& t : s.triangles) {
        const glm::dvec3 a = s.point_m[t[0]];
        const glm::dvec3 n = glm::cross(s.point_m[t[1]] - a, s.point_m[t[2]] - a);
        if (glm::length(n) > largest) {
            largest = glm::length(n);
            const glm::dvec3 centre = (a + s.point_m[t[1]] + s.point_m[t[2]]) / 3.0;
            place = centre - 1e-3 * n / std::sqrt(largest);
        }
    }
    return place;
}

std::vector<Shell> make_shells(std::vector<Surface> closed, Notes& notes) {
    std::vector<Shell> shells;
    std::size_t turned = 0;
    double largest = 0.0;
    for (auto& s : closed) {
        Shell shell{.surface = std::move(s), .box = {}};
        shell.box = box_of(shell.surface);
        shell.volume_m3 = volume_m3(shell.surface);
        if (shell.volume_m3 < 0.0) {
            turn_over(shell.surface);
            shell.volume_m3 = -shell.volume_m3;
            ++turned;
        }
        largest = std::max(largest, shell.volume_m3);
        shells.push_back(std::move(shell));
    }
    if (turned > 0) {
        notes.repairs.push_back(
            fmt::format("{} of {} shells faced inwards", turned, shells.size()));
    }
    const glm::dvec3 size =
        shells.empty() ? glm::dvec3{0.0} : shells[0].box.high - shells[0].box.low;
    const double diagonal_m = glm::length(size);
    if (largest <= 1e-9 * diagonal_m * diagonal_m * diagonal_m) {
        throw ImportRefused(fmt::format("it has no volume, around {}: accepted: a closed surface "
                                        "around a body",
                                        notes.place(shells.empty() ? size : shells[0].box.low)));
    }
    std::size_t specks = 0;
    glm::dvec3 speck_at{0.0};
    std::erase_if(shells, [&](const Shell& s) {
        const bool speck = s.volume_m3 < kSpeckShare * largest;
        speck_at = speck && specks++ == 0 ? s.box.low : speck_at;
        return speck;
    });
    if (specks > 0) {
        notes.repairs.push_back(fmt::format(
            "{} specks (each below {:.1f} % of the largest body's volume) dropped, the first at {}",
            specks, 100.0 * kSpeckShare, notes.place(speck_at)));
    }
    std::stable_sort(shells.begin(), shells.end(),
                     [](const Shell& a, const Shell& b) { return a.volume_m3 > b.volume_m3; });
    return shells;
}

} // namespace

std::vector<Body> make_bodies(std::vector<Surface> closed, Notes& notes) {
    auto shells = make_shells(std::move(closed), notes);
    for (std::size_t i = 0; i < shells.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) { // only a larger shell can hold a smaller one
            if (holds(shells[j], shells[i])) {
                ++shells[i].depth;
                shells[i].inside = j;
            }
        }
    }
    std::vector<Body> bodies;
    for (std::size_t i = 0; i < shells.size(); ++i) {
        if (shells[i].depth % 2 != 0) {
            continue;
        }
        Body body{.surface = shells[i].surface, .cavity_m = {}, .volume_m3 = shells[i].volume_m3};
        for (std::size_t j = i + 1; j < shells.size(); ++j) {
            Shell& inner = shells[j];
            if (inner.depth == shells[i].depth + 1 && inner.inside == i) {
                body.cavity_m.push_back(place_inside(inner.surface));
                body.volume_m3 -= inner.volume_m3;
                notes.repairs.push_back(
                    fmt::format("a shell of {:.3g} ml inside another, at {}, is taken as a cavity",
                                1e6 * inner.volume_m3, notes.place(body.cavity_m.back())));
                turn_over(inner.surface);
                body.surface = joined({&body.surface, &inner.surface});
            }
        }
        bodies.push_back(std::move(body));
    }
    std::stable_sort(bodies.begin(), bodies.end(),
                     [](const Body& a, const Body& b) { return a.volume_m3 > b.volume_m3; });
    return bodies;
}

} // namespace bake
