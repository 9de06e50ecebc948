// sim/study/reference_record.h
// What the reference solver has pressed so far, in a file: a study that was stopped goes on where
// it was, and another model is compared without pressing again. Called by the organ study.
#pragma once

#include "sim/study/reference_press.h"

#include <filesystem>

namespace sim {

/// Places pressed so far, in order; none if there is no such file or it belongs to another `key`.
/// Throws std::runtime_error naming file and line for one that is damaged.
std::vector<ReferencePress> read_presses(const std::filesystem::path& file, const std::string& key);

/// Written beside and renamed. `key` is one line: whatever the presses depend on.
void write_presses(const std::filesystem::path& file, const std::string& key,
                   const std::vector<ReferencePress>& presses);

} // namespace sim
