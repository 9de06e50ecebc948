#include "sim/loop/tissue_loop.h"

#include "sim/bridge/answer_to_local_model.h"
#include "sim/bridge/contact_rows.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace sim {
namespace {

// A body that stays within so little for so long is at rest: nothing that a hand or eye can tell,
// and dropping it makes rest exact, so that resting steps cost nothing and repeat to the bit. The
// time is longer than half a sway of an organ on its bed (4 to 10 Hz). What creeps on, as tissue
// with a memory does for as long as its longest relaxation, goes that much farther once dropped.
constexpr double kStill_m = 5e-6;
constexpr double kRestTime_s = 0.3;

double still_m(const tissue::Material& material) noexcept {
    double longest_s = kRestTime_s;
    for (const tissue::PronyTerm& term : material.prony)
        longest_s = std::max(longest_s, term.time_s);
    return kStill_m * kRestTime_s / longest_s;
}

double largest(const std::vector<double>& values) noexcept {
    double most = 0.0;
    for (const double v : values)
        most = std::max(most, std::abs(v));
    return most;
}

// Whether it has stayed within that for that long, if no tool touches it.
bool has_come_to_rest(Body& body, bool touched, double step_s) noexcept {
    SoftBody& soft = *body.soft;
    double farthest_m = 0.0;
    for (std::size_t k = 0; k < soft.drift_m.size(); ++k) {
        soft.drift_m[k] += soft.motion_m[k];
        farthest_m = std::max(farthest_m, std::abs(soft.drift_m[k]));
    }
    soft.still_s += step_s;
    if (touched || !(farthest_m <= still_m(body.material))) {
        std::fill(soft.drift_m.begin(), soft.drift_m.end(), 0.0);
        soft.still_s = 0.0;
    }
    return soft.still_s > kRestTime_s;
}

void note(const tissue::SolidReport& report, StepOutcome& outcome) noexcept {
    outcome.linear_residual = std::max(outcome.linear_residual, report.linear_residual);
    outcome.residual = std::max(outcome.residual, report.residual);
    outcome.iterations = std::max(outcome.iterations, report.iterations);
    outcome.inverted += report.inverted;
    outcome.warped |= report.warped;
}

// A tool that touched this body in the last step will press in this one, near enough as hard.
bool load_before(TissueRig& rig, std::size_t body) noexcept {
    bool pressed = false;
    SoftBody& soft = *rig.bodies[body].soft;
    std::fill(soft.load_n.begin(), soft.load_n.end(), 0.0);
    for (int i = 0; i < kTools; ++i) {
        FemContact& contact = rig.contact[i];
        if (contact.body != static_cast<int>(body) ||
            !(rig.memory[i].touching || rig.memory[i].grasped))
            continue;
        pressed = true;
        contact.before_n = contact.force_n;
        tissue::add_row(tissue::dofs(soft.solid), rig.bodies[body].organ->surface,
                        tissue_point(contact.at), contact.before_n, -1.0, soft.load_n);
    }
    if (rig.organs)
        pressed |= add_organ_load(rig, body, soft.load_n);
    return pressed;
}

void free_motions(TissueRig& rig, StepOutcome& outcome) noexcept {
    for (FemContact& contact : rig.contact)
        contact.before_n = glm::dvec3{0.0};
    for (std::size_t b = 0; b < rig.bodies.size(); ++b) {
        if (!rig.bodies[b].soft)
            continue;
        SoftBody& soft = *rig.bodies[b].soft;
        if (soft.resting) {
            std::fill(soft.motion_m.begin(), soft.motion_m.end(), 0.0);
            continue;
        }
        const bool pressed = load_before(rig, b);
        note(tissue::free_motion(soft.solid, pressed, soft.load_n, soft.motion_m), outcome);
    }
}

void wake_touched(TissueRig& rig, const haptics::ContactSolution& solution) noexcept {
    for (int i = 0; i < kTools; ++i) {
        if (rig.contact[i].body < 0 || solution.force_n[i] == glm::dvec3{0.0})
            continue;
        Body& body = rig.bodies[rig.contact[i].body];
        if (body.soft)
            body.soft->resting = false;
    }
}

// Organs under what the tools' forces have become; then all of their forces are in the load.
void push_again(TissueRig& rig, const haptics::ContactProblem& problem,
                const haptics::ContactSolution& solution, StepOutcome& outcome) noexcept {
    std::array<glm::dvec3, kTools> change_n{};
    for (int i = 0; i < kTools; ++i) {
        if (problem.row[i].active)
            change_n[i] = solution.force_n[i] - rig.contact[i].before_n;
    }
    follow_tools(rig, change_n);
    push_organs(rig);
    keep_organ_forces(rig);
    outcome.organ_residual_m = rig.organs->residual_m;
    for (std::size_t b = 0; b < rig.bodies.size(); ++b) {
        if (rig.bodies[b].soft && !rig.bodies[b].soft->resting)
            add_organ_load(rig, b, rig.bodies[b].soft->load_n);
    }
}

void advance_body(TissueRig& rig, std::size_t b, StepOutcome& outcome) noexcept {
    Body& body = rig.bodies[b];
    SoftBody& soft = *body.soft;
    const bool placed = rig.organs && is_pushed(rig, b);
    const tissue::SolidReport report =
        tissue::end_step(soft.solid, soft.load_n, rig.config.relinearise_m, soft.motion_m, placed);
    note(report, outcome);
    const double moved_m = largest(soft.motion_m);
    soft.linearisations += report.new_tangent;
    soft.moved_m += moved_m;
    tissue::place_surface(body.organ->surface, soft.skin_frame, tissue::position_m(soft.solid),
                          body.skin_m, body.skin_normal);
}

void advance_bodies(TissueRig& rig, const haptics::ContactSolution& solution,
                    StepOutcome& outcome) noexcept {
    for (std::size_t b = 0; b < rig.bodies.size(); ++b) {
        Body& body = rig.bodies[b];
        rig.rests[b] = 1;
        if (!body.soft || body.soft->resting)
            continue;
        bool touched = false;
        for (int i = 0; i < kTools; ++i) {
            touched |= rig.contact[i].body == static_cast<int>(b) &&
                       solution.force_n[i] != glm::dvec3{0.0};
        }
        rig.rests[b] = has_come_to_rest(body, touched, rig.config.step_s);
    }
    if (rig.organs)
        rest_together(rig, rig.rests);
    for (std::size_t b = 0; b < rig.bodies.size(); ++b) {
        Body& body = rig.bodies[b];
        if (!body.soft || body.soft->resting)
            continue;
        if (!rig.rests[b]) {
            advance_body(rig, b, outcome);
            continue;
        }
        tissue::stop(body.soft->solid);
        body.soft->resting = true;
    }
}

double peak_stress_pa(const TissueRig& rig) noexcept {
    double peak = 0.0;
    for (const Body& body : rig.bodies) {
        if (body.soft && !body.soft->resting)
            peak = std::max(peak, tissue::peak_von_mises_pa(body.soft->solid));
    }
    return peak;
}

// Depth under a tip that the mesh cannot show, and how far around the tip it reaches. Held skin
// is drawn after the tip, wherever that is.
struct Dimple {
    glm::dvec3 centre_m{0.0}, down{0.0};
    double depth_m = 0.0, contact_radius_m = 1e-9, reach_m = 1.0;
    int body = -1;
};

Dimple dimple_of(const TissueRig& rig, int tool) noexcept {
    const FemContact& contact = rig.contact[tool];
    Dimple out;
    if (contact.body < 0 || !rig.memory[tool].touching)
        return out;
    const Body& body = rig.bodies[contact.body];
    if (!body.soft)
        return out;
    const haptics::LocalLaw law = law_on(body, contact.at, tool, rig.floor_mpn[tool]);
    const tissue::Triangle& corner = body.organ->surface.triangles[contact.at.triangle];
    out.body = contact.body;
    out.centre_m = place_on(body, contact.at);
    out.down = -contact.normal;
    out.depth_m = std::max(0.0, haptics::law_at(law, rig.memory[tool].x).depth_m);
    out.contact_radius_m = haptics::contact_radius(law, rig.memory[tool].x);
    out.reach_m = body.organ->surface.footprint_radius_m[corner[0]];
    if (rig.memory[tool].grasped) { // a tent drawn after the tip
        const glm::dvec3 stretch_m = contact.last_tip_m - out.centre_m - rig.memory[tool].grip_m;
        out.depth_m = glm::length(stretch_m);
        out.down = stretch_m / std::max(out.depth_m, 1e-12);
        out.contact_radius_m = haptics::kHeldRadius_m;
    }
    return out;
}

// Skin around a flat punch sinks as (2/pi) asin(a_c/rho) (Sneddon 1965); beyond the kernel the
// mesh shows all of it.
double sunk_m(const Dimple& dimple, const glm::dvec3& place_m) noexcept {
    const double rho = glm::distance(place_m, dimple.centre_m);
    if (rho >= dimple.reach_m)
        return 0.0;
    const double share = rho / dimple.reach_m;
    const double fade = (1.0 - share * share) * (1.0 - share * share);
    const double profile = 2.0 / std::numbers::pi *
                           std::asin(std::min(1.0, dimple.contact_radius_m / std::max(rho, 1e-9)));
    return dimple.depth_m * profile * fade;
}

} // namespace

