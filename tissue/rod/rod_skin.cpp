// See the header.
#include "tissue/rod/rod_skin.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tissue {
namespace {

using glm::dvec3;

dvec3 middle_m(std::span<const dvec3> position_m, std::int32_t edge) noexcept {
    const auto e = static_cast<std::size_t>(edge);
    return 0.5 * (position_m[e] + position_m[e + 1]);
}

dvec3 turned(const RodFrame& f, const dvec3& offset) noexcept {
    return offset.x * f.across + offset.y * glm::cross(f.tangent, f.across) + offset.z * f.tangent;
}

struct Nearest {
    std::int32_t edge = 0;
    double share = 0.0; // of the edge before the place
};

Nearest nearest_edge(const RodModel& model, const dvec3& x_m) {
    Nearest best;
    double least_m = INFINITY;
    for (std::size_t e = 0; e < model.length_m.size(); ++e) {
        const dvec3 t = model.rest_frame[e].tangent, from = x_m - model.rest_m[e];
        const double share = std::clamp(glm::dot(from, t) / model.length_m[e], 0.0, 1.0);
        const double far_m = glm::length(from - share * model.length_m[e] * t);
        if (far_m < least_m) {
            least_m = far_m;
            best = {static_cast<std::int32_t>(e), share};
        }
    }
    return best;
}

// F.(omega x r) = omega.(r x F) =: omega.c;  c.(t x d)/|e| = d.(c x t)/|e|
template <typename Take>
void for_each_entry(const RodModel& model, const RodState& state, const RodVertex& v,
                    const dvec3& direction, Take take) noexcept {
    for (std::size_t k = 0; k < 2; ++k) {
        const auto e = static_cast<std::size_t>(v.edge[k]);
        const RodFrame& f = state.frame[e];
        const double w = v.weight[k];
        const dvec3 c = w * glm::cross(turned(f, v.offset_m[k]), direction);
        const double length_m = std::max(
            glm::distance(state.position_m[e], state.position_m[e + 1]), 0.05 * model.length_m[e]);
        const dvec3 lean = glm::cross(c, f.tangent) / length_m;
        for (int axis = 0; axis < 3; ++axis) {
            if (model.dof[e] >= 0)
                take(model.dof[e] + axis, 0.5 * w * direction[axis] - lean[axis]);
            if (model.dof[e + 1] >= 0)
                take(model.dof[e + 1] + axis, 0.5 * w * direction[axis] + lean[axis]);
        }
        if (model.spin[e] >= 0)
            take(model.spin[e], glm::dot(c, f.tangent));
    }
}

} // namespace

std::vector<RodVertex> attach(const RodModel& model, std::span<const dvec3> rest_m) {
    const auto edges = static_cast<std::int32_t>(model.length_m.size());
    std::vector<RodVertex> vertices;
    vertices.reserve(rest_m.size());
    for (const dvec3& x : rest_m) {
        const Nearest at = nearest_edge(model, x);
        const std::int32_t other = at.edge + (at.share < 0.5 ? -1 : 1);
        RodVertex v;
        v.edge = {at.edge, at.edge};
        v.weight = {1.0, 0.0};
        if (other >= 0 && other < edges) {
            v.edge[1] = other;
            v.weight[1] = std::abs(at.share - 0.5); // half and half at the node between
            v.weight[0] = 1.0 - v.weight[1];
        }
        for (std::size_t k = 0; k < 2; ++k) {
            const RodFrame& f = model.rest_frame[static_cast<std::size_t>(v.edge[k])];
            const dvec3 from = x - middle_m(model.rest_m, v.edge[k]);
            v.offset_m[k] = {glm::dot(from, f.across),
                             glm::dot(from, glm::cross(f.tangent, f.across)),
                             glm::dot(from, f.tangent)};
        }
        vertices.push_back(v);
    }
    return vertices;
}

dvec3 place_m(const RodState& state, const RodVertex& v) noexcept {
    dvec3 x{0.0};
    for (std::size_t k = 0; k < 2; ++k)
        x +=
            v.weight[k] * (middle_m(state.position_m, v.edge[k]) +
                           turned(state.frame[static_cast<std::size_t>(v.edge[k])], v.offset_m[k]));
    return x;
}

void add_row(const RodModel& model, const RodState& state, const RodVertex& v,
             const dvec3& direction, double factor, std::span<double> row) noexcept {
    for_each_entry(model, state, v, direction, [&](std::int32_t unknown, double value) {
        row[static_cast<std::size_t>(unknown)] += factor * value;
    });
}

double row_times(const RodModel& model, const RodState& state, const RodVertex& v,
                 const dvec3& direction, std::span<const double> q) noexcept {
    double sum = 0.0;
    for_each_entry(model, state, v, direction, [&](std::int32_t unknown, double value) {
        sum += value * q[static_cast<std::size_t>(unknown)];
    });
    return sum;
}

} // namespace tissue
