// haptics/collision/witness.h
// The last answer as the first guess of the next, over any collision method (frame-to-frame
// coherence; Gregory, Lin, Gottschalk, Taylor 1999, 4.3). The answers are those of queries.h: the
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

inline constexpr int kMostSteps = 4; // from triangle to triangle, before the method is asked

template <class Method>
SurfaceHit closest_within_cached(const Method& method, const MeshView& mesh,
                                 const glm::dvec3& place_m, double radius_m,
                                 Witness& witness) noexcept {
    ClosestSearch search(mesh, place_m, radius_m);
    if (witness.triangle < mesh.triangle.size()) {
        search(witness.triangle);
        // downhill, as long as a neighbour is nearer; of one that is out of reach, one ring
        std::uint32_t from = witness.triangle;
        for (int step = 0; step < kMostSteps; ++step) {
            for (const std::uint32_t t : witness.neighbours.of(from))
                search(t);
            if (!search.best.hit() || search.best.triangle == from)
                break;
            from = search.best.triangle;
        }
    }
    visit(method, search.reach, search);
    if (search.best.hit())
        witness.triangle = search.best.triangle;
    return search.best;
}

template <class Method>
SurfaceHit cast_segment_cached(const Method& method, const MeshView& mesh, const glm::dvec3& from_m,
                               const glm::dvec3& to_m, Witness& witness) noexcept {
    CastSearch search(mesh, from_m, to_m);
    if (witness.triangle < mesh.triangle.size())
        search(witness.triangle);
    visit(method, search.reach, search);
    const SurfaceHit hit = search.answer();
    if (hit.hit())
        witness.triangle = hit.triangle;
    return hit;
}

} // namespace haptics
