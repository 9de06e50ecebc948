// haptics/collision/witness.h
// The last answer as the first guess of the next, over any collision method (frame-to-frame
// coherence; Gregory, Lin, Gottschalk, Taylor 1999). The answers are those of queries.h: the
// guess only makes the reach smaller. Real-time safe.
#pragma once

#include "haptics/collision/neighbours.h"
#include "haptics/collision/queries.h"

namespace haptics {

/// One for each thing that moves over a mesh, and each question.
struct Witness {
    const Neighbours& neighbours;
    std::uint32_t triangle = kNoSurface;
};

/// From the last answer downhill: where the nearest point of a triangle lies on an edge, what is
/// across may be nearer.
inline void walk_downhill(ClosestSearch& search, const Neighbours& neighbours,
                          std::uint32_t from) noexcept {
    constexpr int kMostSteps = 8;
    search(from);
    for (int step = 0; step < kMostSteps && search.best.triangle == from; ++step) {
        for (int k = 0; k < 3; ++k)
            if (const std::uint32_t t = neighbours.across[from][k];
                t != kNoSurface && search.best.weight[k] == 0.0 && search.best.triangle == from)
                search(t);
        if (search.best.triangle == from)
            return;
        from = search.best.triangle;
    }
}

/// The last answer's triangle is measured first, then those across its edges as far as they are
/// nearer; the method is asked for what is nearer still.
template <class Method>
SurfaceHit closest_within_cached(const Method& method, const MeshView& mesh,
                                 const glm::dvec3& place_m, double radius_m,
                                 Witness& witness) noexcept {
    ClosestSearch search(mesh, place_m, radius_m);
    if (witness.triangle < mesh.triangle.size())
        walk_downhill(search, witness.neighbours, witness.triangle);
    const std::uint32_t first = witness.triangle;
    visit(method, search.reach, [&](std::uint32_t t) {
        if (t != first && t != search.best.triangle)
            search(t);
    });
    if (search.best.hit())
        witness.triangle = search.best.triangle;
    return search.best;
}

/// The last answer's triangle is tried first: if it is hit, the segment ends there.
template <class Method>
SurfaceHit cast_segment_cached(const Method& method, const MeshView& mesh, const glm::dvec3& from_m,
                               const glm::dvec3& to_m, Witness& witness) noexcept {
    CastSearch search(mesh, from_m, to_m);
    if (witness.triangle < mesh.triangle.size())
        search(witness.triangle);
    const std::uint32_t first = witness.triangle;
    visit(method, search.reach, [&](std::uint32_t t) {
        if (t != first)
            search(t);
    });
    const SurfaceHit hit = search.answer();
    if (hit.hit())
        witness.triangle = hit.triangle;
    return hit;
}

} // namespace haptics
