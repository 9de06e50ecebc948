// See the header.
#include "tissue/rod/rod_points.h"

#include <algorithm>

namespace tissue {
namespace {

using glm::dvec3;

constexpr std::array<dvec3, 3> kAxis{dvec3{1, 0, 0}, dvec3{0, 1, 0}, dvec3{0, 0, 1}};

// T^T f into points.load_n; nothing for an empty f.
void gather(const RodModel& model, const RodState& state, std::span<const double> force_n,
            RodPoints& points) noexcept {
    std::fill(points.load_n.begin(), points.load_n.end(), 0.0);
    for (std::size_t i = 0; 3 * i < force_n.size(); ++i) {
        const dvec3 f{force_n[3 * i], force_n[3 * i + 1], force_n[3 * i + 2]};
        if (f != dvec3{0.0})
            add_row(model, state, points.vertex[i], f, 1.0, points.load_n);
    }
}

// T q
void scatter(const RodModel& model, const RodState& state, std::span<const double> q,
             const RodPoints& points, std::span<double> du) noexcept {
    for (std::size_t i = 0; i < points.vertex.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k)
            du[3 * i + k] = row_times(model, state, points.vertex[i], kAxis[k], q);
    }
}

} // namespace

RodPoints make_points(const RodModel& model, std::span<const dvec3> rest_m) {
    const std::vector<double> unknown(static_cast<std::size_t>(model.unknowns), 0.0);
    return {attach(model, rest_m), {rest_m.begin(), rest_m.end()}, unknown, unknown};
}

void free_motion(const RodModel& model, const RodState& state, const RodSystem& system,
                 std::span<const double> load_n, RodPoints& points, std::span<double> du) noexcept {
    gather(model, state, load_n, points);
    free_motion(model, system, points.load_n, points.answer);
    scatter(model, state, points.answer, points, du);
}

void solve(const RodModel& model, const RodState& state, const RodSystem& system, RodPoints& points,
           std::span<double> block, int columns) noexcept {
    const std::size_t n = 3 * points.vertex.size();
    for (int c = 0; c < columns; ++c) {
        const auto column = block.subspan(static_cast<std::size_t>(c) * n, n);
        gather(model, state, column, points);
        solve(system, points.load_n, 1);
        scatter(model, state, points.load_n, points, column);
    }
}

RodReport end_step(const RodModel& model, std::span<const double> load_n, const RodOptions& options,
                   RodPoints& points, std::span<double> du, RodSystem& system,
                   RodState& state) noexcept {
    gather(model, state, load_n, points);
    free_motion(model, system, points.load_n, points.answer);
    const RodReport report = end_step(model, points.load_n, options, points.answer, system, state);
    for (std::size_t i = 0; i < points.vertex.size(); ++i) {
        const dvec3 now_m = place_m(state, points.vertex[i]);
        for (int k = 0; k < 3; ++k)
            du[3 * i + static_cast<std::size_t>(k)] = now_m[k] - points.position_m[i][k];
        points.position_m[i] = now_m;
    }
    return report;
}

} // namespace tissue
