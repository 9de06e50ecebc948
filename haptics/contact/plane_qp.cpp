#include "haptics/contact/plane_qp.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace haptics {
namespace {

using glm::dvec3;

constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The point nearest to the goal on up to three planes at once, as a step from the goal.
struct Foot {
    std::array<int, 3> plane{-1, -1, -1};
    int planes = 0;
    dvec3 step_m{0.0};
    std::array<double, 3> multiplier{};
    double sine = 1.0; // smallest angle between a plane and those before it: rounding grows by 1/it

    bool pushes() const noexcept {
        return *std::min_element(multiplier.begin(), multiplier.end()) >= 0.0;
    }
    bool on(int p) const noexcept {
        return std::find(plane.begin(), plane.begin() + planes, p) != plane.begin() + planes;
    }
};

struct Problem {
    std::span<const Plane> plane;
    dvec3 goal_m;

    /// How far the goal would have to go along this plane's normal.
    double wanted_m(int p) const noexcept {
        return plane[p].offset_m - glm::dot(plane[p].normal, goal_m);
    }
    double violation_m(int p, const dvec3& step_m) const noexcept {
        return wanted_m(p) - glm::dot(plane[p].normal, step_m);
    }
    /// What rounding may leave of a plane that is kept.
    double rounding_m(int p, const Foot& foot) const noexcept {
        const double size_m =
            std::abs(plane[p].offset_m) + glm::length(goal_m) + glm::length(foot.step_m);
        return kRounding * size_m / foot.sine;
    }
    bool keeps(int p, const Foot& foot) const noexcept {
        return foot.on(p) || violation_m(p, foot.step_m) <= rounding_m(p, foot);
    }
};

/// Puts a foot on its planes: orthonormal directions one plane after another (twice is enough:
/// Giraud et al. 2005), the step forwards through them, the multipliers backwards. False: the
/// planes do not meet in one place, line or plane as far as rounding can tell.
bool put_on_planes(const Problem& problem, Foot& foot) noexcept {
    std::array<dvec3, 3> q{};
    std::array<std::array<double, 3>, 3> r{}; // r[k][i] = normal k along direction i
    std::array<double, 3> along{};
    foot.step_m = dvec3{0.0};
    for (int k = 0; k < foot.planes; ++k) {
        const dvec3& normal = problem.plane[foot.plane[k]].normal;
        dvec3 left = normal;
        for (int pass = 0; pass < 2; ++pass)
            for (int i = 0; i < k; ++i)
                left -= glm::dot(left, q[i]) * q[i];
        const double length = glm::length(left);
        if (!(length > kRounding))
            return false;
        q[k] = left / length;
        if (k == 2) { // free of the rounding above
            q[2] = glm::cross(q[0], q[1]);
            q[2] *= glm::dot(q[2], left) < 0.0 ? -1.0 : 1.0;
        }
        for (int i = 0; i <= k; ++i)
            r[k][i] = glm::dot(normal, q[i]);
        if (!(r[k][k] > kRounding))
            return false;
        foot.sine = std::min(foot.sine, r[k][k]);
        along[k] = problem.violation_m(foot.plane[k], foot.step_m) / r[k][k];
        foot.step_m += along[k] * q[k];
    }
    for (int k = foot.planes - 1; k >= 0; --k) {
        double rest = along[k];
        for (int later = k + 1; later < foot.planes; ++later)
            rest -= foot.multiplier[later] * r[later][k];
        foot.multiplier[k] = rest / r[k][k];
    }
    return std::isfinite(glm::dot(foot.step_m, foot.step_m));
}

/// The nearest point in front of the planes that `old` stands on and of plane `added`, which it
/// violates and which therefore holds the new one. False: there is none.
bool step_over(const Problem& problem, const Foot& old, int added, Foot& best) noexcept {
    double best_m2 = kInfinity;
    bool best_pushes = false;
    for (unsigned choice = 0; choice < (1u << old.planes); ++choice) {
        Foot foot{.plane = {added}, .planes = 1};
        if (choice == 7u)
            continue; // four planes meet nowhere
        for (int k = 0; k < old.planes; ++k)
            if (choice & (1u << k))
                foot.plane[foot.planes++] = old.plane[k];
        if (!put_on_planes(problem, foot))
            continue;
        const bool kept = std::all_of(old.plane.begin(), old.plane.begin() + old.planes,
                                      [&](int p) { return problem.keeps(p, foot); });
        const double m2 = glm::dot(foot.step_m, foot.step_m);
        const bool better = foot.pushes() != best_pushes ? foot.pushes() : m2 < best_m2;
        if (!kept || !better)
            continue;
        best = foot;
        best_m2 = m2;
        best_pushes = foot.pushes();
    }
    return best_m2 < kInfinity;
}

/// The plane that a foot violates most beyond rounding; -1: none.
int worst_plane(const Problem& problem, const Foot& foot, std::span<const int> among) noexcept {
    int worst = -1;
    double worst_m = 0.0;
    const auto look = [&](int p) {
        const double m = problem.violation_m(p, foot.step_m);
        if (m > worst_m && !problem.keeps(p, foot)) {
            worst = p;
            worst_m = m;
        }
    };
    if (among.empty())
        for (int p = 0; p < static_cast<int>(problem.plane.size()); ++p)
            look(p);
    for (const int p : among)
        look(p);
    return worst;
}

double worst_violation(const Problem& problem, const Foot& foot) noexcept {
    double worst_m = 0.0;
    for (int p = 0; p < static_cast<int>(problem.plane.size()); ++p)
        worst_m = std::max(worst_m, problem.violation_m(p, foot.step_m));
    return worst_m;
}

/// Of the feet that the search visits, the one that violates its worst plane least: the search
/// once more, for those that have no solution.
Foot least_wrong(const Problem& problem) noexcept {
    Foot foot, best;
    double best_m = worst_violation(problem, foot);
    const int most = 16 + 4 * static_cast<int>(problem.plane.size());
    for (int i = 0; i < most; ++i) {
        const int worst = worst_plane(problem, foot, {});
        Foot next;
        if (worst < 0 || !step_over(problem, foot, worst, next))
            break;
        foot = next;
        if (const double m = worst_violation(problem, foot); m < best_m) {
            best_m = m;
            best = foot;
        }
    }
    return best;
}

PlaneSolution told(const Problem& problem, const Foot& foot, bool feasible) noexcept {
    return {.place_m = problem.goal_m + foot.step_m,
            .active = foot.plane,
            .actives = foot.planes,
            .feasible = feasible,
            .violation_m = feasible ? 0.0 : worst_violation(problem, foot),
            .multiplier = foot.multiplier};
}

bool finite(const Problem& problem) noexcept {
    double sum = glm::dot(problem.goal_m, dvec3{1.0});
    for (const Plane& p : problem.plane)
        sum += glm::dot(p.normal, dvec3{1.0}) + p.offset_m;
    return std::isfinite(sum);
}

} // namespace

PlaneSolution nearest_in_planes(std::span<const Plane> planes, const dvec3& goal_m,
                                std::span<const int> warm) noexcept {
    const Problem problem{planes, goal_m};
    if (!finite(problem))
        return {.place_m = goal_m, .violation_m = kInfinity};
    std::array<int, 3> known{};
    std::size_t knowns = 0;
    for (const int p : warm)
        if (p >= 0 && p < static_cast<int>(planes.size()) && knowns < known.size())
            known[knowns++] = p;

    // the planes of last time first, then the worst of all, until none is violated; the distance
    // to the goal grows with every step, so none comes back
    Foot foot;
    bool warming = knowns > 0;
    const int most = 16 + 4 * static_cast<int>(planes.size());
    for (int i = 0; i < most; ++i) {
        const int worst = worst_plane(problem, foot, std::span(known).first(warming ? knowns : 0));
        if (worst < 0 && warming) {
            warming = false;
            continue;
        }
        if (worst < 0)
            return told(problem, foot, true);
        Foot next;
        if (!step_over(problem, foot, worst, next))
            break;
        foot = next;
    }
    return told(problem, least_wrong(problem), false);
}

} // namespace haptics
