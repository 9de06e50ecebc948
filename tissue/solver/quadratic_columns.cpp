// See the header.
#include "tissue/solver/quadratic_columns.h"

#include "tissue/solver/block_products.h"
#include "tissue/solver/block_vectors.h"
#include "tissue/solver/quadratic_linear.h"
#include "tissue/solver/quadratic_recovery.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

constexpr int kLanes = SingleFactor::kLanes;
using Lines = std::vector<ColumnLine>;

// Columns [first, first + count) of a block, those of a group of sixteen.
struct Group {
    std::size_t n;
    int first, count;
    std::size_t at(int j) const noexcept { return static_cast<std::size_t>(first + j) * n; }
};

template <typename Work> void for_groups(const QuadraticModel& model, int columns, Work work) {
    for (int first = 0; first < columns; first += kLanes)
        work(Group{static_cast<std::size_t>(model.unknowns), first,
                   std::min(kLanes, columns - first)});
}

// Of an unknown: nodes have three lines, and four numbers in a node vector.
std::size_t line_of(const QuadraticModel& model, std::size_t unknown) noexcept {
    const std::int32_t place = model.place_of_unknown[unknown];
    return static_cast<std::size_t>(place - place / 4);
}

// Unknowns to lines and back; lanes that are not used are zero.
template <typename Line>
void read(const QuadraticModel& model, std::span<const double> block, const Group& group,
          std::vector<Line>& lines) noexcept {
    using T = typename decltype(Line::lane)::value_type;
    std::array<const double*, kLanes> column{};
    for (int j = 0; j < group.count; ++j)
        column[j] = block.data() + group.at(j);
    std::fill(lines.begin(), lines.end(), Line{});
    for (std::size_t k = 0; k < group.n; ++k) {
        Line& line = lines[line_of(model, k)];
        for (int j = 0; j < group.count; ++j)
            line.lane[j] = static_cast<T>(column[j][k]);
    }
}
template <typename Line>
void write(const QuadraticModel& model, const std::vector<Line>& lines, const Group& group,
           std::span<double> block) noexcept {
    std::array<double*, kLanes> column{};
    for (int j = 0; j < group.count; ++j)
        column[j] = block.data() + group.at(j);
    for (std::size_t k = 0; k < group.n; ++k) {
        const Line& line = lines[line_of(model, k)];
        for (int j = 0; j < group.count; ++j)
            column[j][k] = line.lane[j];
    }
}

// z = W A0^-1 W^T r
void precondition(const QuadraticModel& model, QuadraticSystem& s) noexcept {
    const NodeOrder nodes{model.dof, s.block.order_of_unknown, s.warp};
    turn_into_order(nodes, s.block.r, s.block.ordered);
    solve_block(s.single, s.block.ordered, s.block.columns);
    turn_back(nodes, s.block.ordered, s.block.z);
}

// q = A p
void multiply(const QuadraticModel& model, QuadraticSystem& s) noexcept {
    const double stiffness = 1.0 + model.material.damping_stiffness_s / s.dt_s;
    scalar_product(model, s.scalar_npm, s.block.p, s.block.q, s.block.columns);
    add_tangent_product(model, s.tangent, static_cast<float>(stiffness), s.block.p, s.block.q,
                        s.block.columns);
    for (const std::int32_t at : model.fixed) // places; three lines a node
        std::fill_n(&s.block.q[at / 4 * 3], 3, ColumnLine{});
}

struct Gradients {
    int iterations = 0;
    ColumnScalars size2{}, left2{}; // |b|^2, |r|^2
    bool indefinite = false;
};

// x = what the known modes say if none is given, and r = b - A x from r = b.
void start(const QuadraticModel& model, bool given, QuadraticSystem& s) noexcept {
    if (!given)
        std::fill(s.block.x.begin(), s.block.x.end(), ColumnLine{});
    std::fill(s.block.p.begin(), s.block.p.end(), ColumnLine{});
    if (!given && s.block.known.modes == 0)
        return;
    if (!given)
        add_known(s.block.known, s.block.r, s.block.x);
    s.block.p = s.block.x;
    multiply(model, s);
    ColumnScalars back;
    back.fill(-1.0);
    add_scaled(back, s.block.q, s.block.r);
}

