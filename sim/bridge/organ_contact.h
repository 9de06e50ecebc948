// sim/bridge/organ_contact.h
// Organs that push each other and lie on the scenery, in one FEM step. Called by tissue_loop.cpp
// in this order:
//   meet_organs    the rows of this step; their forces of before are in the load of free motion
//   push_organs    forces and motion as if tools pushed as before
//   brace_tools    what the tools feel of it: rows that push hold the skin under a tool,
//                  W -= T' (W_o + C)^-1 T, T the gaps that a force of the tool would open
//   follow_tools   those rows push as the tools' new forces make them, linearly
//   push_organs    and exactly: some let go, some begin
// Resting contact costs no solve: forces of before are those of now. Tissue loop; nothing but
// make_organ_contact() allocates.
#pragma once

#include "haptics/contact/contact_rows.h"
#include "haptics/contact/local_model.h"
#include "sim/bridge/organ_rows.h"
#include "tissue/response/unilateral.h"

namespace sim {

struct TissueRig;

inline constexpr int kToolColumns = 3 * haptics::kTools;

struct OrganContact {
    OrganRows rows;
    std::vector<std::uint8_t> in_play; // by body: may move in this step, or pushes what may
    std::vector<std::uint32_t> row;    // those between bodies in play
    std::vector<double> scale;         // of these, sqrt(stiffness): force = scale * y
    std::vector<double> y, gradient, weight;
    std::vector<double> open, brace; // T and (W_o + C)^-1 T, kToolColumns for each, scaled
    std::vector<double> residual, direction, product; // of that solve
    std::vector<std::vector<double>> load; // by body, kToolColumns on the unknowns; then A^-1 of it
    tissue::UnilateralScratch scratch;
    bool braced = false;
    std::int64_t solves = 0; // of any body, since setup: for tests
    double residual_m = 0.0; // of the last push_organs
};

/// Setup, bodies at rest.
OrganContact make_organ_contact(std::span<const Body> bodies);

void meet_organs(TissueRig& rig) noexcept;
void push_organs(TissueRig& rig) noexcept;
void brace_tools(TissueRig& rig, haptics::ContactProblem& problem) noexcept;
/// `change_n`: of the forces on the tools.
void follow_tools(TissueRig& rig, std::span<const glm::dvec3> change_n) noexcept;

/// Adds what organs push a body with to the load on its unknowns; whether any does.
bool add_organ_load(const TissueRig& rig, std::size_t body, std::span<double> load_n) noexcept;

/// By an organ or by scenery, in this step.
bool is_pushed(const TissueRig& rig, std::size_t body) noexcept;

/// Keeps the forces for the next step, and wakes what is pushed by what is awake.
void keep_organ_forces(TissueRig& rig) noexcept;

/// Bodies that push each other rest together: clears `rests` of those whose neighbour does not.
void rest_together(const TissueRig& rig, std::span<std::uint8_t> rests) noexcept;

/// Modes of a local model balance f_int, of which these forces carry a part.
void add_organ_residual(TissueRig& rig, haptics::LocalModels& local) noexcept;

} // namespace sim
