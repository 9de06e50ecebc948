#include "tasks/exercise/find_hint.h"

#include <fmt/format.h>

namespace tasks {
namespace {

bool counts(const Exercise& exercise, const Observation& seen, std::size_t tube) {
    return tube_seen(exercise, seen, tube) &&
           tube_pointed(exercise, seen, tube, static_cast<int>(exercise.target[tube].role));
}

int tube_of(const Exercise& exercise, const Observation& seen, std::uint32_t found) {
    int nearest = -1;
    double nearest_off = 0.0;
    for (std::size_t k = 0; k < exercise.target.size(); ++k) {
        if (found & (1U << k))
            continue;
        if (counts(exercise, seen, k))
            return static_cast<int>(k);
        const double off = off_centre(seen.view, seen.target[k].position_m);
        if (nearest < 0 || off < nearest_off) {
            nearest = static_cast<int>(k);
            nearest_off = off;
        }
    }
    return nearest;
}

// Hidden: by what has to be lifted, or by something else.
FindHint hidden(const Exercise& exercise, const Observation& seen, int tube) {
    if (!exercise.lift || is_lifted(exercise, seen))
        return {tube, false, fmt::format("Tube {} is hidden: look from another side", tube + 1)};
    const Lift& lift = *exercise.lift;
    const std::string what = lift.organ.empty() ? "tissue" : lift.organ;
    if (!is_held_to_lift(exercise, seen))
        return {tube, true,
                fmt::format("Lift the {} with the {} tool", what, role_name(lift.role))};
    return {tube, true, fmt::format("Lift the {} higher", what)};
}

} // namespace

FindHint find_hint(const Exercise& exercise, const Observation& seen, std::uint32_t found) {
    const int tube = tube_of(exercise, seen, found);
    if (tube < 0)
        return {-1, false, "All tubes found"};
    const auto k = static_cast<std::size_t>(tube);
    const auto role = static_cast<int>(exercise.target[k].role);
    const int number = tube + 1;
    if (seen.target[k].clear_rays < kEnoughRays)
        return hidden(exercise, seen, tube);
    if (off_centre(seen.view, seen.target[k].position_m) > exercise.centre_share)
        return {tube, false, fmt::format("Bring tube {} into the ring", number)};
    if (!tube_seen(exercise, seen, k))
        return {tube, false, fmt::format("Nearer to tube {}", number)};
    if (!tube_pointed(exercise, seen, k, role))
        return {tube, false,
                fmt::format("Point at tube {} with the {} tool", number,
                            role_name(exercise.target[k].role))};
    return {tube, false, fmt::format("Tube {}: hold still", number)};
}

} // namespace tasks
