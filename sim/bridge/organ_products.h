// sim/bridge/organ_products.h
// What organ_contact.cpp and organ_brace.cpp share: rows between bodies in play, and products with
// their compliance. Tissue loop.
#pragma once

#include "sim/bridge/organ_contact.h"
#include "sim/loop/tissue_loop.h"

namespace sim {

inline constexpr int kMostProducts = 60;

inline bool pushes(const OrganRow& row) noexcept {
    return row.force_n > 0.0;
}

// Marks whatever is connected to what is marked, by rows that `link`.
template <class Link>
void spread(std::span<const Body> bodies, std::span<const OrganRow> rows, Link link,
            std::span<std::uint8_t> marked) noexcept {
    for (bool grew = true; grew;) {
        grew = false;
        for (const OrganRow& row : rows) {
            const std::int32_t a = row.vertex_of, b = row.skin_of;
            if (marked[a] == marked[b] || !bodies[a].soft || !bodies[b].soft || !link(row))
                continue;
            marked[a] = marked[b] = 1;
            grew = true;
        }
    }
}

/// n . (motion of the vertex - motion of what it is over), for motions of both bodies; empty: none.
double opens_m(std::span<const Body> bodies, const OrganRow& row, std::span<const double> own,
               std::span<const double> other) noexcept;

/// The load of a row's force on the unknowns of one of its bodies.
void add_push(std::span<const Body> bodies, const OrganRow& row, std::size_t body, double force_n,
              std::span<double> load_n) noexcept;

/// The rows between bodies in play, of all or of those that push.
void gather(std::span<const Body> bodies, bool all, OrganContact& organs) noexcept;

/// out = (S W S + 1) d, `columns` numbers for each row; the motions stay in organs.load.
void multiply(TissueRig& rig, OrganContact& organs, std::size_t columns, std::span<const double> d,
              std::span<double> out) noexcept;

/// Adds the motions of the last product of one column.
void move(TissueRig& rig, const OrganContact& organs, double share) noexcept;

/// From organs.y to the rows.
void put_forces(OrganContact& organs) noexcept;

} // namespace sim
