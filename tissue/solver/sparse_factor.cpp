// tissue/solver/sparse_factor.cpp
// The one place that knows CHOLMOD (Chen, Davis, Hager & Rajamanickam 2008). Tissue loop and
// bake; an object belongs to one thread at a time.
#include "tissue/solver/sparse_factor.h"

#include <algorithm>
#include <cblas.h>
#include <cholmod.h>
#include <cmath>
#include <omp.h>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

// CHOLMOD asks OpenMP for four threads by name; at nesting depth 0 every region runs on the
// caller alone. Per thread, hence before every use.
void stay_on_this_thread() noexcept {
    omp_set_max_active_levels(0);
}

const char* word(int status) noexcept {
    switch (status) {
    case CHOLMOD_OUT_OF_MEMORY:
        return "out of memory";
    case CHOLMOD_TOO_LARGE:
        return "problem too large";
    case CHOLMOD_INVALID:
        return "invalid input";
    case CHOLMOD_NOT_INSTALLED:
        return "method not installed";
    default:
        return "failed";
    }
}

} // namespace

struct SparseFactor::Impl {
    cholmod_common common{};
    std::vector<int> column_start, row; // own copy: `matrix` points into them
    cholmod_sparse matrix{};
    cholmod_factor* factor = nullptr;
    cholmod_dense *solution = nullptr, *work_y = nullptr, *work_e = nullptr; // kept by solve2
    bool usable = false;

    explicit Impl(const SparsePattern& pattern)
        : column_start(pattern.column_start), row(pattern.row) {
        openblas_set_num_threads(1);
        stay_on_this_thread();
        cholmod_start(&common);
        common.print = 0;
        common.supernodal = CHOLMOD_SUPERNODAL;
        common.nmethods = 1;
        common.method[0].ordering = CHOLMOD_AMD;
        common.postorder = 1;
        common.quick_return_if_not_posdef = 1;

        matrix.nrow = matrix.ncol = static_cast<std::size_t>(pattern.size);
        matrix.nzmax = row.size();
        matrix.p = column_start.data();
        matrix.i = row.data();
        matrix.stype = -1; // lower triangle
        matrix.itype = CHOLMOD_INT;
        matrix.xtype = CHOLMOD_PATTERN;
        matrix.dtype = CHOLMOD_DOUBLE;
        matrix.sorted = matrix.packed = 1;
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        cholmod_free_dense(&solution, &common);
        cholmod_free_dense(&work_y, &common);
        cholmod_free_dense(&work_e, &common);
        cholmod_free_factor(&factor, &common);
        cholmod_finish(&common);
    }
};

SparseFactor::SparseFactor(const SparsePattern& pattern) : impl_(std::make_unique<Impl>(pattern)) {
    impl_->factor = cholmod_analyze(&impl_->matrix, &impl_->common);
    if (impl_->factor == nullptr) {
        throw std::runtime_error("CHOLMOD analysis of " + std::to_string(pattern.size) +
                                 " unknowns: " + word(impl_->common.status));
    }
    impl_->matrix.xtype = CHOLMOD_REAL;
}
SparseFactor::~SparseFactor() = default;
SparseFactor::SparseFactor(SparseFactor&&) noexcept = default;
SparseFactor& SparseFactor::operator=(SparseFactor&&) noexcept = default;

bool SparseFactor::factor(std::span<const double> values) noexcept {
    Impl& s = *impl_;
    // LAPACK lets a NaN pivot through: it is not <= 0
    s.usable = std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    if (!s.usable)
        return false;
    stay_on_this_thread();
    s.matrix.x = const_cast<double*>(values.data()); // CHOLMOD reads only
    s.common.status = CHOLMOD_OK;
    const int done = cholmod_factorize(&s.matrix, s.factor, &s.common);
    s.usable = done != 0 && s.common.status == CHOLMOD_OK && s.factor->minor == s.factor->n;
    return s.usable;
}

void SparseFactor::solve(std::span<double> b, int columns) noexcept {
    Impl& s = *impl_;
    if (!s.usable || columns < 1)
        return;
    stay_on_this_thread();
    cholmod_dense right{};
    right.nrow = right.d = s.factor->n;
    right.ncol = static_cast<std::size_t>(columns);
    right.nzmax = right.nrow * right.ncol;
    right.x = b.data();
    right.xtype = CHOLMOD_REAL;
    right.dtype = CHOLMOD_DOUBLE;
    if (cholmod_solve2(CHOLMOD_A, s.factor, &right, nullptr, &s.solution, nullptr, &s.work_y,
                       &s.work_e, &s.common) == 0) {
        return;
    }
    const auto* x = static_cast<const double*>(s.solution->x);
    std::copy(x, x + right.nzmax, b.begin());
}

std::int64_t SparseFactor::factor_entries() const noexcept {
    return static_cast<std::int64_t>(impl_->factor->xsize);
}

void multiply(const SparsePattern& pattern, std::span<const double> values,
              std::span<const double> x, std::span<double> y) noexcept {
    std::fill(y.begin(), y.end(), 0.0);
    for (int c = 0; c < pattern.size; ++c) {
        int k = pattern.column_start[c];
        const int end = pattern.column_start[c + 1];
        double sum = values[k] * x[c]; // diagonal first
        for (++k; k < end; ++k) {
            const int r = pattern.row[k];
            sum += values[k] * x[r];
            y[r] += values[k] * x[c];
        }
        y[c] += sum;
    }
}

std::string blas_name() { return openblas_get_config(); }

} // namespace tissue