TissueRig make_tissue_rig(std::vector<Body> bodies, const TissueConfig& config) {
    TissueRig rig;
    rig.config = config;
    rig.bodies = std::move(bodies);
    rig.rests.assign(rig.bodies.size(), 0);
    if (config.organs_meet && rig.bodies.size() > 1)
        rig.organs = make_organ_contact(rig.bodies);
    // one scratch patch per tool, large enough for whichever body it meets
    const auto largest =
        std::max_element(rig.bodies.begin(), rig.bodies.end(), [](const Body& a, const Body& b) {
            return a.organ->surface.triangles.size() < b.organ->surface.triangles.size();
        });
    if (largest != rig.bodies.end()) {
        for (tissue::Patch& patch : rig.patch) {
            patch = tissue::make_patch(largest->organ->surface, haptics::kMaxPatchVertices,
                                       haptics::kMaxPatchTriangles);
        }
        for (ShownShapes& shown : rig.shown) {
            shown.vertex.reserve(haptics::kMaxPatchVertices);
            shown.shape.resize(haptics::kMaxPatchVertices);
        }
    }
    return rig;
}

double coupling_floor_mpn(const haptics::ShaftPose& shaft, double device_npm) noexcept {
    const glm::dmat3& J = shaft.jacobian;
    const double lever = 0.5 * (J[0][0] + J[1][1] + J[2][2] - 1.0);
    return std::max(1.0, lever * lever) / device_npm;
}

