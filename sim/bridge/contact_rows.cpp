#include "sim/bridge/contact_rows.h"

#include "haptics/contact/carried_point.h"
#include "haptics/contact/grasp.h"
#include "sim/bridge/mesh_lean.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

namespace sim {
namespace {

constexpr double kOpenGap_m = 1e-4; // rounding, with a wide margin
// Relative residual of A^-1 H^T: of the answer to what a force changes by in a step. What forces
// are where nothing changes does not depend on it; those of a quadratic flap that is lifted are
// within 1 mN of what exact rows make them.
constexpr double kRows = 1e-1;
// Where the tools stay on their points, rows serve for so many steps, and until the body has moved
// so far: they do not turn with it. Kept for ten steps of 20 ms whatever it did, they left one step
// in thirteen of a lifted flap unsolved; within 2 mm it is one in a thousand.
constexpr int kRowsAge = 10;
constexpr double kRowsDrift_m = 2e-3;

// A free tool takes whatever skin is nearest to `from_m`; the body that it was over wins a tie.
void find_nearest(TissueRig& rig, int tool, const glm::dvec3& from_m, double reach_m) noexcept {
    FemContact& contact = rig.contact[tool];
    Foot best;
    int body = -1;
    for (std::size_t b = 0; b < rig.bodies.size(); ++b) {
        const Foot foot = nearest_on(rig.bodies[b], from_m, reach_m);
        if (body < 0 || foot.distance_m < best.distance_m) {
            best = foot;
            body = static_cast<int>(b);
        }
    }
    if (body < 0 || best.distance_m > reach_m)
        body = -1;
    if (body != contact.body)
        contact.own_compliance = glm::dmat3{0.0};
    contact.body = body;
    contact.at = best.at;
    rig.memory[tool] = {};
}

haptics::WalkResult carried(const Body& body, const haptics::SurfacePoint& at,
                            const glm::dvec3& slip_m, const glm::dvec3& tip_m) noexcept {
    const auto read = [&](const haptics::SurfacePoint& point) {
        return haptics::SurfacePlace{place_on(body, point), normal_on(body, point)};
    };
    return haptics::carry(BodySurface{body}, read, at, slip_m, tip_m);
}

// A tip that no skin of the body reaches touches nothing, whatever its contact point says: that one
// is on the far side of something thin. Mostly the contact point is reached itself.
bool is_off(const Body& body, const haptics::ToolTip& tip,
            const haptics::SurfacePoint& contact) noexcept {
    if (glm::distance(tip.centre_m, place_on(body, contact)) <= tip.radius_m)
        return false;
    const Foot foot = nearest_on(body, tip.centre_m);
    const glm::dvec3 out = tip.centre_m - place_on(body, foot.at);
    return foot.distance_m > tip.radius_m && glm::dot(out, normal_on(body, foot.at)) > 0.0;
}

// A touching tool carries its point along: first as far as stiction lets it, then we solve.
void follow(TissueRig& rig, int tool, const haptics::ToolTip& tip) noexcept {
    FemContact& contact = rig.contact[tool];
    const Body& body = rig.bodies[contact.body];
    constexpr int kPasses = 2; // the normal turns under the point as it moves
    for (int pass = 0; pass < kPasses; ++pass) {
        const glm::dmat3 lean = lean_on(body, contact.at); // none of it is in the skin as placed
        const haptics::ContactRow row{.active = true,
                                      .tip_m = tip.centre_m,
                                      .surface_free_m =
                                          place_on(body, contact.at) + lean * contact.force_n,
                                      .normal = normal_on(body, contact.at),
                                      .tip_radius_m = tip.radius_m,
                                      .friction = body.material.friction,
                                      .law = law_on(body, contact.at, tool, rig.floor_mpn[tool])};
        const glm::dvec3 slip =
            haptics::predicted_slip(row, contact.own_compliance + lean, rig.memory[tool]);
        contact.at = carried(body, contact.at, slip, tip.centre_m).point;
    }
}

// Jaws that have just closed take the skin under them, as it was when they closed.
void close_jaws(TissueRig& rig, int tool, const haptics::ToolTip& tip) noexcept {
    const FemContact& contact = rig.contact[tool];
    const Body& body = rig.bodies[contact.body];
    const haptics::ContactRow row{.surface_free_m = place_on(body, contact.at),
                                  .normal = contact.normal,
                                  .tip_radius_m = tip.radius_m,
                                  .law = law_on(body, contact.at, tool, rig.floor_mpn[tool])};
    haptics::begin_grasp(row, tip.grip, rig.memory[tool]);
}

// The tools that have a row on one body.
struct RowsOf {
    std::array<int, kTools> tool{};
    std::size_t count = 0;
};

// How much of the answers of before still serves.
enum class Known { nothing, about, all };

Known what_is_known(const TissueRig& rig, const RowsOf& rows, const SoftBody& soft) noexcept {
    if (soft.answers != rows.count)
        return Known::nothing;
    for (std::size_t r = 0; r < rows.count; ++r) {
        const haptics::SurfacePoint &at = rig.contact[rows.tool[r]].at, &was = soft.answer_at[r];
        if (at.triangle != was.triangle || at.weight != was.weight)
            return Known::nothing;
    }
    if (soft.answers_of == soft.linearisations)
        return Known::all;
    // only quadratic steps correct afterwards what old answers to a change of force leave
    const bool serve = tissue::tier_of(soft.solid) == tissue::Tier::quadratic;
    return serve && soft.answers_age < kRowsAge &&
                   soft.moved_m - soft.answers_moved_m < kRowsDrift_m
               ? Known::all
               : Known::about;
}

// A^-1 H^T of the tools on a body.
void answer_rows(const TissueRig& rig, const RowsOf& rows, Body& body) noexcept {
    SoftBody& soft = *body.soft;
    const Known known = what_is_known(rig, rows, soft);
    ++soft.answers_age;
    if (known == Known::all)
        return;
    soft.answers_age = 0;
    soft.answers_moved_m = soft.moved_m;
    const std::size_t n = soft.motion_m.size();
    const std::span<double> block(soft.rows.data(), 3 * n * rows.count);
    std::fill(block.begin(), block.end(), 0.0);
    for (std::size_t r = 0; r < rows.count; ++r) {
        soft.answer_at[r] = rig.contact[rows.tool[r]].at;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            glm::dvec3 direction{0.0};
            direction[static_cast<int>(axis)] = 1.0;
            tissue::add_row(tissue::dofs(soft.solid), body.organ->surface,
                            tissue_point(soft.answer_at[r]), direction, 1.0,
                            block.subspan((3 * r + axis) * n, n));
        }
    }
    const std::span<const double> before(soft.answer_m.data(), block.size());
    tissue::solve(soft.solid, kRows, known == Known::about ? before : std::span<const double>{},
                  block, static_cast<int>(3 * rows.count));
    std::swap(soft.rows, soft.answer_m);
    soft.answers = rows.count;
    soft.answers_of = soft.linearisations;
}

void read_compliance(const TissueRig& rig, const RowsOf& rows, const Body& body,
                     haptics::ContactProblem& problem) noexcept {
    const SoftBody& soft = *body.soft;
    const std::size_t n = soft.motion_m.size();
    for (std::size_t r = 0; r < rows.count; ++r) {
        for (std::size_t c = 0; c < rows.count; ++c) {
            glm::dmat3& W = problem.compliance[rows.tool[r]][rows.tool[c]];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                W[static_cast<int>(axis)] =
                    tissue::row_value(tissue::dofs(soft.solid), body.organ->surface,
                                      tissue_point(rig.contact[rows.tool[r]].at),
                                      std::span(soft.answer_m).subspan((3 * c + axis) * n, n));
            }
        }
    }
}

