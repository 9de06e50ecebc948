// sim/study/tick_times_json.h
// The one form in which times are told: by `trocar bench` and by the peers' programs.
#pragma once

#include "sim/study/tick_times.h"

#include <nlohmann/json.hpp>

namespace sim {

inline nlohmann::ordered_json tick_times_json(const TickTimes& t) {
    return {{"n", t.n},           {"mean_ns", t.mean_ns},   {"p50_ns", t.p50_ns},
            {"p99_ns", t.p99_ns}, {"p9999_ns", t.p9999_ns}, {"max_ns", t.max_ns}};
}

} // namespace sim
