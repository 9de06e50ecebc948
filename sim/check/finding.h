// sim/check/finding.h
// One thing that a scene lacks or that an exercise asks in vain, with the place in the file to look
// at. Made by the checks, printed by commands.
#pragma once

#include "tasks/exercise/toml_reader.h"

namespace sim {

struct Finding {
    std::string kind; // for machines: not_held, overlap, out_of_reach, ...
    tasks::Mention at;
    std::string accepted;
};

inline std::string text_of(const Finding& finding) {
    return tasks::message_of(finding.at, finding.accepted);
}

} // namespace sim
