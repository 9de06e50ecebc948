// tasks/logbook/summary.cpp
// Attempts grouped by trainee, printed as text or JSON; see summary.h.
#include "tasks/logbook/summary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>

namespace tasks {
namespace {

std::optional<Metric> newest(std::span<const Metric> metrics, std::string_view id) {
    const Metric* best = nullptr;
    for (const Metric& metric : metrics)
        if (metric.id == id && (best == nullptr || metric.version > best->version))
            best = &metric;
    return best ? std::optional(*best) : std::nullopt;
}

AttemptSummary summary_of(Logbook& logbook, const AttemptRow& row) {
    AttemptSummary summary;
    summary.id = row.id;
    summary.started_utc = row.started_utc;
    summary.exercise = row.exercise;
    if (const auto session = logbook.session(row.session))
        summary.input_class = session->input_class;
    summary.ended = row.ended;
    summary.completed = row.completed;
    summary.valid = row.valid;
    summary.forces_on = row.forces_on;
    const std::vector<Metric> metrics = logbook.metrics(row.id);
    summary.time = newest(metrics, "time");
    summary.path_length = newest(metrics, "path_length");
    summary.errors = newest(metrics, "errors");
    summary.force_peak = newest(metrics, "force_peak");
    return summary;
}

// Heading and rows alike.
constexpr char kRow[] = "  {:>7}  {:<20}  {:<14}  {:<10}  {:<10}  {:<5}  {:>8}  {:>8}  {:>6}  "
                        "{:>13}\n";

std::string cell(const std::optional<Metric>& metric, int decimals) {
    if (!metric || !std::isfinite(metric->value))
        return "-";
    if (!metric->felt)
        return "not felt";
    return fmt::format("{:.{}f}", metric->value, decimals);
}

std::string_view outcome(const AttemptSummary& attempt) {
    if (!attempt.ended)
        return "broken off";
    return attempt.completed ? "complete" : "incomplete";
}

} // namespace

std::vector<TraineeSummary> summarise(Logbook& logbook) {
    std::map<std::string, std::vector<AttemptSummary>> by_trainee;
    for (const AttemptRow& row : logbook.attempts())
        by_trainee[row.trainee].push_back(summary_of(logbook, row));
    std::vector<TraineeSummary> list;
    for (const Logbook::Trainee& trainee : logbook.trainees()) {
        list.push_back({trainee.id, trainee.name, std::move(by_trainee[trainee.id])});
        by_trainee.erase(trainee.id);
    }
    // The empty id sorts first and belongs last.
    auto nobody = by_trainee.extract(std::string());
    for (auto& [id, attempts] : by_trainee)
        list.push_back({id, "", std::move(attempts)});
    if (!nobody.empty())
        list.push_back({"", "", std::move(nobody.mapped())});
    return list;
}

std::string summary_text(std::span<const TraineeSummary> trainees) {
    std::string text;
    for (const TraineeSummary& trainee : trainees) {
        const std::string_view name = !trainee.name.empty() ? std::string_view(trainee.name)
                                      : trainee.id.empty()  ? "(no trainee)"
                                                            : "(name deleted)";
        text +=
            fmt::format("{}{}{}: {} attempt{}\n", name, trainee.id.empty() ? "" : "  ", trainee.id,
                        trainee.attempts.size(), trainee.attempts.size() == 1 ? "" : "s");
        if (trainee.attempts.empty())
            continue;
        text += fmt::format(kRow, "attempt", "started (UTC)", "exercise", "input", "outcome",
                            "valid", "time, s", "path, m", "errors", "peak force, N");
        for (const AttemptSummary& attempt : trainee.attempts)
            text += fmt::format(kRow, attempt.id, attempt.started_utc, attempt.exercise,
                                attempt.input_class, outcome(attempt), attempt.valid ? "yes" : "no",
                                cell(attempt.time, 1), cell(attempt.path_length, 3),
                                cell(attempt.errors, 0), cell(attempt.force_peak, 2));
    }
    return text;
}

std::string summary_json(std::span<const TraineeSummary> trainees) {
    auto list = nlohmann::json::array();
    for (const TraineeSummary& trainee : trainees) {
        auto attempts = nlohmann::json::array();
        for (const AttemptSummary& attempt : trainee.attempts) {
            auto metrics = nlohmann::json::object();
            for (const auto* metric :
                 {&attempt.time, &attempt.path_length, &attempt.errors, &attempt.force_peak})
                if (*metric)
                    metrics[(*metric)->id] = {{"value", (*metric)->value},
                                              {"unit", (*metric)->unit},
                                              {"version", (*metric)->version},
                                              {"felt", (*metric)->felt}};
            attempts.push_back({{"id", attempt.id},
                                {"started_utc", attempt.started_utc},
                                {"exercise", attempt.exercise},
                                {"input_class", attempt.input_class},
                                {"ended", attempt.ended},
                                {"completed", attempt.completed},
                                {"valid", attempt.valid},
                                {"forces_on", attempt.forces_on},
                                {"metrics", metrics}});
        }
        nlohmann::json name; // null: not known
        if (!trainee.name.empty())
            name = trainee.name;
        list.push_back({{"id", trainee.id}, {"name", name}, {"attempts", attempts}});
    }
    const nlohmann::json json = {{"trainees", list}};
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace tasks
