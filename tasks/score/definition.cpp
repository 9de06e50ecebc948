#include "tasks/score/definition.h"

#include <algorithm>
#include <array>

namespace tasks {
namespace {

using enum Better;

constexpr MetricDefinition kDefinitions[] = {
    {"time", 1, "s", less, false},
    {"path_length", 1, "m"},
    {"economy", 1, "1", more},
    {"retraction_length", 1, "1", neither},
    {"depth_length", 1, "m"},
    {"angular_path", 1, "rad"},
    {"roll_path", 1, "rad"},
    {"speed_mean", 1, "m/s", neither},
    {"accel_mean", 1, "m/s2", neither},
    {"idle", 1, "1", neither},
    {"ldlj", 1, "1", more},
    {"sparc", 1, "1", more},
    {"jerk_norm", 1, "1"},
    {"bimanual", 1, "1", neither, false}, // the task says which way
    {"out_of_view", 1, "1"},
    {"force_mean", 1, "N", less, true, true},
    {"force_peak", 1, "N", less, true, true},
    {"impulse", 1, "N s", less, true, true},
    {"work", 1, "J", less, true, true},
    {"over_force", 1, "s", less, true, true},
    {"over_force_episodes", 1, "1", less, false, true},
    {"errors", 1, "1", less, false},
    {"errors.wrong_role", 1, "1", less, false},
    {"errors.over_force", 1, "1", less, false, true},
    {"errors.off_target", 1, "1", less, false},
    {"errors.out_of_view", 1, "1", less, false},
    {"errors.path_left", 1, "1", less, false},
    {"errors.order_broken", 1, "1", less, false},
    {"deviation_mean", 1, "m", less, false},
    {"deviation_rms", 1, "m", less, false},
    {"deviation_max", 1, "m", less, false},
    {"path_inside", 1, "1", more, false, true},
    {"path_in_band", 1, "1", more, false, true},
    {"path_coverage", 1, "1", more, false, true},
    {"path_breaks", 1, "1", less, false},
};

constexpr std::array<std::string_view, 4> kRoles{"left", "right", "assist", "scope"};

} // namespace

const MetricDefinition* definition_of(std::string_view id) noexcept {
    const std::size_t dot = id.find('.');
    const std::string_view stem = id.substr(0, dot);
    const bool of_role =
        dot != std::string_view::npos &&
        std::find(kRoles.begin(), kRoles.end(), id.substr(dot + 1)) != kRoles.end();
    for (const MetricDefinition& definition : kDefinitions)
        if (definition.id == id || (of_role && definition.per_role && definition.id == stem))
            return &definition;
    return nullptr;
}

} // namespace tasks
