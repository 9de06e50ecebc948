// The organ's places pressed by both; see organ_reference.h.
#include "sim/study/organ_reference.h"

#include "sim/study/indent.h"
#include "sim/study/organ_study.h"
#include "sim/study/reference_record.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace sim {
namespace {

using glm::dvec3;

constexpr Gates kGates;

double percent(double value, double truth) {
    return truth == 0.0 ? 0.0 : 100.0 * (value - truth) / std::abs(truth);
}

// No force has the direction of any.
double degrees_between(const dvec3& a, const dvec3& b) {
    const double lengths = glm::length(a) * glm::length(b);
    if (!(lengths > 0.0))
        return 0.0;
    return std::acos(std::clamp(glm::dot(a, b) / lengths, -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

// `before`: the row of the depth before, or one of zeros.
ReferenceRow row_of(const TrainerPress& ours, const ReferencePress& reference, std::size_t d,
                    const ReferenceRow& before, double depth_m) {
    ReferenceRow r{.depth_m = depth_m, .force_n = glm::length(ours.force_n[d])};
    r.stiffness_npm = (r.force_n - before.force_n) / (depth_m - before.depth_m);
    r.solved = d < reference.force_n.size();
    if (!r.solved)
        return r;
    const dvec3 force = reference.force_n[d];
    r.reference_n = glm::length(force);
    r.error_n = r.force_n - r.reference_n;
    r.error_percent = percent(r.force_n, r.reference_n);
    r.reference_npm = (r.reference_n - before.reference_n) / (depth_m - before.depth_m);
    r.stiffness_percent = percent(r.stiffness_npm, r.reference_npm);
    r.direction_deg = degrees_between(ours.force_n[d], force);
    r.a1 = r.reference_n > kGates.full_force_n ? std::abs(r.error_percent) <= kGates.force_percent
                                               : std::abs(r.error_n) <= kGates.small_force_n;
    r.a2 = std::abs(r.stiffness_percent) <= kGates.stiffness_percent;
    r.a3 = r.direction_deg <= kGates.direction_deg;
    return r;
}

void add_rows(const OrganReferenceOptions& o, int place, OrganReference& study) {
    ReferenceRow before;
    for (std::size_t d = 0; d < o.press.depth_m.size(); ++d) {
        ReferenceRow r =
            row_of(study.place[place], study.reference[place], d, before, o.press.depth_m[d]);
        r.place = place;
        study.row.push_back(r);
        before = r;
    }
}

// All that a press depends on, so that a record is never taken for another's.
std::string record_key(const OrganReferenceOptions& o, const tissue::BakedOrgan& organ) {
    std::string key = fmt::format(
        "# organ reference: {} ({} nodes, {} tets), E {} Pa, nu {}, hold {} {} {} {} {}, seed {}, "
        "free skin, radius {} m, friction {}, edge {} in {}{}{}, step {}, depths",
        organ.name, organ.mesh.rest_m.size(), organ.mesh.tets.size(), o.material.young_pa,
        o.material.poisson, o.hold.toward.x, o.hold.toward.y, o.hold.toward.z, o.hold.share,
        o.hold.length_m, o.seed, o.press.radius_m, o.press.friction, o.press.edge_share,
        o.press.core_share,
        o.press.down_share > 0.0 ? fmt::format(" to {} of the depth", o.press.down_share) : "",
        o.press.onto_skin ? " on the skin" : "", o.press.step_share);
    for (const double d : o.press.depth_m)
        key += fmt::format(" {}", d);
    return key;
}

// Three tips at random places of `usual`, of another seed than those that are pressed.
StepTimes times_on(const OrganPointer& organ, const Body& usual, const OrganReferenceOptions& o) {
    constexpr double kStep_s = 0.01;
    ThreeTipsOptions tips = o.tips;
    tips.radius_m = o.press.radius_m;
    std::vector<Body> bodies;
    bodies.push_back(make_body(organ, o.material, {tips.radius_m, tips.radius_m, tips.radius_m},
                               kStep_s, o.tier));
    TissueConfig config;
    config.step_s = kStep_s;
    TissueRig rig = make_tissue_rig(std::move(bodies), config);
    const Body& body = rig.bodies.front();
    const std::vector<dvec3> places = random_places(usual, kTools, o.seed + 1, PressedSkin::free);
    TipSeats seats;
    for (int i = 0; i < kTools; ++i) {
        const haptics::SurfacePoint at = nearest_on(body, places[i]).at;
        const dvec3 out = normal_on(body, at);
        const dvec3 axis = std::abs(out.x) < 0.6 ? dvec3{1, 0, 0} : dvec3{0, 1, 0};
        seats[i] = {place_on(body, at), out, glm::normalize(glm::cross(out, axis))};
    }
    return time_three_tips(rig, seats, tips);
}

} // namespace

OrganReference run_organ_reference(const OrganReferenceOptions& o,
                                   const std::function<void(const std::string&)>& say,
                                   const std::function<void(const OrganReference&)>& keep) {
    if (o.press.depth_m.empty() || o.places < 1)
        throw std::invalid_argument("organ reference: want at least one depth and one place");
    const OrganPointer organ = held_organ(load_organ(o.organ), o.hold);
    if (o.press.radius_m > organ->tip_radius_max_m) {
        throw std::invalid_argument(
            fmt::format("tip radius {} mm: '{}' was baked for at most {} mm",
                        1e3 * o.press.radius_m, organ->name, 1e3 * organ->tip_radius_max_m));
    }
    const TrainerTip usual(organ, o.material, o.press.radius_m, o.press.friction,
                           tissue::Tier::corotated);
    const OrganPointer model = o.model.empty() ? organ : held_organ(load_organ(o.model), o.hold);
    TrainerTip tip(model, o.material, o.press.radius_m, o.press.friction, o.tier);
    OrganReference study{.nodes = static_cast<int>(model->mesh.rest_m.size()),
                         .tets = static_cast<int>(model->mesh.tets.size())};
    study.times = times_on(model, usual.body(), o);
    const std::string key = record_key(o, *organ);
    std::vector<ReferencePress> pressed = read_presses(o.record, key);
    for (const dvec3& place : random_places(usual.body(), o.places, o.seed, PressedSkin::free)) {
        const int i = static_cast<int>(study.place.size());
        const Foot foot = nearest_on(usual.body(), place);
        const dvec3 at_m = place_on(usual.body(), foot.at),
                    into = -normal_on(usual.body(), foot.at);
        study.place.push_back(tip.press(at_m, into, o.press.depth_m));
        if (i == static_cast<int>(pressed.size())) {
            if (o.only_recorded) {
                throw std::invalid_argument(fmt::format(
                    "{}: {} presses of this study are recorded: there is none of place {}; its "
                    "first line would be: {}",
                    o.record.string(), pressed.size(), i + 1, key));
            }
            pressed.push_back(press_reference(
                *organ, o.material, at_m, into, o.press, [&](double depth_m, double force_n) {
                    say(fmt::format("place {:>2}: {:5.2f} mm, {:4.0f} mN", i + 1, 1e3 * depth_m,
                                    1e3 * force_n));
                }));
            if (!o.record.empty())
                write_presses(o.record, key, pressed);
        }
        study.reference.push_back(pressed[i]);
        add_rows(o, i, study);
        const ReferencePress& r = study.reference.back();
        const ReferenceRow last = study.row[study.row.size() - o.press.depth_m.size() +
                                            std::max<std::size_t>(r.force_n.size(), 1) - 1];
        say(fmt::format("place {:>2} of {}: reference to {:.2f} mm ({} nodes, {} solves, {:.0f} s "
                        "CPU); there {:.0f} mN, ours {:.0f} mN{}{}",
                        i + 1, o.places, 1e3 * r.reached_m, r.nodes, r.iterations, r.cpu_s,
                        1e3 * last.reference_n, 1e3 * last.force_n,
                        r.stopped.empty() ? "" : "; stopped ", r.stopped));
        if (keep)
            keep(study);
    }
    return study;
}

ReferenceSummary summary_of(const OrganReferenceOptions& o, const OrganReference& study) {
    ReferenceSummary s;
    s.least_reached_m = std::numeric_limits<double>::max();
    for (const ReferencePress& r : study.reference)
        s.least_reached_m = std::min(s.least_reached_m, r.reached_m);
    const std::size_t depths = o.press.depth_m.size();
    for (std::size_t place = 0; place < study.place.size(); ++place) {
        bool inside = true, whole = true;
        for (std::size_t d = 0; d < depths; ++d) {
            const ReferenceRow& r = study.row[place * depths + d];
            ++s.rows;
            whole = whole && r.solved;
            if (!r.solved)
                continue;
            ++s.solved;
            s.a1 += r.a1;
            s.a2 += r.a2;
            s.a3 += r.a3;
            inside = inside && r.a1 && r.a2 && r.a3;
            s.worst_n = std::max(s.worst_n, std::abs(r.error_n));
            s.worst_percent = std::max(s.worst_percent, std::abs(r.error_percent));
            s.worst_stiffness_percent =
                std::max(s.worst_stiffness_percent, std::abs(r.stiffness_percent));
            s.worst_deg = std::max(s.worst_deg, r.direction_deg);
        }
        s.places_inside += inside && whole;
        s.places_to_the_end += whole;
    }
    return s;
}

} // namespace sim
