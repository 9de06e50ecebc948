// tests/haptics/libccd_pair.h
// Penetration depth of two convex pieces by libccd (GJK and expanding polytope), a reference.
#pragma once

#ifdef TROCAR_HAS_LIBCCD
#include "haptics/rigid/convex_hull.h"
#include "haptics/rigid/rigid_pose.h"

#include <ccd/ccd.h>
#include <glm/geometric.hpp>

struct CcdBody {
    const haptics::ConvexHull* hull;
    haptics::RigidPose pose;
};

inline void ccd_support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) {
    const auto& body = *static_cast<const CcdBody*>(object);
    const glm::dvec3 n{direction->v[0], direction->v[1], direction->v[2]};
    glm::dvec3 best = haptics::to_world(body.pose, body.hull->vertex_m[0]);
    for (const glm::dvec3& v : body.hull->vertex_m) {
        const glm::dvec3 p = haptics::to_world(body.pose, v);
        if (glm::dot(n, p) > glm::dot(n, best))
            best = p;
    }
    ccdVec3Set(out, best.x, best.y, best.z);
}

/// 0 if libccd finds none.
inline double libccd_depth(const haptics::ConvexHull& a, const haptics::ConvexHull& b,
                           const haptics::RigidPose& b_in_a) {
    const CcdBody first{&a, {}}, second{&b, b_in_a};
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd_support;
    ccd.support2 = ccd_support;
    ccd.max_iterations = 200;
    ccd.epa_tolerance = 1e-7;
    ccd_real_t depth = 0.0;
    ccd_vec3_t way, place;
    return ccdGJKPenetration(&first, &second, &ccd, &depth, &way, &place) == 0 ? depth : 0.0;
}
#endif
