// sim/bridge/contact_rows.h
// From tool poses to the contact problem of one FEM step: which skin point each tool is over, and
// how that point yields. Called by the tissue loop only.
#pragma once

#include "sim/loop/tissue_loop.h"

namespace sim {

/// Finds or follows the skin point under each tool: a touching tool is followed by walking, so
/// that it can never change sides; a free one takes the nearest skin within reach.
void follow_contacts(TissueRig& rig, const ToolsNow& tools) noexcept;

/// Rows of all tools near a body, condensed through the body's factor: fills `answer_m` of each
/// soft body and the compliance blocks of `problem`, and frees its skin of the forces of before.
void condense_rows(TissueRig& rig, haptics::ContactProblem& problem) noexcept;

/// Tip, gap and law of each active row, the tissue displaced by the step's free motion.
void fill_rows(const TissueRig& rig, const ToolsNow& tools,
               haptics::ContactProblem& problem) noexcept;

/// Adds to the step's motion what the contact forces changed by, du -= A^-1 H^T dF, and keeps all
/// of them in `load_n`.
void apply_forces(TissueRig& rig, const haptics::ContactProblem& problem,
                  const haptics::ContactSolution& solution) noexcept;

/// Carries out the slip that the solve found: each contact point walks over the new skin.
void slide_contacts(TissueRig& rig, const haptics::ContactSolution& solution) noexcept;

} // namespace sim
