// tissue/solver/sparse_factor.h
// Symmetric sparse systems by CHOLMOD's supernodal Cholesky on one BLAS thread. Analysed once,
// refactored as values change. The only file that includes CHOLMOD is the .cpp beside this one.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tissue {

/// Lower triangle, compressed columns, rows ascending, diagonal first in each column.
struct SparsePattern {
    int size = 0;
    std::vector<int> column_start; // size + 1
    std::vector<int> row;
};

/// L of the last factorisation, P A P^T = L L^T, as dense column-major blocks: block s has columns
/// [first[s], first[s + 1]) and as many rows as row[row_start[s]..row_start[s + 1]) names, first
/// its own columns. Above the diagonal of a block stands no number of meaning.
struct Supernodes {
    std::vector<int> order; // unknown that is eliminated k-th
    std::vector<int> first, row_start, value_start;
    std::vector<int> row;
    std::vector<double> value;
};

/// Loads on a few unknowns each; what is named twice in a column adds up.
struct SparseColumns {
    std::vector<std::size_t> start{0}; // columns + 1
    std::vector<int> unknown;
    std::vector<double> value;

    void add(int at, double load) {
        unknown.push_back(at);
        value.push_back(load);
    }
    void end_column() { start.push_back(unknown.size()); }
};

class SparseFactor {
  public:
    /// Orders (AMD) and analyses. Throws std::runtime_error with CHOLMOD's word for it.
    explicit SparseFactor(const SparsePattern& pattern);
    ~SparseFactor();
    SparseFactor(SparseFactor&&) noexcept;
    SparseFactor& operator=(SparseFactor&&) noexcept;

    /// False if the matrix is not positive definite; the factor is then unusable.
    bool factor(std::span<const double> values) noexcept;

    /// Solves A X = B in place, `columns` right-hand sides stored one after the other. False, and
    /// `b` unchanged, without a usable factor.
    bool solve(std::span<double> b, int columns) noexcept;

    /// out[c] = b_c^T A^-1 b_c, half of a solve. False, and `out` unchanged, without a usable
    /// factor. Columns that load the same part of a body side by side cost least. Allocates.
    /// Several threads may ask one object at once while none factors or solves.
    bool compliances(const SparseColumns& b, std::span<double> out) const;

    /// The same of columns 3 i, 3 i + 1, 3 i + 2 with each other:
    /// out[i] = {00, 11, 22, 12, 02, 01}.
    bool compliances(const SparseColumns& b, std::span<std::array<double, 6>> out) const;

    std::int64_t factor_entries() const noexcept; // stored, explicit zeros too

    /// A copy of the factor, for those who solve in their own way. At setup. Throws
    /// std::runtime_error without a usable factor.
    Supernodes supernodes() const;

  private:
    struct Impl;
    struct Descent;
    std::unique_ptr<Impl> impl_;
};

/// Name and build of the BLAS under the factor, for the logbook: bits depend on it.
std::string blas_name();

/// y = A x for the full symmetric matrix. Sizes must fit.
void multiply(const SparsePattern& pattern, std::span<const double> values,
              std::span<const double> x, std::span<double> y) noexcept;

} // namespace tissue