StepOutcome tissue_step(TissueRig& rig, const ToolsNow& tools, TissueAnswer& answer) noexcept {
    StepOutcome outcome;
    outcome.trace.step = rig.next_step++;
    outcome.trace.sample_tick = tools.tick;
    rig.last_sample_tick = tools.tick;

    for (int i = 0; i < kTools; ++i) {
        rig.floor_mpn[i] = coupling_floor_mpn(tools.shaft[i], rig.device_npm[i]);
    }
    follow_contacts(rig, tools);
    if (rig.organs)
        meet_organs(rig);
    free_motions(rig, outcome);
    if (rig.organs)
        push_organs(rig);
    haptics::ContactProblem problem;
    fill_rows(rig, tools, problem);
    condense_rows(rig, problem);
    const haptics::ContactSolution solution = haptics::solve_contact(problem, rig.memory);
    outcome.contact_residual_m = solution.residual_m;
    wake_touched(rig, solution);
    apply_forces(rig, problem, solution);
    if (rig.organs)
        push_again(rig, problem, solution, outcome);
    advance_bodies(rig, solution, outcome);
    outcome.peak_stress_pa = peak_stress_pa(rig);
    slide_contacts(rig, solution);

    answer.local.step = outcome.trace.step;
    answer.local.sample_tick = tools.tick;
    if (rig.config.basis)
        make_local_models(rig, answer.local);
    if (rig.config.basis && rig.organs)
        add_organ_residual(rig, answer.local);
    answer.seen.targets = static_cast<int>(rig.targets.size());
    place_targets(rig, answer.seen.target_um);
    see_targets(rig, tools.scope, answer.seen.clear_rays);
    answer.seen.stress_pa = static_cast<std::int32_t>(std::lround(outcome.peak_stress_pa));
    outcome.trace.clear_rays = answer.seen.clear_rays;
    outcome.trace.stress_pa = answer.seen.stress_pa;
    outcome.trace.targets = answer.seen.targets;
    outcome.trace.target_um = answer.seen.target_um;
    outcome.trace.flags =
        static_cast<std::uint8_t>((outcome.warped ? 1 : 0) | (outcome.inverted > 0 ? 2 : 0));
    return outcome;
}

