// tissue/reference/indenter.cpp
// Steps of depth, each from where the last two point to, halved where Newton fails.
#include "tissue/reference/indenter.h"

#include "tissue/reference/reference_element.h"
#include "tissue/reference/reference_newton.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace tissue {
namespace {

using glm::dvec3;

// Friction holds what the step before has touched. A first touch that is one long step slides,
// where an organ bends away under it, and its force leans: up to 40 degrees at 0.3 radii.
constexpr double kFirstStep = 1.0 / 16.0; // of the greatest
constexpr double kStepGrowth = 0.5;       // a step per depth so far

double reach_m(const Press& p) {
    return 3.0 * (p.radius_m + p.depth_m.back());
}

void check_press(const Press& p) {
    if (!(p.radius_m > 0.0)) {
        throw std::invalid_argument("press: radius_m = " + std::to_string(p.radius_m) +
                                    ": must be greater than 0");
    }
    if (!(std::abs(glm::length(p.into) - 1.0) < 1e-9))
        throw std::invalid_argument("press: the way of the tip must have length 1");
    if (!(p.friction >= 0.0)) {
        throw std::invalid_argument("press: friction = " + std::to_string(p.friction) +
                                    ": must be 0 or greater");
    }
    double last = 0.0;
    for (const double d : p.depth_m) {
        if (!(d > last)) {
            throw std::invalid_argument("press: depth_m = " + std::to_string(d) + " after " +
                                        std::to_string(last) + ": must ascend from above 0");
        }
        last = d;
    }
    if (p.depth_m.empty())
        throw std::invalid_argument("press: no depth_m: want at least one");
}

Tip tip_at(const Press& p, double depth_m) {
    return {p.place_m + (depth_m - p.radius_m) * p.into, -p.into, p.radius_m};
}

PressPoint measured(const ReferenceModel& model, std::span<const dvec3> moved_m,
                    const TipContact& contact) {
    PressPoint out;
    double area_m2 = 0.0;
    for (const FacePoint& p : contact.points) {
        const dvec3 x = place_of(model.mesh, p, moved_m);
        const Traction t = traction_at(contact, p, x);
        out.force_n -= p.area_m2 * (t.pressure_pa * t.normal + t.friction_pa);
        if (t.pressure_pa <= 0.0)
            continue;
        area_m2 += p.area_m2;
        out.penetration_m = std::max(out.penetration_m, -gap_at(contact.tip, x).value_m);
    }
    out.radius_m = std::sqrt(area_m2 / std::numbers::pi);
    return out;
}

// Two equilibria in a row point to the next, unless that would turn a tet inside out.
std::vector<dvec3> foreseen(const ReferenceModel& model, const std::vector<dvec3>& before,
                            const std::vector<dvec3>& now, double ratio) {
    std::vector<dvec3> next = now;
    for (std::size_t i = 0; i < next.size(); ++i)
        next[i] += ratio * (now[i] - before[i]);
    return std::isfinite(energy_at_j(model, {}, next)) ? next : now;
}

} // namespace

PressReport press(const ReferenceModel& model, const Press& p, ReferenceSystem& system,
                  ReferenceState& state, const std::function<void(const PressPoint&)>& progress) {
    check_press(p);
    TipContact contact{contact_points(model.mesh, p.place_m, reach_m(p)), tip_at(p, 0.0),
                       p.penalty * model.material.young_pa / p.radius_m};
    if (contact.points.empty())
        throw std::invalid_argument("press: no face of the body is near the place");
    const double greatest_m = p.step_m > 0.0 ? p.step_m : 0.25 * p.radius_m;
    const double first_m = p.friction > 0.0 ? kFirstStep * greatest_m : greatest_m;
    const double least_m = std::min(std::ldexp(greatest_m, -p.step_halvings), 0.5 * first_m);

    PressReport report;
    std::vector<dvec3> now = displacements_m(model, state.position_m), before = now;
    double step_m = greatest_m, last_step_m = greatest_m;
    const Potential potential{model.weight_n, {}, &contact};
    while (report.point.size() < p.depth_m.size() && step_m >= 0.999 * least_m) {
        const double goal_m = p.depth_m[report.point.size()];
        if (p.friction > 0.0)
            step_m = std::min(step_m, std::max(first_m, kStepGrowth * report.reached_m));
        const bool arrives = report.reached_m + 1.001 * step_m >= goal_m;
        const double depth_m = arrives ? goal_m : report.reached_m + step_m;
        const double taken_m = depth_m - report.reached_m;
        contact.tip = tip_at(p, depth_m);
        std::vector<dvec3> moved = foreseen(model, before, now, taken_m / last_step_m);
        const NewtonReport newton = find_least(model, potential, {}, p.newton, system, moved);
        report.iterations += newton.iterations;
        report.factors += newton.factors;
        if (!(newton.reached == 1.0)) {
            report.failed_at_m = depth_m;
            report.failed = newton;
            step_m *= 0.5;
            continue;
        }
        before = std::exchange(now, moved);
        last_step_m = taken_m;
        step_m = std::min(greatest_m, 2.0 * step_m);
        report.reached_m = depth_m;
        report.failed_at_m = 0.0;
        PressPoint point = measured(model, now, contact);
        point.depth_m = depth_m;
        point.min_det_f = newton.min_det_f;
        if (arrives)
            report.point.push_back(point);
        learn_contact(model, now, p.friction, contact);
        if (progress)
            progress(point);
    }
    for (std::size_t i = 0; i < now.size(); ++i)
        state.position_m[i] = model.mesh.rest_m[i] + now[i];
    state.velocity_mps.assign(now.size(), dvec3{0.0});
    return report;
}

double touch_depth_m(const QuadraticMesh& mesh, const Press& p) {
    check_press(p);
    const std::vector<dvec3> rest(mesh.rest_m.size(), dvec3{0.0});
    double first_m = 0.0;
    for (const FacePoint& point : contact_points(mesh, p.place_m, reach_m(p))) {
        const dvec3 away = place_of(mesh, point, rest) - p.place_m;
        const double along = glm::dot(away, p.into);
        const double across_m2 = glm::dot(away, away) - along * along;
        const double inside_m2 = p.radius_m * p.radius_m - across_m2;
        // the hemisphere's surface at this distance from the way reaches `along`
        if (inside_m2 > 0.0)
            first_m = std::min(first_m, along + p.radius_m - std::sqrt(inside_m2));
    }
    return first_m;
}

} // namespace tissue
