// tissue/reference/reference_memory.cpp
// What the points of a reference body remember, and its forces and energy at a state. Called by its
// steps, studies and tests; any thread.
#include "tissue/reference/reference_element.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

// Where point q of a tet keeps its terms.
std::span<const Symmetric> at(std::span<const Symmetric> memory, std::size_t terms, std::size_t tet,
                              std::size_t q) noexcept {
    return memory.subspan((4 * tet + q) * terms, terms);
}

void add_forces(const ReferenceModel& model, std::span<const Symmetric> shear_pa,
                std::span<const dvec3> moved_m, std::span<dvec3> force_n) {
    std::fill(force_n.begin(), force_n.end(), dvec3{0.0});
    for (std::size_t e = 0; e < model.points.size(); ++e) {
        for (std::size_t q = 0; q < 4; ++q) {
            const ReferencePoint& point = model.points[e][q];
            const dmat3 F = deformation_gradient(model, e, point, moved_m);
            const dmat3 P = point.volume_m3 * piola_at_pa(model, shear_pa, e, q, F);
            for (std::size_t a = 0; a < 10; ++a)
                force_n[model.mesh.tets[e][a]] += P * point.gradient_1pm[a];
        }
    }
    const std::vector<double> bed_n = bed_force_n(model, moved_m);
    for (std::size_t i = 0; i < bed_n.size(); ++i)
        force_n[i / 3][static_cast<int>(i % 3)] += bed_n[i];
}

std::vector<Symmetric> shears_pa(const ReferenceModel& model, const PronyStep& prony,
                                 std::span<const Symmetric> memory,
                                 std::span<const dvec3> moved_m) {
    std::vector<Symmetric> shear;
    if (prony.terms == 0)
        return shear;
    shear.reserve(4 * model.points.size());
    for (std::size_t e = 0; e < model.points.size(); ++e) {
        for (std::size_t q = 0; q < 4; ++q) {
            const dmat3 F = deformation_gradient(model, e, model.points[e][q], moved_m);
            shear.push_back(
                shear_pa(prony, at(memory, prony.terms, e, q), relaxed(model.elasticity.law, F)));
        }
    }
    return shear;
}

} // namespace

void check_memory(const ReferenceModel& model, std::span<const Symmetric> memory) {
    const std::size_t needed = 4 * model.points.size() * model.material.prony.size();
    if (memory.size() != needed) {
        throw std::invalid_argument("memory of " + std::to_string(memory.size()) +
                                    " terms at points: the model has " + std::to_string(needed) +
                                    ", see rest_state()");
    }
}

void begin_memory(const ReferenceModel& model, const PronyStep& prony,
                  std::span<const Symmetric> memory, std::span<const dvec3> moved_m,
                  ReferenceSystem& system) {
    system.shear_pa = shears_pa(model, prony, memory, moved_m);
}

void end_memory(const ReferenceModel& model, const PronyStep& prony, std::span<const dvec3> from_m,
                std::span<const dvec3> to_m, std::span<Symmetric> memory) noexcept {
    if (prony.terms == 0)
        return;
    for (std::size_t e = 0; e < model.points.size(); ++e) {
        for (std::size_t q = 0; q < 4; ++q) {
            const ReferencePoint& point = model.points[e][q];
            remember(prony,
                     relaxed(model.elasticity.law, deformation_gradient(model, e, point, from_m)),
                     relaxed(model.elasticity.law, deformation_gradient(model, e, point, to_m)),
                     memory.subspan((4 * e + q) * prony.terms, prony.terms));
        }
    }
}

void linearize(const ReferenceModel& model, const ReferenceState& state, ReferenceSystem& system,
               bool projected) {
    const std::vector<dvec3> moved = displacements_m(model, state.position_m);
    check_memory(model, state.memory);
    begin_memory(model, prony_step(model.material, 0.0), state.memory, moved, system);
    linearize_at(model, moved, system, projected);
}

void elastic_forces(const ReferenceModel& model, std::span<const dvec3> position_m,
                    std::span<dvec3> force_n) {
    add_forces(model, {}, displacements_m(model, position_m), force_n);
}

void internal_forces(const ReferenceModel& model, const ReferenceState& state,
                     std::span<dvec3> force_n) {
    check_memory(model, state.memory);
    const std::vector<dvec3> moved = displacements_m(model, state.position_m);
    const PronyStep at_once = prony_step(model.material, 0.0);
    add_forces(model, shears_pa(model, at_once, state.memory, moved), moved, force_n);
}

double stored_energy_j(const ReferenceModel& model, const ReferenceState& state) {
    check_memory(model, state.memory);
    const std::vector<dvec3> moved = displacements_m(model, state.position_m);
    const PronyStep at_once = prony_step(model.material, 0.0);
    double sum = half_work_j(bed_force_n(model, moved), moved);
    for (std::size_t e = 0; e < model.points.size(); ++e) {
        for (std::size_t q = 0; q < 4; ++q) {
            const ReferencePoint& point = model.points[e][q];
            const dmat3 F = deformation_gradient(model, e, point, moved);
            sum += point.volume_m3 * stored_density_jpm3(model.elasticity, at_once,
                                                         at(state.memory, at_once.terms, e, q), F);
        }
    }
    return sum;
}

} // namespace tissue