// As the contact solve wants it; what is solved by iteration is so only up to its residual.
void make_symmetric(haptics::ContactProblem& problem) noexcept {
    for (int i = 0; i < kTools; ++i) {
        for (int j = 0; j <= i; ++j) {
            const glm::dmat3 mean =
                0.5 * (problem.compliance[i][j] + glm::transpose(problem.compliance[j][i]));
            problem.compliance[i][j] = mean;
            problem.compliance[j][i] = glm::transpose(mean);
        }
    }
}

} // namespace

void follow_contacts(TissueRig& rig, const ToolsNow& tools) noexcept {
    const double span_s = (rig.config.latency_periods + 2.0) * rig.config.step_s;
    for (int i = 0; i < kTools; ++i) {
        FemContact& contact = rig.contact[i];
        const haptics::ToolTip& tip = tools.tip[i];
        const double moved_m = contact.seen ? glm::distance(tip.centre_m, contact.last_tip_m) : 0.0;
        contact.speed_mps = moved_m / rig.config.step_s;
        const double reach_m = rig.config.reach_m + contact.speed_mps * span_s;
        contact.last_tip_m = tip.centre_m;
        contact.seen = true;
        const bool closes = std::exchange(contact.closing, tip.grip.closing) != tip.grip.closing &&
                            tip.grip.hold_n > 0.0;
        haptics::ContactMemory& memory = rig.memory[i];
        if (memory.grasped && (closes || !(tip.grip.hold_n > 0.0)))
            haptics::release_grasp(memory);
        const bool lost = memory.touching && !memory.grasped && contact.body >= 0 &&
                          is_off(rig.bodies[contact.body], tip, contact.at);
        if (contact.body < 0 || !memory.touching || lost) {
            find_nearest(rig, i, closes ? tip.grip.closed_at_m : tip.centre_m,
                         tip.radius_m + reach_m);
        } else if (!memory.grasped) {
            follow(rig, i, tip);
        }
        if (contact.body < 0)
            continue;
        contact.normal = normal_on(rig.bodies[contact.body], contact.at);
        if (closes)
            close_jaws(rig, i, tip);
    }
}

