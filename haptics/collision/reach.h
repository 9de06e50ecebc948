// haptics/collision/reach.h
// What a collision method is asked for: the triangles that come within some distance of a
// segment. A closest point is a reach that shrinks, a segment cast is one of radius 0 whose end
// comes nearer, a sweep is one as thick as the ball.
//
// Every method of this folder is a struct with one function
//   template <class Look> void visit(const Method&, Reach& reach, Look&& look);
// which calls look(triangle) for every triangle that meets the reach, at least once, in any order
// (the nearer first pays), maybe for others too. `look` may shrink the reach (never move or grow
// it); what has fallen out of it need not be visited any more. Boxes cover both ends of the
// interval of the last refit. Nothing is allocated, nothing is written but through `look`: any
// number of threads may ask.
#pragma once

#include <glm/vec3.hpp>

namespace haptics {

struct Reach {
    glm::dvec3 from_m{0.0}, to_m{0.0};
    double radius_m = 0.0;
};

} // namespace haptics