// From r = b. A column that is done stays as it is: its alpha and beta are zero.
Gradients conjugate_gradients(const QuadraticModel& model, const QuadraticOptions& options,
                              bool given, QuadraticSystem& s) noexcept {
    Gradients report;
    report.size2 = products_of(s.block.r, s.block.r);
    start(model, given, s);
    report.left2 = products_of(s.block.r, s.block.r);
    const double enough = options.linear_tolerance * options.linear_tolerance;
    std::array<bool, kLanes> on{};
    const auto any_left = [&] {
        for (int j = 0; j < kLanes; ++j)
            on[j] = report.left2[j] > enough * report.size2[j] && report.size2[j] > 0.0;
        return std::find(on.begin(), on.end(), true) != on.end();
    };
    ColumnScalars rz{};
    bool begun = false;
    while (report.iterations < options.max_linear && any_left()) {
        precondition(model, s);
        const ColumnScalars next = products_of(s.block.r, s.block.z);
        ColumnScalars alpha{}, back{}, beta{};
        for (int j = 0; j < kLanes; ++j)
            beta[j] = on[j] && begun ? next[j] / rz[j] : 0.0;
        rz = next;
        scale_and_add(beta, s.block.z, s.block.p);
        begun = true;
        multiply(model, s);
        const ColumnScalars curvature = products_of(s.block.p, s.block.q);
        for (int j = 0; j < kLanes; ++j) {
            report.indefinite = report.indefinite || (on[j] && !(curvature[j] > 0.0));
            alpha[j] = on[j] ? rz[j] / curvature[j] : 0.0;
            back[j] = -alpha[j];
        }
        if (report.indefinite)
            break;
        add_scaled(alpha, s.block.p, s.block.x);
        add_scaled(back, s.block.q, s.block.r);
        ++report.iterations;
        const ColumnScalars left2 = products_of(s.block.r, s.block.r);
        for (int j = 0; j < kLanes; ++j)
            report.left2[j] = on[j] ? left2[j] : report.left2[j];
    }
    return report;
}

void solve_group(const QuadraticModel& model, const QuadraticOptions& options,
                 std::span<double> block, const Group& group, std::span<double> residual,
                 std::span<const double> first, QuadraticSystem& s,
                 ColumnsReport& report) noexcept {
    s.block.columns = group.count;
    Gradients done;
    for (const float share : {1.0f, 0.5f, 0.0f}) { // as solve_nodes()
        if (share < 1.0f)
            scale_geometric_stiffness(share, s);
        read(model, block, group, s.block.r);
        if (!first.empty())
            read(model, first, group, s.block.x);
        done = conjugate_gradients(model, options, !first.empty(), s);
        report.iterations += done.iterations;
        if (!done.indefinite)
            break;
        report.projected = true;
    }
    write(model, s.block.x, group, block);
    for (int j = 0; j < group.count; ++j) {
        const double off = done.size2[j] == 0.0 ? 0.0 : std::sqrt(done.left2[j] / done.size2[j]);
        report.relative_residual = std::max(report.relative_residual, off);
        if (!residual.empty())
            residual[group.first + j] = off;
    }
}

} // namespace

BlockScratch make_block_scratch(const QuadraticModel& model, std::span<const int> order) {
    BlockScratch block;
    const std::size_t lines = 3 * (model.mesh.rest_m.size() + 1);
    for (Lines* v : {&block.x, &block.r, &block.z, &block.p, &block.q})
        v->resize(lines);
    block.ordered.resize(order.size() + SingleFactor::kColumns - 1);
    block.double_x.resize(lines);
    block.double_y.resize(lines);
    block.known = make_known_modes(lines);
    block.order_of_unknown.resize(order.size());
    for (std::size_t k = 0; k < order.size(); ++k)
        block.order_of_unknown[order[k]] = static_cast<std::int32_t>(k);
    for (const double npm : model.bed_npm)
        block.bed_npm.push_back(static_cast<float>(npm));
    return block;
}

