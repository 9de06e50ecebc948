#include "haptics/collision/cell_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace haptics {
namespace {

using glm::dvec3;
using Entry = CellTable::Entry;

constexpr double kMostAlong = 1 << 20; // cells along an axis: three of them make a key
constexpr double kCoarser = 1.5;

bool listed(const ItemBox& box) noexcept {
    return box.low_m.x <= box.high_m.x;
}

void set_cells(CellTable& table, const ItemBox& all, double cell_m) noexcept {
    table.cell_m = cell_m;
    table.fat_m =
        std::max(cell_m / 32.0, 256.0 * std::numeric_limits<double>::epsilon() * table.largest_m);
    table.low_m = all.low_m - table.fat_m;
    const dvec3 size = (all.high_m - all.low_m) + 2.0 * table.fat_m;
    for (int k = 0; k < 3; ++k)
        table.cells[k] = static_cast<std::int32_t>(size[k] / cell_m) + 1;
}

/// Whether all the cells of all boxes fit.
bool fits(const CellTable& table, std::span<const ItemBox> box) noexcept {
    double all = 0.0;
    for (const ItemBox& b : box) {
        if (!listed(b))
            continue;
        const CellRange r = cells_of(table, b);
        double count = 1.0;
        for (int k = 0; k < 3; ++k)
            count *= r.high[k] - r.low[k] + 1;
        all += count;
    }
    return all <= static_cast<double>(table.entry.size());
}

/// By key, then by the order they came in.
void sort_bucket(std::span<Entry> all) noexcept {
    const auto before = [](const Entry& a, const Entry& b) {
        return a.key != b.key ? a.key < b.key : a.item < b.item;
    };
    if (!std::is_sorted(all.begin(), all.end(), before))
        std::sort(all.begin(), all.end(), before);
}

} // namespace

CellTable make_cell_table(std::size_t items) {
    CellTable table;
    const std::size_t room = 16 * items + 64;
    table.entry.resize(room);
    table.unsorted.resize(room);
    table.cell.resize(room + 1);
    table.bucket.resize(std::bit_ceil(4 * items + 2) + 1);
    return table;
}

void lay_out(CellTable& table, std::span<const ItemBox> box, double wanted_m) noexcept {
    ItemBox all{dvec3{std::numeric_limits<double>::infinity()},
                dvec3{-std::numeric_limits<double>::infinity()}};
    for (const ItemBox& b : box) {
        if (!listed(b))
            continue;
        all.low_m = glm::min(all.low_m, b.low_m);
        all.high_m = glm::max(all.high_m, b.high_m);
    }
    table.entries = table.occupied = 0;
    table.cells = {};
    table.largest_m = 0.0;
    if (!listed(all))
        return;
    const dvec3 far = glm::max(glm::abs(all.low_m), glm::abs(all.high_m));
    table.largest_m = std::max({far.x, far.y, far.z});
    const dvec3 size = all.high_m - all.low_m;
    double cell_m =
        std::max({wanted_m, std::max({size.x, size.y, size.z}) / kMostAlong,
                  1024.0 * std::numeric_limits<double>::epsilon() * table.largest_m,
                  std::numeric_limits<double>::min()}); // all at the origin: any size will do
    // in one cell as large as all they are one entry each: this ends
    for (set_cells(table, all, cell_m); !fits(table, box); set_cells(table, all, cell_m))
        cell_m *= kCoarser;
}

CellRange cells_of(const CellTable& table, const ItemBox& box) noexcept {
    CellRange out;
    for (int k = 0; k < 3; ++k) {
        const double last = table.cells[k] - 1;
        const double low = (box.low_m[k] - table.fat_m - table.low_m[k]) / table.cell_m;
        const double high = (box.high_m[k] + table.fat_m - table.low_m[k]) / table.cell_m;
        out.low[k] = static_cast<std::int32_t>(std::clamp(low, 0.0, last));
        out.high[k] = static_cast<std::int32_t>(std::clamp(high, 0.0, last));
    }
    return out;
}

void list_item(CellTable& table, const CellPlace& place, std::uint32_t item) noexcept {
    table.unsorted[table.entries++] = {cell_key(place), item}; // there is room: see lay_out
}

void finish(CellTable& table) noexcept {
    std::fill(table.bucket.begin(), table.bucket.end(), 0u);
    for (std::uint32_t i = 0; i < table.entries; ++i)
        ++table.bucket[hash_of(table, table.unsorted[i].key) + 1];
    for (std::size_t b = 1; b < table.bucket.size(); ++b)
        table.bucket[b] += table.bucket[b - 1];
    for (std::uint32_t i = table.entries; i-- > 0;) { // backwards: ends become beginnings, in order
        const Entry& e = table.unsorted[i];
        table.entry[--table.bucket[hash_of(table, e.key) + 1]] = e;
    }
    // bucket[b + 1] is now where the entries of b begin; from here on bucket[b] is its first cell
    const std::size_t buckets = table.bucket.size() - 1;
    for (std::size_t b = 0; b < buckets; ++b) {
        const std::uint32_t first = table.bucket[b + 1];
        const std::uint32_t end = b + 2 <= buckets ? table.bucket[b + 2] : table.entries;
        sort_bucket(std::span(table.entry).subspan(first, end - first));
        table.bucket[b] = table.occupied;
        for (std::uint32_t i = first; i < end; ++i)
            if (i == first || table.entry[i].key != table.entry[i - 1].key)
                table.cell[table.occupied++] = {table.entry[i].key, i};
    }
    table.bucket[buckets] = table.occupied;
    table.cell[table.occupied] = {0, table.entries};
}

} // namespace haptics
