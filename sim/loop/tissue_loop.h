// sim/loop/tissue_loop.h
// One FEM step of a scene under the newest tool poses, and the answer that the haptic loop lives
// on until the next one. The threaded session calls it on the tissue thread, lockstep on the only
// thread; it reads no clock.
//
//   follow the contact points -> free motion under the forces of before -> organs push each other
//   -> condense the rows -> solve the contact for all of the forces, move by their change -> organs
//   again -> advance and linearise -> modes of the local model -> the answer
#pragma once

#include "sim/bridge/body.h"
#include "sim/bridge/organ_contact.h"
#include "sim/bridge/sight.h"
#include "sim/exchange.h"

namespace sim {

/// A target that moves with the tissue it is embedded in.
struct EmbeddedTarget {
    int body = 0;
    haptics::SurfacePoint at;
};

/// Where the FEM step knows a tool to touch or nearly touch.
struct FemContact {
    int body = -1; // -1: nothing within reach
    haptics::SurfacePoint at;
    glm::dmat3 own_compliance{0.0}; // of the mesh's surface point there, last step
    glm::dvec3 force_n{0.0};        // on the tool
    glm::dvec3 before_n{0.0};       // that the free motion of the step being made is under
    glm::dvec3 normal{0.0, 0.0, 1.0};
    glm::dvec3 last_tip_m{0.0};
    double speed_mps = 0.0; // of the tip over the last period
    bool seen = false;      // last_tip_m is set
    int closing = 0;        // last closing of the tool's jaws that was heeded
};

struct TissueConfig {
    double step_s = 0.010;        // FEM period
    double latency_periods = 1.0; // L: an answer is used this much after its sample
    double reach_m = 5e-3;        // a model exists before the touch: v (L+2) Tf + this
    double patch_radius_m = 14e-3;
    double friction_rigid = 0.05;
    double relinearise_m = 20e-6;     // below: the tangent of before still holds (0.2 % of an
                                      // element's strain); 0: linearised in every step
    bool organs_meet = false;         // they push each other and lie on scenery, at a price
    bool basis = true;                // false: forces only (the monolithic reference)
    std::vector<tissue::Tier> tier{}; // by organ; empty: corotated
};

/// What the patch of a tool showed of the modes in the step before.
struct ShownShapes {
    int body = -1, basis = -1; // SoftBody::basis_count
    std::vector<std::uint32_t> vertex;
    std::vector<std::array<std::array<double, haptics::kMaxModes>, 3>> shape;
};

struct TissueRig {
    TissueConfig config;
    std::vector<Body> bodies;
    std::vector<EmbeddedTarget> targets;
    std::optional<OrganContact> organs; // none: only tools touch
    std::optional<Sight> sight;         // none: nobody asks what the endoscope sees
    double mark_radius_m = 0.0;         // of the targets' marks, for sight
    std::array<FemContact, kTools> contact{};
    std::array<haptics::ContactMemory, kTools> memory{};
    std::array<double, kTools> device_npm{800.0, 800.0, 800.0}; // 0.8 x 2b/T of each device
    std::array<double, kTools> floor_mpn{};                     // 1/Kc at the tip, see below
    std::array<tissue::Patch, kTools> patch;
    std::array<ShownShapes, kTools> shown;
    std::vector<std::uint8_t> rests; // by body, of the step being made
    std::int64_t next_step = 0;
    std::int64_t last_sample_tick = -1;
};

/// Relative residual of a step's linear solves; beyond, its forces are no longer those of the
/// model.
inline constexpr double kMostLinearResidual = 1e-3;

struct StepOutcome {
    tasks::StepTrace trace;
    double linear_residual = 0.0; // worst body
    double contact_residual_m = 0.0;
    double organ_residual_m = 0.0; // of the gaps between organs
    double peak_stress_pa = 0.0;   // von Mises, over the soft bodies that are not resting; where
                                   // nothing moved relinearise_m, that of the last linearisation
    int inverted = 0;
    int iterations = 0; // beyond the first Newton iteration, worst body; see SolidReport
    double residual = 0.0;
    bool warped = false; // a body fell back to another tangent than the exact one
};

TissueRig make_tissue_rig(std::vector<Body> bodies, const TissueConfig& config);

/// Softest spring that must stand between tip and tissue so that the stiffness felt at the handle,
/// J^T Kc J, stays within what the device's damping holds: the lever multiplies it by (s/|f-h|)^2.
double coupling_floor_mpn(const haptics::ShaftPose& shaft, double device_npm) noexcept;

/// Makes the FEM step that answers the poses of `tools`, and fills `answer` completely.
/// Allocates nothing outside CHOLMOD, but where quadratic tissue factors anew.
StepOutcome tissue_step(TissueRig& rig, const ToolsNow& tools, TissueAnswer& answer) noexcept;

/// The surfaces for the picture, with the dimple under each tip that the mesh cannot resolve.
void draw_surface(const TissueRig& rig, SurfaceNow& out);

/// How much of each target's mark the endoscope sees; all of it if nobody asks.
void see_targets(TissueRig& rig, const ScopeNow& scope, ClearRays& out) noexcept;

/// The skin under a tool that is over a body, as deep as the tissue itself yields.
glm::dvec3 skin_under(const TissueRig& rig, int tool) noexcept;

/// Places of all targets now, with that dimple.
void place_targets(const TissueRig& rig, TargetPlaces& out) noexcept;

} // namespace sim
