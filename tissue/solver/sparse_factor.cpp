// tissue/solver/sparse_factor.cpp
// The one place that knows CHOLMOD (Chen, Davis, Hager & Rajamanickam 2008). Tissue loop and
// bake; an object belongs to one thread at a time.
#include "tissue/solver/sparse_factor.h"

#include "tissue/solver/supernode_solve.h"

#include <algorithm>
#include <cblas.h>
#include <cholmod.h>
#include <cmath>
#include <omp.h>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

constexpr std::size_t kGroup = 12; // right-hand sides that are solved for at a time
constexpr std::size_t kMany = 96;  // of those of which only the compliance is asked; by three

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

// The matrix is handed to CHOLMOD already in elimination order, so that each factorisation costs
// one gather instead of two transpositions with their allocations (a tenth of the time).
struct SparseFactor::Impl {
    cholmod_common common{};
    std::vector<int> order, place;              // unknown that is eliminated k-th, and when
    std::vector<int> column_start, row, source; // permuted lower triangle; place in the values
    std::vector<double> value;
    cholmod_sparse matrix{};
    cholmod_factor* factor = nullptr;
    std::vector<double> inverse;        // of the factor's tiles
    std::vector<double> ordered, below; // right-hand sides in that order; scratch of a solve
    bool usable = false;

    Impl() {
        openblas_set_num_threads(1);
        stay_on_this_thread();
        cholmod_start(&common);
        common.print = 0;
        common.supernodal = CHOLMOD_SUPERNODAL;
        common.quick_return_if_not_posdef = 1;
        common.nmethods = 1;
        // larger supernodes than CHOLMOD's default: a node has three unknowns, and BLAS is better
        // at zeros than at small blocks (measured at 900 to 2500 unknowns: 10-20 % faster)
        common.nrelax[0] = 8, common.nrelax[1] = 32, common.nrelax[2] = 64;
        common.zrelax[0] = 0.9, common.zrelax[1] = 0.3, common.zrelax[2] = 0.1;
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        cholmod_free_factor(&factor, &common);
        cholmod_finish(&common);
    }

    void describe(std::vector<int>& starts, std::vector<int>& rows) {
        matrix.nrow = matrix.ncol = starts.size() - 1;
        matrix.nzmax = rows.size();
        matrix.p = starts.data();
        matrix.i = rows.data();
        matrix.stype = -1; // lower triangle
        matrix.itype = CHOLMOD_INT;
        matrix.xtype = CHOLMOD_PATTERN;
        matrix.dtype = CHOLMOD_DOUBLE;
        matrix.sorted = matrix.packed = 1;
    }

    void analyze(int ordering) {
        cholmod_free_factor(&factor, &common);
        common.method[0].ordering = ordering;
        common.postorder = ordering != CHOLMOD_NATURAL;
        factor = cholmod_analyze(&matrix, &common);
        if (factor == nullptr) {
            throw std::runtime_error("CHOLMOD analysis of " + std::to_string(matrix.nrow) +
                                     " unknowns: " + word(common.status));
        }
    }

    SupernodeView blocks() const noexcept {
        return {static_cast<int>(factor->nsuper),
                static_cast<const int*>(factor->super),
                static_cast<const int*>(factor->pi),
                static_cast<const int*>(factor->px),
                static_cast<const int*>(factor->s),
                static_cast<const double*>(factor->x),
                inverse.data()};
    }

    // Rows below the tallest block, or a tile if that is more.
    std::size_t most_below() const noexcept {
        const SupernodeView f = blocks();
        int most = kTile;
        for (int s = 0; s < f.blocks; ++s)
            most =
                std::max(most, f.row_start[s + 1] - f.row_start[s] - (f.first[s + 1] - f.first[s]));
        return static_cast<std::size_t>(most);
    }

    void make_room() {
        inverse.resize(kTile * order.size());
        ordered.resize(kGroup * order.size());
        below.resize(kGroup * most_below());
    }

    // A X = B in place for at most kGroup columns.
    void solve_group(std::span<double> b, std::size_t columns) noexcept {
        const std::size_t n = order.size();
        for (std::size_t c = 0; c < columns; ++c) {
            for (std::size_t k = 0; k < n; ++k)
                ordered[c * n + k] = b[c * n + order[k]];
        }
        solve_supernodes(blocks(), std::span(ordered).first(n * columns), static_cast<int>(columns),
                         below);
        for (std::size_t c = 0; c < columns; ++c) {
            for (std::size_t k = 0; k < n; ++k)
                b[c * n + order[k]] = ordered[c * n + k];
        }
    }

    void permute(const SparsePattern& pattern) {
        const auto* elimination = static_cast<const int*>(factor->Perm);
        order.assign(elimination, elimination + pattern.size);
        place.resize(order.size());
        for (int k = 0; k < pattern.size; ++k)
            place[order[k]] = k;

        struct Entry {
            int column, row, source;
        };
        std::vector<Entry> entries;
        entries.reserve(pattern.row.size());
        for (int c = 0; c < pattern.size; ++c) {
            for (int k = pattern.column_start[c]; k < pattern.column_start[c + 1]; ++k) {
                const int a = place[c], b = place[pattern.row[k]];
                entries.push_back({std::min(a, b), std::max(a, b), k});
            }
        }
        std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
            return a.column != b.column ? a.column < b.column : a.row < b.row;
        });
        column_start.assign(order.size() + 1, 0);
        for (const Entry& e : entries) {
            row.push_back(e.row);
            source.push_back(e.source);
            ++column_start[e.column + 1];
        }
        for (std::size_t c = 0; c < order.size(); ++c)
            column_start[c + 1] += column_start[c];
        value.resize(entries.size());
    }
};

