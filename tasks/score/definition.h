// tasks/score/definition.h
// Every metric by id: version, unit, which way is better, what it rests on. One table, read by
// finish(), by exercise files (levels need a direction) and by whoever shows a number.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tasks {

enum class Better : std::uint8_t { less, more, neither };

struct MetricDefinition {
    std::string_view id;
    std::string_view name; // for people
    int version = 1;
    std::string_view unit; // SI, "1" for shares, counts and logarithms
    Better better = Better::less;
    bool per_role = true;  // also reported as id.left, id.right, id.assist
    bool of_force = false; // means nothing to a hand that felt no force
};

/// Of "path_length" and of "path_length.left" alike; nullptr if there is no such metric.
const MetricDefinition* definition_of(std::string_view id) noexcept;

/// For people, with whose it is: "Path length", "Path length, endoscope"; the id if nobody knows
/// it.
std::string metric_name(std::string_view id);

} // namespace tasks
