// haptics/contact/plane_qp.h
// The point nearest to a goal among those in front of given planes: what a proxy that leans on
// planes does in one tick (Ruspini, Kolarov and Khatib 1997, eq. 1). Three unknowns, so at most
// three planes hold the point. Any unit of length gives the same answer: there is no absolute
// tolerance, only what rounding of the numbers given can do.
// Called by the contact methods at 1 kHz: nothing is allocated or thrown.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>

namespace haptics {

struct Plane {         // not initialised: there is room for many, and few are used
    glm::dvec3 normal; // unit
    double offset_m;   // allowed: normal . x >= offset
};

struct PlaneSolution {
    glm::dvec3 place_m{0.0};
    std::array<int, 3> active{-1, -1, -1}; // the planes that hold the point, independent ones
    int actives = 0;
    bool feasible = false;
    double violation_m = 0.0; // of the worst plane, 0 if all are kept
    /// place - goal = sum of multiplier * normal over the active planes; none negative but by
    /// rounding. Times the stiffness of a proxy: what each plane pushes with.
    std::array<double, 3> multiplier{};
};

/// `warm`: planes that held the point last time, at most three, wrong ones do no harm; they cost or
/// save time, the place is the same. Redundant, nearly parallel and opposite planes are allowed.
/// No point in front of all: not feasible, and the place visited that violates the worst plane
/// least. Something not finite: not feasible, place = goal, violation infinite.
/// One solve of the nearest point per plane that turns out violated, each over at most four planes
/// (an LP-type problem of dimension 3: Matousek, Sharir and Welzl, Algorithmica 16, 1996).
PlaneSolution nearest_in_planes(std::span<const Plane> planes, const glm::dvec3& goal_m,
                                std::span<const int> warm = {}) noexcept;

} // namespace haptics