void condense_rows(TissueRig& rig, haptics::ContactProblem& problem) noexcept {
    for (auto& line : problem.compliance)
        line.fill(glm::dmat3{0.0});
    for (std::size_t b = 0; b < rig.bodies.size(); ++b) {
        if (!rig.bodies[b].soft)
            continue;
        RowsOf rows;
        for (int i = 0; i < kTools; ++i) {
            if (problem.row[i].active && rig.contact[i].body == static_cast<int>(b))
                rows.tool[rows.count++] = i;
        }
        if (rows.count == 0)
            continue;
        answer_rows(rig, rows, rig.bodies[b]);
        read_compliance(rig, rows, rig.bodies[b], problem);
    }
    if (rig.organs)
        brace_tools(rig, problem);
    make_symmetric(problem);
    // the free motion was under the forces of before: the skin free of them is this much farther
    for (int i = 0; i < kTools; ++i) {
        for (int j = 0; j < kTools; ++j)
            problem.row[i].surface_free_m += problem.compliance[i][j] * rig.contact[j].before_n;
    }
    // what leans acts between tool and skin, as the law does: the skin does not move by it
    for (int i = 0; i < kTools; ++i) {
        FemContact& contact = rig.contact[i];
        if (!problem.row[i].active)
            continue;
        contact.own_compliance = problem.compliance[i][i];
        problem.compliance[i][i] += lean_on(rig.bodies[contact.body], contact.at);
    }
}

void fill_rows(const TissueRig& rig, const ToolsNow& tools,
               haptics::ContactProblem& problem) noexcept {
    for (int i = 0; i < kTools; ++i) {
        const FemContact& contact = rig.contact[i];
        haptics::ContactRow& row = problem.row[i];
        row = {};
        if (contact.body < 0)
            continue;
        const Body& body = rig.bodies[contact.body];
        const bool still = !body.soft || body.soft->resting;
        const glm::dvec3 place = place_on(body, contact.at);
        const double gap_m =
            glm::dot(contact.normal, tools.tip[i].centre_m - place) - tools.tip[i].radius_m;
        // a skin that does not move cannot come to the tool: rows that are open stay open
        row.active = !still || gap_m < kOpenGap_m || rig.memory[i].grasped;
        row.tip_m = tools.tip[i].centre_m;
        row.tip_radius_m = tools.tip[i].radius_m;
        row.normal = contact.normal;
        row.friction = body.material.friction;
        row.hold_n = tools.tip[i].grip.hold_n;
        row.law = law_on(body, contact.at, i, rig.floor_mpn[i]);
        row.surface_free_m = place;
        if (!still) {
            row.surface_free_m +=
                tissue::row_value(tissue::dofs(body.soft->solid), body.organ->surface,
                                  tissue_point(contact.at), body.soft->motion_m);
        }
    }
}

void apply_forces(TissueRig& rig, const haptics::ContactProblem& problem,
                  const haptics::ContactSolution& solution) noexcept {
    for (std::size_t b = 0; b < rig.bodies.size(); ++b) {
        Body& body = rig.bodies[b];
        if (!body.soft)
            continue;
        SoftBody& soft = *body.soft;
        const std::size_t n = soft.motion_m.size();
        std::size_t column = 0;
        std::fill(soft.load_n.begin(), soft.load_n.end(), 0.0);
        for (int i = 0; i < kTools; ++i) {
            if (!problem.row[i].active || rig.contact[i].body != static_cast<int>(b))
                continue;
            const glm::dvec3 force = solution.force_n[i];
            const glm::dvec3 change = force - rig.contact[i].before_n;
            const double* x = soft.answer_m.data() + column * n;
            column += 3;
            if (force != glm::dvec3{0.0})
                tissue::add_row(tissue::dofs(soft.solid), body.organ->surface,
                                tissue_point(rig.contact[i].at), force, -1.0, soft.load_n);
            if (change == glm::dvec3{0.0})
                continue;
            for (std::size_t k = 0; k < n; ++k) {
                soft.motion_m[k] -= change.x * x[k] + change.y * x[n + k] + change.z * x[2 * n + k];
            }
        }
    }
}

void slide_contacts(TissueRig& rig, const haptics::ContactSolution& solution) noexcept {
    for (int i = 0; i < kTools; ++i) {
        FemContact& contact = rig.contact[i];
        contact.force_n = solution.force_n[i];
        if (contact.body < 0)
            continue;
        const Body& body = rig.bodies[contact.body];
        const haptics::WalkResult walked =
            carried(body, contact.at, solution.slip_m[i], contact.last_tip_m);
        contact.at = walked.point;
        if (walked.at_rim && rig.memory[i].grasped && solution.slip_m[i] != glm::dvec3{0.0})
            haptics::release_grasp(rig.memory[i]);
        contact.normal = normal_on(body, contact.at);
    }
}

} // namespace sim
