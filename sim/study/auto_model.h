// sim/study/auto_model.h
// --model auto: the choice of trocar study why for one exercise in one scene, made on the motion of
// its expert and remembered, so that it is made once. Called by commands before a session.
#pragma once

#include "sim/session/session.h"

#include <filesystem>

namespace sim {

struct AutoModel {
    std::string model, why; // as --model takes it; in plain words with the margins
    int fem_hz = 0;         // that are enough
    bool remembered = false;
};

/// `choose_rate`: fewer FEM steps a second than `options` say, where that is enough. What is
/// remembered lies in `memory`, a file of JSON by the hash of scene, exercise, FEM rate and
/// build; one that cannot be read or written costs only time, and `say` hears why. Throws as
/// run_why_study() does.
AutoModel auto_model(const RunOptions& options, bool choose_rate,
                     const std::filesystem::path& memory, void (*say)(const std::string&));

/// Where commands remember: models.json in the user's data directory.
std::filesystem::path model_memory();

} // namespace sim
