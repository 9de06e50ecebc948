// What tools feel of organs that push each other: see organ_contact.h.
#include "sim/bridge/organ_products.h"

#include <algorithm>

namespace sim {
namespace {

constexpr double kBraced = 3e-2; // relative residual of what tools feel; as kRows of the tools

// Of each tool with a row on a soft body: where its columns are in that body's answers.
struct ToolColumns {
    std::array<int, kTools> first{-1, -1, -1};
};

ToolColumns tool_columns(const TissueRig& rig, const haptics::ContactProblem& problem) noexcept {
    ToolColumns out;
    for (int i = 0; i < kTools; ++i) {
        const int body = rig.contact[i].body;
        if (!problem.row[i].active || body < 0 || !rig.bodies[body].soft)
            continue;
        int before = 0;
        for (int j = 0; j < i; ++j)
            before += problem.row[j].active && rig.contact[j].body == body;
        out.first[i] = 3 * before;
    }
    return out;
}

void find_openings(const TissueRig& rig, const ToolColumns& columns,
                   OrganContact& organs) noexcept {
    for (std::size_t k = 0; k < organs.row.size(); ++k) {
        const OrganRow& row = organs.rows.row[organs.row[k]];
        for (int i = 0; i < kTools; ++i) {
            for (int axis = 0; axis < 3; ++axis) {
                double& open =
                    organs.open[k * kToolColumns + static_cast<std::size_t>(3 * i + axis)];
                open = 0.0;
                const int b = rig.contact[i].body;
                if (columns.first[i] < 0 || (row.vertex_of != b && row.skin_of != b))
                    continue;
                const SoftBody& soft = *rig.bodies[b].soft;
                const std::size_t n = soft.motion_m.size();
                const auto x =
                    std::span<const double>(soft.answer_m)
                        .subspan(static_cast<std::size_t>(columns.first[i] + axis) * n, n);
                const std::span<const double> none{};
                open = organs.scale[k] * opens_m(rig.bodies, row, row.vertex_of == b ? x : none,
                                                 row.skin_of == b ? x : none);
            }
        }
    }
}

std::array<double, kToolColumns> products(std::span<const double> a,
                                          std::span<const double> b) noexcept {
    std::array<double, kToolColumns> sum{};
    for (std::size_t k = 0; k < a.size(); ++k)
        sum[k % kToolColumns] += a[k] * b[k];
    return sum;
}

// brace = (S W S + 1)^-1 open, all columns by conjugate gradients side by side.
void solve_brace(TissueRig& rig, OrganContact& organs) noexcept {
    const std::size_t size = organs.row.size() * kToolColumns;
    const std::span<double> x(organs.brace.data(), size), r(organs.residual.data(), size),
        p(organs.direction.data(), size), Ap(organs.product.data(), size);
    std::fill(x.begin(), x.end(), 0.0);
    std::copy_n(organs.open.begin(), size, r.begin());
    std::copy(r.begin(), r.end(), p.begin());
    auto rr = products(r, r);
    const auto first = rr;
    const double most = *std::max_element(first.begin(), first.end());
    for (int i = 0; i < kMostProducts; ++i) {
        bool open = false;
        for (std::size_t c = 0; c < kToolColumns; ++c)
            open |= rr[c] > kBraced * kBraced * std::max(first[c], 1e-3 * most);
        if (!open)
            return;
        multiply(rig, organs, kToolColumns, p, Ap);
        const auto pAp = products(p, Ap);
        std::array<double, kToolColumns> step{}, back{};
        for (std::size_t c = 0; c < kToolColumns; ++c)
            step[c] = pAp[c] > 0.0 ? rr[c] / pAp[c] : 0.0;
        for (std::size_t k = 0; k < size; ++k) {
            x[k] += step[k % kToolColumns] * p[k];
            r[k] -= step[k % kToolColumns] * Ap[k];
        }
        const auto next = products(r, r);
        for (std::size_t c = 0; c < kToolColumns; ++c)
            back[c] = rr[c] > 0.0 ? next[c] / rr[c] : 0.0;
        for (std::size_t k = 0; k < size; ++k)
            p[k] = r[k] + back[k % kToolColumns] * p[k];
        rr = next;
    }
}

} // namespace

void brace_tools(TissueRig& rig, haptics::ContactProblem& problem) noexcept {
    OrganContact& organs = *rig.organs;
    organs.braced = false;
    const ToolColumns columns = tool_columns(rig, problem);
    std::fill(organs.in_play.begin(), organs.in_play.end(), std::uint8_t{0});
    for (int i = 0; i < kTools; ++i) {
        if (columns.first[i] >= 0)
            organs.in_play[rig.contact[i].body] = 1;
    }
    spread(rig.bodies, organs.rows.row, pushes, organs.in_play);
    gather(rig.bodies, false, organs);
    if (organs.row.empty())
        return;
    find_openings(rig, columns, organs);
    solve_brace(rig, organs);
    organs.braced = true;
    for (int i = 0; i < kTools; ++i) {
        for (int j = 0; j < kTools; ++j) {
            for (int a = 0; a < 9; ++a) {
                const auto of_i = static_cast<std::size_t>(3 * i + a / 3);
                const auto of_j = static_cast<std::size_t>(3 * j + a % 3);
                double sum = 0.0;
                for (std::size_t k = 0; k < organs.row.size(); ++k)
                    sum += organs.open[k * kToolColumns + of_i] *
                           organs.brace[k * kToolColumns + of_j];
                problem.compliance[i][j][a % 3][a / 3] -= sum;
            }
        }
    }
}

void follow_tools(TissueRig& rig, std::span<const glm::dvec3> change_n) noexcept {
    OrganContact& organs = *rig.organs;
    if (!organs.braced)
        return;
    bool changed = false;
    for (std::size_t k = 0; k < organs.row.size(); ++k) {
        double change = 0.0;
        for (std::size_t c = 0; c < kToolColumns; ++c)
            change += organs.brace[k * kToolColumns + c] * change_n[c / 3][static_cast<int>(c % 3)];
        const double next = std::max(0.0, organs.y[k] + change);
        organs.gradient[k] = next - organs.y[k];
        changed |= organs.gradient[k] != 0.0;
        organs.y[k] = next;
    }
    if (!changed)
        return;
    const std::span<double> out(organs.product.data(), organs.row.size());
    multiply(rig, organs, 1, std::span<const double>(organs.gradient).first(organs.row.size()),
             out);
    move(rig, organs, 1.0);
    put_forces(organs);
}

} // namespace sim
