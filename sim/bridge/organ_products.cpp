#include "sim/bridge/organ_products.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace sim {
namespace {

constexpr double kColumn = 1e-3; // of solves by iteration

std::size_t unknowns_of(const Body& body) noexcept {
    return body.soft->motion_m.size();
}

bool has_rows(const OrganContact& organs, std::size_t body) noexcept {
    for (const std::uint32_t r : organs.row) {
        const OrganRow& row = organs.rows.row[r];
        if (row.vertex_of == static_cast<std::int32_t>(body) ||
            row.skin_of == static_cast<std::int32_t>(body))
            return true;
    }
    return false;
}

} // namespace

double opens_m(std::span<const Body> bodies, const OrganRow& row, std::span<const double> own,
               std::span<const double> other) noexcept {
    const Body &a = bodies[row.vertex_of], &b = bodies[row.skin_of];
    double sum = 0.0;
    if (!own.empty()) {
        const tissue::Dofs dofs = tissue::dofs(a.soft->solid);
        sum += glm::dot(row.normal, tissue::vertex_value(dofs, a.organ->surface, row.vertex, own)) +
               tissue::turn_value(dofs, row.own_turn, own);
    }
    if (!other.empty()) {
        const tissue::Dofs dofs = tissue::dofs(b.soft->solid);
        sum -= glm::dot(row.normal, tissue::row_value(dofs, b.organ->surface, row.at, other));
        for (int k = 0; k < 3; ++k)
            sum -= row.at.weight[k] * tissue::turn_value(dofs, row.at_turn[k], other);
    }
    return sum;
}

void add_push(std::span<const Body> bodies, const OrganRow& row, std::size_t body, double force_n,
              std::span<double> load_n) noexcept {
    const Body& on = bodies[body];
    const tissue::Dofs dofs = tissue::dofs(on.soft->solid);
    if (row.vertex_of == static_cast<std::int32_t>(body)) {
        tissue::add_vertex_row(dofs, on.organ->surface, row.vertex, force_n * row.normal, load_n);
        tissue::add_turn(dofs, row.own_turn, force_n, load_n);
        return;
    }
    tissue::add_row(dofs, on.organ->surface, row.at, row.normal, -force_n, load_n);
    for (int k = 0; k < 3; ++k)
        tissue::add_turn(dofs, row.at_turn[k], -force_n * row.at.weight[k], load_n);
}

void gather(std::span<const Body> bodies, bool all, OrganContact& organs) noexcept {
    organs.row.clear();
    for (std::uint32_t r = 0; r < organs.rows.row.size(); ++r) {
        const OrganRow& row = organs.rows.row[r];
        const bool moves = (bodies[row.vertex_of].soft && organs.in_play[row.vertex_of]) ||
                           (bodies[row.skin_of].soft && organs.in_play[row.skin_of]);
        if (!moves || !(all || pushes(row)))
            continue;
        const std::size_t k = organs.row.size();
        organs.row.push_back(r);
        organs.scale[k] = std::sqrt(row.stiffness_npm);
        organs.weight[k] = row.share / organs.scale[k];
        organs.y[k] = row.force_n / organs.scale[k];
    }
}

void multiply(TissueRig& rig, OrganContact& organs, std::size_t columns, std::span<const double> d,
              std::span<double> out) noexcept {
    for (std::size_t b = 0; b < rig.bodies.size(); ++b) {
        Body& body = rig.bodies[b];
        if (!body.soft || !has_rows(organs, b))
            continue;
        const std::size_t n = unknowns_of(body);
        const std::span<double> block = std::span(organs.load[b]).first(columns * n);
        std::fill(block.begin(), block.end(), 0.0);
        for (std::size_t k = 0; k < organs.row.size(); ++k) {
            const OrganRow& row = organs.rows.row[organs.row[k]];
            if (row.vertex_of != static_cast<std::int32_t>(b) &&
                row.skin_of != static_cast<std::int32_t>(b))
                continue;
            for (std::size_t c = 0; c < columns; ++c) {
                if (const double y = d[k * columns + c]; y != 0.0)
                    add_push(rig.bodies, row, b, organs.scale[k] * y, block.subspan(c * n, n));
            }
        }
        tissue::solve(body.soft->solid, kColumn, {}, block, static_cast<int>(columns));
        ++organs.solves;
    }
    const auto column_of = [&](std::int32_t b, std::size_t c) {
        const Body& body = rig.bodies[b];
        if (!body.soft)
            return std::span<const double>{};
        const std::size_t n = unknowns_of(body);
        return std::span<const double>(organs.load[b]).subspan(c * n, n);
    };
    for (std::size_t k = 0; k < organs.row.size(); ++k) {
        const OrganRow& row = organs.rows.row[organs.row[k]];
        for (std::size_t c = 0; c < columns; ++c) {
            out[k * columns + c] =
                d[k * columns + c] + organs.scale[k] * opens_m(rig.bodies, row,
                                                               column_of(row.vertex_of, c),
                                                               column_of(row.skin_of, c));
        }
    }
}

void move(TissueRig& rig, const OrganContact& organs, double share) noexcept {
    for (std::size_t b = 0; b < rig.bodies.size(); ++b) {
        if (!rig.bodies[b].soft || !has_rows(organs, b))
            continue;
        std::vector<double>& motion_m = rig.bodies[b].soft->motion_m;
        for (std::size_t k = 0; k < motion_m.size(); ++k)
            motion_m[k] += share * organs.load[b][k];
    }
}

void put_forces(OrganContact& organs) noexcept {
    for (std::size_t k = 0; k < organs.row.size(); ++k)
        organs.rows.row[organs.row[k]].force_n = organs.scale[k] * organs.y[k];
}

} // namespace sim