SparseFactor::SparseFactor(const SparsePattern& pattern) : impl_(std::make_unique<Impl>()) {
    std::vector<int> starts = pattern.column_start, rows = pattern.row;
    impl_->describe(starts, rows);
    impl_->analyze(CHOLMOD_AMD);
    impl_->permute(pattern);
    impl_->describe(impl_->column_start, impl_->row);
    impl_->analyze(CHOLMOD_NATURAL);
    impl_->make_room();
    impl_->matrix.xtype = CHOLMOD_REAL;
    impl_->matrix.x = impl_->value.data();
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
    for (std::size_t k = 0; k < s.source.size(); ++k)
        s.value[k] = values[s.source[k]];
    stay_on_this_thread();
    s.common.status = CHOLMOD_OK;
    const int done = cholmod_factorize(&s.matrix, s.factor, &s.common);
    s.usable = done != 0 && s.common.status == CHOLMOD_OK && s.factor->minor == s.factor->n;
    if (s.usable)
        invert_tiles(s.blocks(), s.inverse);
    return s.usable;
}

bool SparseFactor::solve(std::span<double> b, int columns) noexcept {
    Impl& s = *impl_;
    if (!s.usable || columns < 1)
        return false;
    stay_on_this_thread();
    const std::size_t n = s.order.size(), all = static_cast<std::size_t>(columns);
    for (std::size_t c = 0; c < all; c += kGroup) {
        const std::size_t count = std::min(kGroup, all - c);
        s.solve_group(b.subspan(c * n, count * n), count);
    }
    return true;
}

// L^-1 P of columns, kept apart from the factor so that each thread has its own.
struct SparseFactor::Descent {
    const Impl& of;
    std::vector<double> y, below;

    Descent(const Impl& impl, std::size_t columns)
        : of(impl), y(columns * impl.order.size()), below(columns * impl.most_below()) {
        stay_on_this_thread();
    }
    // Of `count` columns from `first` on, one after the other.
    const double* operator()(const SparseColumns& b, std::size_t first, std::size_t count) {
        const std::size_t n = of.order.size();
        std::fill(y.begin(), y.end(), 0.0);
        for (std::size_t j = 0; j < count; ++j) {
            for (std::size_t k = b.start[first + j]; k < b.start[first + j + 1]; ++k)
                y[j * n + static_cast<std::size_t>(of.place[b.unknown[k]])] += b.value[k];
        }
        descend_supernodes(of.blocks(), std::span(y).first(count * n), static_cast<int>(count),
                           below);
        return y.data();
    }
};

bool SparseFactor::compliances(const SparseColumns& b, std::span<double> out) const {
    const Impl& s = *impl_;
    if (!s.usable || out.empty() || b.start.size() != out.size() + 1)
        return false;
    const std::size_t n = s.order.size();
    Descent descend(s, std::min(kMany, out.size()));
    for (std::size_t c = 0; c < out.size(); c += kMany) {
        const std::size_t count = std::min(kMany, out.size() - c);
        const double* y = descend(b, c, count);
        for (std::size_t j = 0; j < count; ++j)
            out[c + j] = cblas_ddot(static_cast<int>(n), y + j * n, 1, y + j * n, 1);
    }
    return true;
}

bool SparseFactor::compliances(const SparseColumns& b, std::span<std::array<double, 6>> out) const {
    constexpr std::array<std::array<std::size_t, 2>, 6> kPair{
        {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};
    constexpr std::size_t kPlaces = kMany / 3;
    const Impl& s = *impl_;
    if (!s.usable || out.empty() || b.start.size() != 3 * out.size() + 1)
        return false;
    const std::size_t n = s.order.size();
    Descent descend(s, 3 * std::min(kPlaces, out.size()));
    for (std::size_t c = 0; c < out.size(); c += kPlaces) {
        const std::size_t count = std::min(kPlaces, out.size() - c);
        const double* y = descend(b, 3 * c, 3 * count);
        for (std::size_t j = 0; j < count; ++j) {
            for (std::size_t k = 0; k < kPair.size(); ++k)
                out[c + j][k] = cblas_ddot(static_cast<int>(n), y + (3 * j + kPair[k][0]) * n, 1,
                                           y + (3 * j + kPair[k][1]) * n, 1);
        }
    }
    return true;
}

Supernodes SparseFactor::supernodes() const {
    const Impl& s = *impl_;
    if (!s.usable || s.factor->is_super == 0)
        throw std::runtime_error("supernodes of a matrix of " + std::to_string(s.order.size()) +
                                 " unknowns: it has no supernodal factor");
    const cholmod_factor& f = *s.factor;
    const auto copy = [](const void* from, std::size_t count) {
        const auto* begin = static_cast<const int*>(from);
        return std::vector<int>(begin, begin + count);
    };
    const auto* value = static_cast<const double*>(f.x);
    return {s.order,
            copy(f.super, f.nsuper + 1),
            copy(f.pi, f.nsuper + 1),
            copy(f.px, f.nsuper + 1),
            copy(f.s, f.ssize),
            {value, value + f.xsize}};
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

std::string blas_name() {
    return openblas_get_config();
}

} // namespace tissue
