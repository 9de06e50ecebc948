// tissue/solver/single_factor.cpp
// From CHOLMOD's supernodes to lines of floats. Called at setup; the solve is in single_solve.cpp.
#include "tissue/solver/single_factor.h"

#include <algorithm>
#include <cblas.h>

namespace tissue {
namespace {

// In place, `rows` x `columns`, column-major: [L11; L21] becomes X = [I; L21] L11^-1, X L11 = [I;
// L21].
void divide_by_diagonal(double* block, int rows, int columns, std::vector<double>& own) {
    own.resize(static_cast<std::size_t>(columns) * columns);
    for (std::ptrdiff_t j = 0; j < columns; ++j) {
        double* column = block + j * rows;
        std::copy_n(column, columns, own.begin() + j * columns);
        std::fill_n(column, columns, 0.0);
        column[j] = 1.0;
    }
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasNoTrans, CblasNonUnit, rows, columns,
                1.0, own.data(), columns, block, rows);
}

} // namespace

SingleFactor make_single_factor(const Supernodes& nodes) {
    constexpr int kLanes = SingleFactor::kLanes, kColumns = SingleFactor::kColumns;
    std::vector<double> block, own;
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

        block.assign(nodes.value.begin() + nodes.value_start[s],
                     nodes.value.begin() + nodes.value_start[s] +
                         static_cast<std::ptrdiff_t>(rows) * columns);
        divide_by_diagonal(block.data(), rows, columns, own);
        for (int j = 0; j < columns; j += kColumns) {
            for (int line = j / kLanes; line < f.block.back().lines; ++line) {
                const int first = line * kLanes, count = std::min(kLanes, rows - first);
                for (int c = j; c < j + kColumns; ++c) {
                    SingleFactor::Line& to = f.value.emplace_back();
                    if (c >= columns)
                        continue;
                    const double* from =
                        block.data() + static_cast<std::ptrdiff_t>(c) * rows + first;
                    for (int k = 0; k < count; ++k)
                        to.lane[k] = static_cast<float>(from[k]);
                }
            }
        }
    }
    return f;
}

} // namespace tissue
