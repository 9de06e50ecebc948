// sim/bridge/answer_to_local_model.h
// From the state after a FEM step to the message that the haptic loop lives on: modes of the
// bodies near tools, and for each tool the patch of skin that it can reach before the next answer.
// Called by the tissue loop only.
#pragma once

#include "sim/loop/tissue_loop.h"

namespace sim {

/// Computes the modes and fills all of `local` that belongs to this step.
void make_local_models(TissueRig& rig, haptics::LocalModels& local) noexcept;

} // namespace sim
