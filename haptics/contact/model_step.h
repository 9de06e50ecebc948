// haptics/contact/model_step.h
// One millisecond of one local model: the modes move freely, the tools' contact points are carried
// over the patch, contact is solved for all tools together, the modes take the forces.
// Called by the couplings, for the present tick and for every replayed one.
//
//   a_m = 1/T^2 + d_m/T + lambda_m                               d_m = alpha + beta lambda_m
//   q_free = [(1/T^2 + d_m/T) q + q'/T - residual] / a_m         implicit Euler
//   W_ij = sum_m s_im s_jm^T / a_m                               s: motion of a contact per mode
#pragma once

#include "haptics/contact/coupling.h"

namespace haptics {

struct StepResult {
    std::array<bool, kTools> touching{};
    std::array<bool, kTools> grasping{};
    std::array<glm::dvec3, kTools> normal{}; // of the contacts, where touching
    int slid_off = 0;                        // tools beyond the rim of their patch
    double solve_residual_m = 0.0;
};

/// A tool this far beyond the rim of its patch has left it.
inline constexpr double kSlideOff_m = 1e-3;

/// Advances `model` (answer set) by one tick under these tips; forces are left in model.force_n.
/// A tool or a patch that is not finite gets no force; the others go on. Real-time safe.
StepResult step_model(RunningModel& model, double tick_s,
                      const std::array<ToolTip, kTools>& tips) noexcept;

} // namespace haptics
