#include "sim/command/report.h"

#include <fmt/format.h>

namespace sim {

nlohmann::ordered_json profile_json(const Attempt::Outcome& outcome) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const tasks::ProfileRow& row : outcome.profile) {
        nlohmann::ordered_json value;
        if (row.value)
            value = *row.value;
        all.push_back({{"metric", row.metric},
                       {"name", row.name},
                       {"unit", row.unit},
                       {"value", value},
                       {"good", row.good},
                       {"pass", row.pass},
                       {"lower_is_better", row.lower_is_better},
                       {"felt", row.felt},
                       {"reached", tasks::reached_name(row.reached)},
                       {"share", row.share}});
    }
    return all;
}

nlohmann::ordered_json moments_json(const Attempt::Outcome& outcome) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const tasks::Moment& m : outcome.moments) {
        all.push_back({{"tick", m.tick},
                       {"tool", m.tool},
                       {"place_m", {m.place_m.x, m.place_m.y, m.place_m.z}},
                       {"kind", m.kind},
                       {"badness", m.badness},
                       {"text", m.text}});
    }
    return all;
}

nlohmann::ordered_json outcome_json(const Attempt::Outcome& outcome) {
    using nlohmann::ordered_json;
    const tasks::AttemptRow& row = outcome.row;
    ordered_json metrics = ordered_json::object();
    for (const tasks::Metric& m : outcome.metrics)
        metrics[m.id] = m.value;
    ordered_json events = ordered_json::array();
    for (const tasks::Event& e : outcome.events) {
        events.push_back({{"tick", e.tick},
                          {"kind", tasks::event_name(e.kind)},
                          {"error", tasks::is_error(e.kind)},
                          {"tool", e.tool},
                          {"target", e.target},
                          {"place_m", {e.place_m.x, e.place_m.y, e.place_m.z}},
                          {"value", e.value}});
    }
    const tasks::RigReport& r = row.rig;
    return {{"exercise", row.exercise},
            {"completed", row.completed},
            {"valid", row.valid},
            {"seed", row.seed},
            {"log_sha256", row.log_sha256},
            {"metrics", metrics},
            {"profile", profile_json(outcome)},
            {"moments", moments_json(outcome)},
            {"events", events},
            {"rig",
             {{"tick_us",
               {{"p50", r.tick_us_p50},
                {"p99", r.tick_us_p99},
                {"p9999", r.tick_us_p9999},
                {"max", r.tick_us_max}}},
              {"fem_ms", {{"p50", r.fem_ms_p50}, {"p99", r.fem_ms_p99}, {"max", r.fem_ms_max}}},
              {"missed", r.missed},
              {"dropped", r.dropped},
              {"force_step_mn", {{"p999", r.force_step_mn_p999}, {"max", r.force_step_mn_max}}},
              {"energy_min_j", r.energy_min_j},
              {"faults", r.faults}}},
            {"model", row.model},
            {"model_why", row.model_why},
            {"coupling", row.coupling},
            {"hands", row.hands},
            {"fem_hz", row.fem_hz},
            {"attempt", row.id}};
}

std::string outcome_table(const Attempt::Outcome& outcome) {
    const tasks::AttemptRow& row = outcome.row;
    std::string out = fmt::format("{}  {}  {}  hands {}  seed {}\n", row.exercise,
                                  row.completed ? "completed" : "incomplete",
                                  row.valid ? "valid" : "NOT VALID", row.hands, row.seed);
    for (const tasks::Metric& m : outcome.metrics) {
        out += fmt::format("  {:<28} {:>12.5g} {:<6}{}\n", m.id, m.value, m.unit,
                           m.felt ? "" : " not felt");
    }
    for (const std::string& fault : row.rig.faults)
        out += fmt::format("  fault: {}\n", fault);
    out += fmt::format("  tick {:.1f} us median, {:.1f} us p99.99; FEM step {:.2f} ms median, "
                       "{:.2f} ms p99\n  log {}\n",
                       row.rig.tick_us_p50, row.rig.tick_us_p9999, row.rig.fem_ms_p50,
                       row.rig.fem_ms_p99, row.log_sha256);
    return out;
}

} // namespace sim
