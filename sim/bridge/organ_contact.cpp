#include "sim/bridge/organ_products.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace sim {
namespace {

constexpr double kBalance_m = 0.5e-6; // of gaps: of what a pressure of E leaves, 1/200

// What tools on soft bodies may move, and all that is in its way.
void mark_awake(const TissueRig& rig, OrganContact& organs) noexcept {
    for (std::size_t b = 0; b < rig.bodies.size(); ++b)
        organs.in_play[b] = rig.bodies[b].soft && !rig.bodies[b].soft->resting;
    spread(
        rig.bodies, organs.rows.row, [](const OrganRow&) { return true; }, organs.in_play);
}

} // namespace

OrganContact make_organ_contact(std::span<const Body> bodies) {
    OrganContact organs;
    organs.rows = make_organ_rows(bodies);
    organs.in_play.assign(bodies.size(), 0);
    organs.row.reserve(kMostRows);
    const std::vector<double> one(kMostRows), many(kMostRows * kToolColumns);
    organs.scale = organs.y = organs.gradient = organs.weight = one;
    organs.open = organs.brace = organs.residual = organs.direction = organs.product = many;
    for (const Body& body : bodies)
        organs.load.emplace_back(body.soft ? kToolColumns * body.soft->motion_m.size() : 0);
    organs.scratch = tissue::make_unilateral_scratch(kMostRows);
    return organs;
}

void meet_organs(TissueRig& rig) noexcept {
    std::vector<double>& tool_m = rig.organs->rows.tool_m;
    std::fill(tool_m.begin(), tool_m.end(), 0.0);
    for (int i = 0; i < kTools; ++i) {
        const FemContact& contact = rig.contact[i];
        if (contact.body < 0 || !rig.bodies[contact.body].soft)
            continue;
        const double step_m = contact.speed_mps * rig.config.step_s;
        const double away_m =
            glm::distance(contact.last_tip_m, place_on(rig.bodies[contact.body], contact.at));
        if (rig.memory[i].touching ||
            away_m < 2.0 * step_m + rig.bodies[contact.body].tip[i].radius_m)
            tool_m[contact.body] = std::max(tool_m[contact.body], step_m);
    }
    find_organ_rows(rig.bodies, rig.organs->rows);
}

void push_organs(TissueRig& rig) noexcept {
    OrganContact& organs = *rig.organs;
    if (organs.rows.row.empty())
        return;
    mark_awake(rig, organs);
    gather(rig.bodies, true, organs);
    const std::size_t rows = organs.row.size();
    if (rows == 0)
        return;
    const auto motion_of = [&](std::int32_t b) {
        return rig.bodies[b].soft ? std::span<const double>(rig.bodies[b].soft->motion_m)
                                  : std::span<const double>{};
    };
    for (std::size_t k = 0; k < rows; ++k) {
        const OrganRow& row = organs.rows.row[organs.row[k]];
        const double gap_m =
            row.gap_m + opens_m(rig.bodies, row, motion_of(row.vertex_of), motion_of(row.skin_of));
        organs.gradient[k] = organs.scale[k] * gap_m + organs.y[k];
    }
    struct Pushed {
        TissueRig& rig;
        OrganContact& organs;
        void product(std::span<const double> d, std::span<double> out) noexcept {
            multiply(rig, organs, 1, d, out);
        }
        void move(double share) noexcept { sim::move(rig, organs, share); }
    };
    const tissue::UnilateralReport report = tissue::solve_unilateral(
        Pushed{rig, organs}, std::span(organs.weight).first(rows), kBalance_m, kMostProducts,
        organs.scratch, std::span(organs.y).first(rows), std::span(organs.gradient).first(rows));
    organs.residual_m = report.residual;
    put_forces(organs);
}

bool is_pushed(const TissueRig& rig, std::size_t body) noexcept {
    const auto b = static_cast<std::int32_t>(body);
    return std::any_of(rig.organs->rows.row.begin(), rig.organs->rows.row.end(),
                       [b](const OrganRow& row) {
                           return pushes(row) && (row.vertex_of == b || row.skin_of == b);
                       });
}

bool add_organ_load(const TissueRig& rig, std::size_t body, std::span<double> load_n) noexcept {
    bool any = false;
    for (const OrganRow& row : rig.organs->rows.row) {
        if (!pushes(row) || (row.vertex_of != static_cast<std::int32_t>(body) &&
                             row.skin_of != static_cast<std::int32_t>(body)))
            continue;
        any = true;
        add_push(rig.bodies, row, body, row.force_n, load_n);
    }
    return any;
}

void keep_organ_forces(TissueRig& rig) noexcept {
    OrganContact& organs = *rig.organs;
    for (SkinPair& pair : organs.rows.pair) {
        for (std::size_t r = pair.first; r < pair.first + pair.count; ++r)
            pair.force_n[organs.rows.row[r].vertex] = organs.rows.row[r].force_n;
    }
    for (std::size_t b = 0; b < rig.bodies.size(); ++b)
        organs.in_play[b] = rig.bodies[b].soft && !rig.bodies[b].soft->resting;
    spread(rig.bodies, organs.rows.row, pushes, organs.in_play);
    for (std::size_t b = 0; b < rig.bodies.size(); ++b) {
        if (rig.bodies[b].soft && organs.in_play[b])
            rig.bodies[b].soft->resting = false;
    }
}

void rest_together(const TissueRig& rig, std::span<std::uint8_t> rests) noexcept {
    for (bool again = true; again;) {
        again = false;
        for (const OrganRow& row : rig.organs->rows.row) {
            const std::int32_t a = row.vertex_of, b = row.skin_of;
            if (!pushes(row) || !rig.bodies[a].soft || !rig.bodies[b].soft || rests[a] == rests[b])
                continue;
            rests[a] = rests[b] = 0;
            again = true;
        }
    }
}

void add_organ_residual(TissueRig& rig, haptics::LocalModels& local) noexcept {
    OrganContact& organs = *rig.organs;
    for (int i = 0; i < kTools; ++i) {
        const int b = rig.contact[i].body;
        bool seen = b < 0 || !rig.bodies[b].soft;
        for (int j = 0; j < i; ++j)
            seen |= rig.contact[j].body == b;
        if (seen)
            continue;
        const std::size_t n = rig.bodies[b].soft->motion_m.size();
        const std::span<double> load = std::span(organs.load[b]).first(n);
        std::fill(load.begin(), load.end(), 0.0);
        if (!add_organ_load(rig, static_cast<std::size_t>(b), load))
            continue;
        const std::span<const double> shape(rig.bodies[b].soft->basis.shape);
        for (int m = 0; m < local.tool[i].modes; ++m)
            local.residual[local.tool[i].first_mode + m] -=
                tissue::product_of(load, shape.subspan(static_cast<std::size_t>(m) * n, n));
    }
}

} // namespace sim
