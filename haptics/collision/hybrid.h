// haptics/collision/hybrid.h
// A hash grid of box trees (Gregory, Lin, Gottschalk, Taylor 1999): the grid finds the few places
// that matter at once, a tree in each copes with many triangles there. Each triangle belongs to
// the cell its centre is in at setup, for good; where it goes, the cell's tree is listed. What is
// longer than a cell has a tree of its own beside the grid.
#pragma once

#include "haptics/collision/cell_table.h"
#include "haptics/collision/cell_walk.h"
#include "haptics/collision/item_box.h"
#include "haptics/collision/obb_tree.h"
#include "haptics/collision/seen_lately.h"

namespace haptics {

struct Hybrid {
    struct Cluster {
        ObbTree tree;                        // of many triangles; else empty
        std::vector<std::uint32_t> triangle; // of few; else empty
        std::vector<ItemBox> box;            // of each of the few
    };
    double wanted_m = 0.0;
    std::vector<Cluster> cluster;
    std::vector<ItemBox> box; // of each cluster
    CellTable table;          // its items are clusters
    ObbTree large;
};

Hybrid make_hybrid(const MeshView& mesh);

/// Measures trees and clusters anew, lists the clusters anew; no allocation.
void refit(Hybrid& hybrid, const MeshView& mesh) noexcept;

template <class Look> void visit(const Hybrid& hybrid, Reach& reach, Look&& look) {
    SeenLately seen;
    const double slack_m = cell_walk::slack_m(hybrid.table.largest_m, reach);
    walk_cells(hybrid.table, reach, [&](std::uint32_t cell) {
        count_cell(look);
        for (const CellTable::Entry& e : items_of(hybrid.table, cell)) {
            if (!seen.first_time(e.item))
                continue;
            count_box(look);
            if (!near(hybrid.box[e.item], reach, slack_m))
                continue;
            const Hybrid::Cluster& cluster = hybrid.cluster[e.item];
            visit(cluster.tree, reach, look);
            for (std::size_t i = 0; i < cluster.triangle.size(); ++i) {
                count_box(look);
                if (near(cluster.box[i], reach, slack_m))
                    look(cluster.triangle[i]);
            }
        }
    });
    visit(hybrid.large, reach, look);
}

} // namespace haptics
