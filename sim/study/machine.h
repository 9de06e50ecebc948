// sim/study/machine.h
// What a study ran on, in words, for its page and its picture. Called by studies; opens /proc.
#pragma once

#include <string>

namespace sim {

/// "MODEL, N processors"; "unknown processor" where the system does not tell.
std::string machine();

} // namespace sim