void see_targets(TissueRig& rig, const ScopeNow& scope, ClearRays& out) noexcept {
    out.fill(0);
    if (rig.sight)
        refit(*rig.sight, rig.bodies);
    for (std::size_t t = 0; t < rig.targets.size() && t < out.size(); ++t) {
        const EmbeddedTarget& target = rig.targets[t];
        const Body& body = rig.bodies[target.body];
        const Marker marker{place_on(body, target.at), normal_on(body, target.at),
                            rig.mark_radius_m};
        out[t] = static_cast<std::uint8_t>(
            rig.sight ? clear_rays(*rig.sight, rig.bodies, scope.port_m, scope.view.eye_m, marker)
                      : kSightRays);
    }
}

glm::dvec3 skin_under(const TissueRig& rig, int tool) noexcept {
    const FemContact& contact = rig.contact[tool];
    const Body& body = rig.bodies[contact.body];
    const glm::dvec3 place_m = place_on(body, contact.at);
    const Dimple dimple = dimple_of(rig, tool);
    if (dimple.body < 0)
        return place_m;
    if (rig.memory[tool].grasped)
        return place_m + dimple.depth_m * dimple.down;
    // without the spring of the coupling, which is none of the tissue's
    const haptics::LocalLaw law = law_on(body, contact.at, tool, 0.0);
    return place_m + std::max(0.0, haptics::law_at(law, rig.memory[tool].x).depth_m) * dimple.down;
}

void place_targets(const TissueRig& rig, TargetPlaces& out) noexcept {
    std::array<Dimple, kTools> dimples;
    for (int i = 0; i < kTools; ++i)
        dimples[i] = dimple_of(rig, i);
    for (std::size_t t = 0; t < rig.targets.size() && t < out.size(); ++t) {
        const EmbeddedTarget& target = rig.targets[t];
        const glm::dvec3 place = place_on(rig.bodies[target.body], target.at);
        glm::dvec3 sunk = place;
        for (const Dimple& dimple : dimples) {
            if (dimple.body == target.body)
                sunk += sunk_m(dimple, place) * dimple.down;
        }
        for (int axis = 0; axis < 3; ++axis) {
            out[t][axis] = static_cast<std::int32_t>(std::lround(sunk[axis] * 1e6));
        }
    }
}

void draw_surface(const TissueRig& rig, SurfaceNow& out) {
    std::array<Dimple, kTools> dimples;
    for (int i = 0; i < kTools; ++i)
        dimples[i] = dimple_of(rig, i);
    out.step = rig.next_step - 1;
    out.position_m.resize(rig.bodies.size());
    out.normal.resize(rig.bodies.size());
    for (std::size_t b = 0; b < rig.bodies.size(); ++b) {
        const Body& body = rig.bodies[b];
        out.position_m[b].resize(body.skin_m.size());
        out.normal[b].resize(body.skin_m.size());
        for (std::size_t v = 0; v < body.skin_m.size(); ++v) {
            glm::dvec3 place = body.skin_m[v];
            for (const Dimple& dimple : dimples) {
                if (dimple.body == static_cast<int>(b)) {
                    place += sunk_m(dimple, body.skin_m[v]) * dimple.down;
                }
            }
            out.position_m[b][v] = glm::vec3(place);
            out.normal[b][v] = glm::vec3(body.skin_normal[v]);
        }
    }
    out.targets = static_cast<int>(rig.targets.size());
    place_targets(rig, out.target_um);
}

} // namespace sim
