// sim/study/solid_methods.h
// Every tissue model as a study sees it: one shape, so that all do the same work. Called by
// solid_run.cpp only; one thread.
//   XMethod(work, body)           at rest, unloaded
//   position_m(), velocity_mps()  of all nodes; a punch moves its own
//   set_load_n(force)             in all, on the loaded face, from now on
//   step()                        one step of dt
//   audit(before)                 untimed: the residual that the step left, of all its equations
//   settle()                      to rest under the load, if kStatics; others get there by steps
//   push_n()                      of the tissue on the punch
#pragma once

#include "sim/study/solid_case.h"
#include "sim/study/solid_effort.h"
#include "tissue/baseline/mass_spring.h"
#include "tissue/baseline/projective.h"
#include "tissue/baseline/tled.h"
#include "tissue/baseline/xpbd.h"
#include "tissue/reference/reference.h"
#include "tissue/solver/chord.h"
#include "tissue/solver/quadratic.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace sim {

/// Clamped and punched nodes, a byte each.
std::vector<std::uint8_t> anchors_of(const SolidBody& body);
glm::dvec3 gravity_of(const SolidCase& work);

/// Corotated tetrahedra: solver/corotated.h, and as in the trainer the factor of an earlier step
/// for as long as it corrects well, solver/chord.h. Not where a punch moves nodes from outside.
struct CorotatedMethod {
    static constexpr bool kStatics = true;
    const SolidBody& body;
    double dt_s;
    tissue::CorotatedModel model;
    tissue::CorotatedState state;
    tissue::CorotatedSystem system;
    tissue::Chord chord;
    bool linearised = false; // system.internal_n and a factor that serves are there
    std::vector<double> load_n, du;

    CorotatedMethod(const SolidCase& work, const SolidBody& b);
    std::vector<glm::dvec3>& position_m() { return state.position_m; }
    std::vector<glm::dvec3>& velocity_mps() { return state.velocity_mps; }
    void set_load_n(double force_n);
    SolidEffort step();
    double audit(std::span<const glm::dvec3> before_mps) const;
    SolidEffort settle();
    double push_n() const;
};

/// Linear elasticity on linear tetrahedra: the corotated tangent at rest, kept.
struct LinearMethod {
    static constexpr bool kStatics = true;
    CorotatedMethod corotated;
    double dt_s;                  // infinity: statics
    std::vector<double> loaded_n; // as it is in internal_n

    LinearMethod(const SolidCase& work, const SolidBody& b);
    std::vector<glm::dvec3>& position_m() { return corotated.position_m(); }
    std::vector<glm::dvec3>& velocity_mps() { return corotated.velocity_mps(); }
    void set_load_n(double force_n);
    SolidEffort step();
    double audit(std::span<const glm::dvec3>) const { return kUnknown; }
    SolidEffort settle() { return step(); }
    double push_n() const { return kUnknown; } // refused, see check()
};

/// Ten-node tetrahedra, converged: reference/reference.h, neo-Hooke or small strain.
struct ReferenceMethod {
    static constexpr bool kStatics = true;
    const SolidBody& body;
    double dt_s;
    tissue::ReferenceModel model;
    tissue::ReferenceState state;
    tissue::ReferenceSystem system;
    std::vector<glm::dvec3> load_n;

    ReferenceMethod(const SolidCase& work, const SolidBody& b);
    /// Where the next step begins, but for punched nodes: where they are held next.
    std::vector<glm::dvec3>& position_m() { return wanted_m; }
    std::vector<glm::dvec3>& velocity_mps() { return state.velocity_mps; }
    void set_load_n(double force_n);
    SolidEffort step();
    double audit(std::span<const glm::dvec3>) const { return last_residual; }
    SolidEffort settle();
    double push_n() const;

  private:
    std::vector<glm::dvec3> wanted_m;
    double last_residual = kUnknown;
    SolidEffort take(const tissue::NewtonReport& report);
};

/// Ten-node tetrahedra in real time: solver/quadratic.h.
struct QuadraticMethod {
    static constexpr bool kStatics = true;
    const SolidBody& body;
    tissue::QuadraticModel model;
    tissue::QuadraticState state;
    tissue::QuadraticSystem system;
    tissue::NodeVector<double> weight_n;
    std::vector<double> du;
    double length_m;

    QuadraticMethod(const SolidCase& work, const SolidBody& b);
    std::vector<glm::dvec3>& position_m() { return state.position_m; }
    std::vector<glm::dvec3>& velocity_mps() { return state.velocity_mps; }
    void set_load_n(double force_n);
    SolidEffort step();
    double audit(std::span<const glm::dvec3>) const { return last_residual; }
    SolidEffort settle();
    double push_n() const;

  private:
    double last_residual = kUnknown;
    SolidEffort step(tissue::QuadraticSystem& at, const tissue::QuadraticOptions& options);
};

/// A baseline of tissue/baseline.
template <typename Model> struct BaselineMethod {
    static constexpr bool kStatics = false;
    const SolidBody& body;
    double dt_s;
    Model model;
    tissue::BaselineState state;
    decltype(make_scratch(std::declval<const Model&>())) scratch;
    std::vector<glm::dvec3> load_n;

    BaselineMethod(const SolidCase& work, const SolidBody& b)
        : body(b), dt_s(work.dt_s), model(make(work, b)), state(rest_state(model.body)),
          scratch(make_scratch(model)), load_n(b.rest_m.size(), glm::dvec3{0.0}) {}
    std::vector<glm::dvec3>& position_m() { return state.position_m; }
    std::vector<glm::dvec3>& velocity_mps() { return state.velocity_mps; }
    void set_load_n(double force_n) {
        for (std::size_t i = 0; i < load_n.size(); ++i)
            load_n[i] = force_n * body.load_share[i] * body.load_direction;
    }
    SolidEffort step() {
        const tissue::BaselineReport report = tissue::step(model, load_n, dt_s, scratch, state);
        return {.substeps = report.substeps,
                .residual = report.relative_residual,
                .converged = report.finite};
    }
    double audit(std::span<const glm::dvec3>) const { return kUnknown; }
    SolidEffort settle() { return {}; }
    /// From the energy, which all of them have: its change with the punch's place.
    double push_n() const {
        constexpr double step_m = 1e-8;
        const auto energy_j = [&](double way_m) {
            tissue::BaselineState moved = state;
            for (std::size_t i = 0; i < moved.position_m.size(); ++i)
                if (body.punched[i] != 0)
                    moved.position_m[i] += way_m * body.load_direction;
            return elastic_energy_j(model, moved);
        };
        return (energy_j(step_m) - energy_j(-step_m)) / (2.0 * step_m);
    }

  private:
    static Model make(const SolidCase& work, const SolidBody& b) {
        const auto anchors = anchors_of(b);
        const auto& m = work.material;
        const glm::dvec3 g = gravity_of(work);
        if constexpr (std::is_same_v<Model, tissue::MassSpringModel>)
            return tissue::make_mass_spring(b.corners, m, anchors, g);
        else if constexpr (std::is_same_v<Model, tissue::TledModel>)
            return tissue::make_tled(b.corners, m, anchors, g);
        else if constexpr (std::is_same_v<Model, tissue::XpbdModel>)
            return tissue::make_xpbd(b.corners, m, anchors, g);
        else
            return tissue::make_projective(b.corners, m, anchors, g);
    }
};

} // namespace sim
