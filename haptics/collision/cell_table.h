// haptics/collision/cell_table.h
// The occupied cells of a regular grid in a hash table, and which things lie in each: what the
// hash grid lists triangles in and the hybrid whole trees. Refilled in place after a deformation
// by a counting sort; nothing is allocated then, as the cells are made coarser rather than let
// the lists outgrow what setup reserved.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace haptics {

using CellPlace = std::array<std::int32_t, 3>;

struct CellRange { // both ends included
    CellPlace low{}, high{};
};

struct CellTable {
    struct Entry {
        std::uint64_t key = 0;
        std::uint32_t item = 0;
    };
    struct Cell {
        std::uint64_t key = 0;
        std::uint32_t first = 0; // of `entry`, up to the next cell's
    };
    glm::dvec3 low_m{0.0};  // corner of cell 0, 0, 0
    double cell_m = 1.0;    // side
    double fat_m = 0.0;     // things are listed as if they were this much larger
    CellPlace cells{};      // how many along each axis, 0: nothing is listed
    double largest_m = 0.0; // coordinate of anything listed
    // All as large as they will ever be, so that a copy has the same room.
    std::vector<Cell> cell;            // the occupied ones by hash, each once, and one beyond
    std::vector<Entry> entry;          // in the order of the cells
    std::vector<std::uint32_t> bucket; // first cell of each hash value, and one beyond
    std::vector<Entry> unsorted;
    std::uint32_t entries = 0;  // used of `entry` and `unsorted`
    std::uint32_t occupied = 0; // used of `cell`, without the one beyond
};

struct ItemBox {
    glm::dvec3 low_m{0.0}, high_m{0.0}; // low > high: nothing to list
};

/// Setup. Room for `items` things in sixteen cells each, on average.
CellTable make_cell_table(std::size_t items);

/// Empties the table and lays out cells of `wanted_m`, or as much larger as is needed so that the
/// cells which the boxes overlap fit into the table. Real-time safe, linear.
void lay_out(CellTable& table, std::span<const ItemBox> box, double wanted_m) noexcept;

/// The cells that a box overlaps, fattened.
CellRange cells_of(const CellTable& table, const ItemBox& box) noexcept;

/// Lists a thing in a cell of its box. Real-time safe.
void list_item(CellTable& table, const CellPlace& place, std::uint32_t item) noexcept;

/// Sorts what was listed. Real-time safe, linear.
void finish(CellTable& table) noexcept;

inline std::uint64_t cell_key(const CellPlace& p) noexcept {
    return static_cast<std::uint64_t>(p[0]) | static_cast<std::uint64_t>(p[1]) << 21 |
           static_cast<std::uint64_t>(p[2]) << 42;
}

inline CellPlace place_of(std::uint64_t key) noexcept {
    constexpr std::uint64_t kMask = 0x1fffff;
    return {static_cast<std::int32_t>(key & kMask), static_cast<std::int32_t>(key >> 21 & kMask),
            static_cast<std::int32_t>(key >> 42)};
}

inline std::size_t hash_of(const CellTable& table, std::uint64_t key) noexcept {
    return (key * 0x9e3779b97f4a7c15u) >> 32 & (table.bucket.size() - 2); // a power of two, and 1
}

/// Number of a cell in the table; `occupied` if nothing is in it.
inline std::uint32_t find_cell(const CellTable& table, const CellPlace& place) noexcept {
    const std::uint64_t key = cell_key(place);
    const std::size_t hash = hash_of(table, key);
    for (std::uint32_t c = table.bucket[hash]; c < table.bucket[hash + 1]; ++c)
        if (table.cell[c].key == key)
            return c;
    return table.occupied;
}

inline std::span<const CellTable::Entry> items_of(const CellTable& table,
                                                  std::uint32_t cell) noexcept {
    const std::uint32_t first = table.cell[cell].first;
    return {table.entry.data() + first, table.cell[cell + 1].first - first};
}

} // namespace haptics
