#include "tasks/score/definition.h"

#include <algorithm>
#include <array>

namespace tasks {
namespace {

using enum Better;

constexpr MetricDefinition kDefinitions[] = {
    {"time", "Time", 1, "s", less, false},
    {"path_length", "Path length", 1, "m"},
    {"economy", "Economy of path", 1, "1", more},
    {"retraction_length", "Careful way over path", 1, "1", neither},
    {"depth_length", "Depth path", 1, "m"},
    {"angular_path", "Angular path", 1, "rad"},
    {"roll_path", "Roll path", 1, "rad"},
    {"speed_mean", "Mean speed", 1, "m/s", neither},
    {"accel_mean", "Mean acceleration", 1, "m/s2", neither},
    {"idle", "Share at rest", 1, "1", neither},
    {"ldlj", "Smoothness (jerk)", 1, "1", more},
    {"sparc", "Smoothness (spectrum)", 1, "1", more},
    {"jerk_norm", "Normalised jerk", 1, "1"},
    {"bimanual", "Hands together", 1, "1", neither, false}, // the task says which way
    {"out_of_view", "Out of the picture", 1, "1"},
    {"force_mean", "Mean force", 1, "N", less, true, true},
    {"force_peak", "Peak force", 1, "N", less, true, true},
    {"impulse", "Impulse", 1, "N s", less, true, true},
    {"work", "Work on the tissue", 1, "J", less, true, true},
    {"over_force", "Time over the limit", 1, "s", less, true, true},
    {"over_force_episodes", "Times over the limit", 1, "1", less, false, true},
    {"errors", "Errors", 1, "1", less, false},
    {"errors.wrong_role", "Wrong tool", 1, "1", less, false},
    {"errors.over_force", "Too much force", 1, "1", less, false, true},
    {"errors.off_target", "Off target", 1, "1", less, false},
    {"errors.out_of_view", "Worked unseen", 1, "1", less, false},
    {"errors.path_left", "Left the path", 1, "1", less, false},
    {"errors.order_broken", "Order broken", 1, "1", less, false},
    {"errors.tube_not_pointed", "Tube seen, not pointed at", 1, "1", less, false},
    {"errors.tube_not_seen", "Tube pointed at, not seen", 1, "1", less, false},
    {"deviation_mean", "Mean distance from path", 1, "m", less, false},
    {"deviation_rms", "RMS distance from path", 1, "m", less, false},
    {"deviation_max", "Largest distance from path", 1, "m", less, false},
    {"path_inside", "Share on the path", 1, "1", more, false, true},
    {"path_in_band", "Share of right force", 1, "1", more, false, true},
    {"path_coverage", "Share of path followed", 1, "1", more, false, true},
    {"path_breaks", "Gaps", 1, "1", less, false},
    {"tubes_found", "Tubes found", 1, "1", more, false},
    {"retraction_force", "Mean force of the lift", 1, "N", less, false, true},
    {"retraction_force_peak", "Peak force of the lift", 1, "N", less, false, true},
    {"horizon_rms", "Picture off level", 1, "rad", less, false},
    {"horizon_over", "Picture over 15 degrees off", 1, "1", less, false},
    {"stress_peak", "Peak stress in tissue", 1, "Pa", less, false, true},
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

std::string metric_name(std::string_view id) {
    const MetricDefinition* definition = definition_of(id);
    if (!definition)
        return std::string(id);
    std::string name(definition->name);
    if (definition->id != id) {
        const std::string_view role = id.substr(id.find('.') + 1);
        name += ", " + (role == "scope" ? "endoscope" : std::string(role) + " tool");
    }
    return name;
}

} // namespace tasks
