// haptics/collision/hash_grid.h
// Triangles in the cells of a hash grid, cells as long as the mesh's edges on average (Gregory,
// Lin, Gottschalk, Taylor 1999, A Framework for Fast and Accurate Collision Detection for Haptic
// Interaction). Good for triangles of one size; long ones lie in many cells.
#pragma once

#include "haptics/collision/cell_table.h"
#include "haptics/collision/cell_walk.h"
#include "haptics/collision/counted.h"
#include "haptics/collision/item_box.h"
#include "haptics/collision/mesh_view.h"
#include "haptics/collision/seen_lately.h"

namespace haptics {

struct HashGrid {
    double wanted_m = 0.0; // cell size: the average edge at setup
    CellTable table;
    std::vector<ItemBox> box; // of each triangle, both ends of the interval
};

/// Setup. `mesh` as index.h checks it.
HashGrid make_hash_grid(const MeshView& mesh);

/// Lists the triangles anew: linear, no allocation. If they have grown so much that their cells
/// outnumber what setup reserved, 16 to a triangle, the cells grow too.
void refit(HashGrid& grid, const MeshView& mesh) noexcept;

template <class Look> void visit(const HashGrid& grid, Reach& reach, Look&& look) {
    SeenLately seen;
    const double slack_m = cell_walk::slack_m(grid.table.largest_m, reach);
    walk_cells(grid.table, reach, [&](std::uint32_t cell) {
        count_cell(look);
        for (const CellTable::Entry& e : items_of(grid.table, cell)) {
            if (!seen.first_time(e.item))
                continue;
            count_box(look);
            if (near(grid.box[e.item], reach, slack_m))
                look(e.item);
        }
    });
}

} // namespace haptics
