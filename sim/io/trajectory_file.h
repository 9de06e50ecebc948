// sim/io/trajectory_file.h
// A recorded motion as CSV: the bytes in, samples out. Called by commands; opens no file.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

namespace sim {

struct TrajectorySample {
    double time_s = 0.0;
    glm::dvec3 place_m{0.0};
};

/// Header with the columns t, x, y, z (s, m) in any order, rows in time order, strictly; other
/// columns are ignored. Cells are separated by commas and may be in quotation marks, with spaces
/// around; lines end with LF or CRLF; empty lines are skipped. Throws std::runtime_error naming
/// file, line, column and value, and what would be accepted: a column that is missing or twice, a
/// cell that is missing or not a finite number, a quotation mark that does not close, times out of
/// order, no rows. Takes time and memory in proportion to the bytes.
std::vector<TrajectorySample> read_trajectory(std::span<const std::byte> bytes,
                                              const std::string& file_name);

/// Where the motion is at each millisecond from its first sample to its last, on straight lines
/// between samples. Throws std::invalid_argument for more than 3600 s.
std::vector<glm::dvec3> at_ticks(std::span<const TrajectorySample> trajectory);

} // namespace sim