void remember_modes(const QuadraticModel& model, std::span<const double> shape,
                    std::span<const double> lambda, QuadraticSystem& system) noexcept {
    KnownModes& known = system.block.known;
    const auto n = static_cast<std::size_t>(model.unknowns);
    const double rate = 1.0 / system.dt_s;
    const double of_m = rate * rate + model.material.damping_mass_1ps * rate;
    const double of_k = 1.0 + model.material.damping_stiffness_s * rate;
    known.modes = std::min(static_cast<int>(lambda.size()), KnownModes::kMost);
    std::fill(known.inverse.begin(), known.inverse.end(), 0.0f);
    for (int m = 0; m < known.modes; ++m) {
        known.inverse[m] = static_cast<float>(1.0 / (of_m + of_k * lambda[m]));
        const double* from = shape.data() + static_cast<std::size_t>(m) * n;
        for (std::size_t k = 0; k < n; ++k)
            known.at(m, line_of(model, k)) = static_cast<float>(from[k]);
    }
}

ColumnsReport solve_columns(const QuadraticModel& model, const QuadraticOptions& options,
                            QuadraticSystem& system, std::span<double> block, int columns,
                            std::span<double> residual, std::span<const double> first) noexcept {
    ColumnsReport report;
    const auto n = static_cast<std::size_t>(model.unknowns);
    if (system.recovering) {
        for (int j = 0; j < columns; ++j)
            solve_recovering(system, block.subspan(static_cast<std::size_t>(j) * n, n));
        std::fill(residual.begin(), residual.end(), 0.0);
        return report;
    }
    for_groups(model, columns, [&](const Group& group) {
        solve_group(model, options, block, group, residual, first, system, report);
    });
    return report;
}

void precondition_columns(const QuadraticModel& model, QuadraticSystem& system,
                          std::span<double> block, int columns) noexcept {
    const auto n = static_cast<std::size_t>(model.unknowns);
    if (system.recovering) {
        for (int j = 0; j < columns; ++j)
            solve_recovering(system, block.subspan(static_cast<std::size_t>(j) * n, n));
        return;
    }
    for_groups(model, columns, [&](const Group& group) {
        system.block.columns = group.count;
        read(model, block, group, system.block.r);
        precondition(model, system);
        write(model, system.block.z, group, block);
    });
}

void stiffness_products(const QuadraticModel& model, std::span<const double> x, int columns,
                        QuadraticSystem& s, std::span<double> y) noexcept {
    constexpr int kFew = 4; // columns that are cheaper one at a time
    for_groups(model, columns, [&](const Group& group) {
        if (s.recovering || group.count <= kFew) {
            for (int j = 0; j < group.count; ++j)
                stiffness_product(model, x.subspan(group.at(j), group.n), s,
                                  y.subspan(group.at(j), group.n));
            return;
        }
        read(model, x, group, s.block.p);
        if (model.bed_npm.empty())
            std::fill(s.block.q.begin(), s.block.q.end(), ColumnLine{});
        else
            scalar_product(model, s.block.bed_npm, s.block.p, s.block.q, group.count);
        add_tangent_product(model, s.tangent, 1.0f, s.block.p, s.block.q, group.count);
        write(model, s.block.q, group, y);
    });
}

void mass_products(const QuadraticModel& model, std::span<const double> x, int columns,
                   QuadraticSystem& s, std::span<double> y) noexcept {
    for_groups(model, columns, [&](const Group& group) {
        read(model, x, group, s.block.double_x);
        scalar_product(model, model.mass_kg, s.block.double_x, s.block.double_y);
        write(model, s.block.double_y, group, y);
    });
}

} // namespace tissue
