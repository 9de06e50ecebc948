// tissue/solver/single_factor.cpp
// From CHOLMOD's supernodes to lines of floats. Called at setup; the solve is in single_solve.cpp.
#include "tissue/solver/single_factor.h"

#include <algorithm>

namespace tissue {
namespace {

// In place, `rows` x `columns`, column-major: [L11; L21] becomes [I; L21] L11^-1. Column by column
// from the last: X L11 = [I; L21] gives X_j = ([I; L21]_j - sum_k>j X_k L11_kj) / L11_jj.
void divide_by_diagonal(double* block, int rows, int columns) {
    std::vector<double> own(static_cast<std::size_t>(columns) * columns);
    for (int j = 0; j < columns; ++j) {
        std::copy_n(block + j * rows, columns, own.begin() + j * columns);
        std::fill_n(block + j * rows, columns, 0.0);
        block[j * rows + j] = 1.0;
    }
    for (int j = columns - 1; j >= 0; --j) {
        for (int k = j + 1; k < columns; ++k) {
            const double factor = own[j * columns + k];
            for (int r = 0; r < rows; ++r)
                block[j * rows + r] -= factor * block[k * rows + r];
        }
        for (int r = 0; r < rows; ++r)
            block[j * rows + r] /= own[j * columns + j];
    }
}

} // namespace

SingleFactor make_single_factor(const Supernodes& nodes) {
    constexpr int kLanes = SingleFactor::kLanes, kColumns = SingleFactor::kColumns;
    SingleFactor f;
    f.size = static_cast<int>(nodes.order.size());
    f.order = nodes.order;
    for (std::size_t s = 0; s + 1 < nodes.first.size(); ++s) {
        const int rows = nodes.row_start[s + 1] - nodes.row_start[s];
        const int columns = nodes.first[s + 1] - nodes.first[s];
        f.block.push_back({nodes.first[s], columns, static_cast<int>(f.row.size()), rows - columns,
                           (rows + kLanes - 1) / kLanes, f.value.size()});
        f.most_lines = std::max(f.most_lines, f.block.back().lines);
        const auto names = nodes.row.begin() + nodes.row_start[s];
        f.row.insert(f.row.end(), names + columns, names + rows);

        std::vector<double> block(nodes.value.begin() + nodes.value_start[s],
                                  nodes.value.begin() + nodes.value_start[s] +
                                      static_cast<std::ptrdiff_t>(rows) * columns);
        divide_by_diagonal(block.data(), rows, columns);
        for (int j = 0; j < columns; j += kColumns) {
            for (int line = j / kLanes; line < f.block.back().lines; ++line) {
                for (int c = j; c < j + kColumns; ++c) {
                    SingleFactor::Line to;
                    for (int k = 0; k < kLanes; ++k) {
                        const int r = line * kLanes + k;
                        if (c < columns && r < rows)
                            to.lane[k] = static_cast<float>(block[c * rows + r]);
                    }
                    f.value.push_back(to);
                }
            }
        }
    }
    return f;
}

} // namespace tissue
