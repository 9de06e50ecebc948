#include "sim/study/scaling_study.h"

#include "haptics/collision/index.h"
#include "sim/study/contact_bench.h"
#include "sim/study/peer_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

namespace sim {
namespace {

constexpr std::array kFigures{&ScalingTimes::mean_ns,     &ScalingTimes::p50_ns,
                              &ScalingTimes::p99_ns,      &ScalingTimes::cold_mean_ns,
                              &ScalingTimes::cold_p50_ns, &ScalingTimes::cold_p99_ns,
                              &ScalingTimes::refit_ms,    &ScalingTimes::build_ms};

void check(const ScalingOptions& o) {
    if (o.shape != "organ" && o.shape != "sheet")
        throw std::invalid_argument("shape '" + o.shape + "': accepted: organ, sheet");
    if (o.rounds < 1 || o.cold_every < 0 || !(o.reach_m > 0.0))
        throw std::invalid_argument("scaling study: rounds from 1, cold-every from 0, reach above "
                                    "0");
    for (const std::string& name : o.methods)
        if (std::ranges::find(haptics::kCollisionNames, name) == haptics::kCollisionNames.end()) {
            const haptics::MeshView none;
            (void)haptics::make_index(name, none); // says what is accepted
        }
}

ScalingTimes times_of(const ContactBench& b) {
    return {b.contact.mean_ns, b.contact.p50_ns, b.contact.p99_ns, b.cold.mean_ns,
            b.cold.p50_ns,     b.cold.p99_ns,    b.refit_ms,       b.build_ms};
}

ScalingRow measured(const ScalingOptions& o, const std::string& size, const std::string& method,
                    const std::string& contact, ScalingStudy& study) {
    const ContactScene scene =
        built_in_scene(o.shape + ":" + size, o.seconds, o.seed, o.radius_m, o.breathing);
    ContactBenchOptions options{.method = method, .contact = contact};
    options.radius_m = o.radius_m;
    options.reach_m = o.reach_m;
    options.cold = o.cold_every > 0;
    options.cold_every = std::max(1, o.cold_every);
    const ContactBench bench = run_contact_bench(scene, options);
    study.clock_overhead_ns = bench.clock_overhead_ns;
    ScalingRow row;
    row.size = size;
    row.name = contact == "none" ? method : method + "+" + contact;
    row.triangles = bench.triangles;
    row.contact_ticks = bench.contact.n;
    row.times = times_of(bench);
    row.distance_sum_m = bench.distance_sum_m;
    return row;
}

std::vector<std::string> peer_arguments(const ScalingOptions& o, const std::string& size) {
    std::vector<std::string> out{o.shape + ":" + size,
                                 "--seconds",
                                 fmt::format("{}", o.seconds),
                                 "--seed",
                                 fmt::format("{}", o.seed),
                                 "--radius",
                                 fmt::format("{}", 1e3 * o.radius_m),
                                 "--reach",
                                 fmt::format("{}", 1e3 * o.reach_m),
                                 "--breathe",
                                 fmt::format("{}", 1e3 * o.breathing.amplitude_m),
                                 "--wave",
                                 o.breathing.wave == Wave::radial ? "radial" : "travelling"};
    if (o.cold_every > 0)
        out.insert(out.end(), {"--cold", "--cold-every", fmt::format("{}", o.cold_every)});
    return out;
}

void note_gap(ScalingStudy& study, const std::string& peer, const std::string& why) {
    if (std::ranges::none_of(study.gap, [&](const auto& g) { return g.first == peer; }))
        study.gap.emplace_back(peer, why);
}

/// A peer's object holds one row or several.
std::vector<ScalingRow> peer_rows(const ScalingOptions& o, const std::string& size,
                                  const std::string& peer, ScalingStudy& study) {
    const PeerOutput output =
        run_peer_program(o.peer_dir / (peer + "_peer"), peer_arguments(o, size));
    if (!output.gap.empty()) {
        note_gap(study, peer, output.gap);
        return {};
    }
    std::vector<ScalingRow> rows;
    try {
        const auto answer = nlohmann::ordered_json::parse(output.text);
        for (const auto& j : answer) {
            ScalingRow row;
            row.size = size;
            row.name = j.at("method");
            row.triangles = j.at("triangles");
            row.contact_ticks = j.at("contact").at("n");
            const auto &hot = j.at("contact"), &cold = j.at("cold");
            row.times = {hot.at("mean_ns"), hot.at("p50_ns"),  hot.at("p99_ns"), cold.at("mean_ns"),
                         cold.at("p50_ns"), cold.at("p99_ns"), j.at("refit_ms"), j.at("build_ms")};
            row.distance_sum_m = j.at("distance_sum_m");
            rows.push_back(row);
        }
    } catch (const nlohmann::json::exception& e) {
        note_gap(study, peer, fmt::format("its answer is not understood: {}", e.what()));
    }
    return rows;
}

using Entry = std::function<std::vector<ScalingRow>(const std::string& size)>;

std::vector<Entry> entries_of(const ScalingOptions& o, ScalingStudy& study) {
    std::vector<Entry> out;
    for (const std::string& method : o.methods) {
        std::vector<std::string> contacts{"none"};
        contacts.insert(contacts.end(), o.contacts.begin(), o.contacts.end());
        for (const std::string& contact : contacts)
            out.push_back([&o, &study, method, contact](const std::string& size) {
                return std::vector{measured(o, size, method, contact, study)};
            });
    }
    for (const std::string& peer : o.peers)
        out.push_back([&o, &study, peer](const std::string& size) {
            return peer_rows(o, size, peer, study);
        });
    return out;
}

double median(std::vector<double> values) {
    if (values.empty())
        return 0.0;
    std::ranges::sort(values);
    const std::size_t n = values.size();
    return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

std::vector<const ScalingRow*> rows_of(const ScalingStudy& study, const std::string& size,
                                       const std::string& name) {
    std::vector<const ScalingRow*> out;
    for (const ScalingRow& r : study.row)
        if (r.size == size && r.name == name)
            out.push_back(&r);
    return out;
}

} // namespace

std::vector<std::string> scaling_methods() {
    std::vector<std::string> out;
    for (const std::string_view name : haptics::kCollisionNames)
        if (name != "brute-force")
            out.emplace_back(name);
    return out;
}

std::vector<std::string> ScalingStudy::names() const {
    std::vector<std::string> out;
    std::set<std::string> seen;
    for (const ScalingRow& r : row)
        if (seen.insert(r.name).second)
            out.push_back(r.name);
    return out;
}

ScalingStudy run_scaling_study(const ScalingOptions& o,
                               const std::function<void(const ScalingRow&)>& progress) {
    check(o);
    ScalingStudy study;
    std::vector<Entry> entries = entries_of(o, study);
    for (int round = 0; round < o.rounds; ++round) {
        for (const std::string& size : o.sizes)
            for (const Entry& entry : entries)
                for (ScalingRow& row : entry(size)) {
                    row.round = round;
                    progress(row);
                    study.row.push_back(row);
                }
        std::ranges::reverse(entries); // so that nobody is always the first
    }
    return study;
}

ScalingTimes median_times(const ScalingStudy& study, const std::string& size,
                          const std::string& name) {
    ScalingTimes out;
    for (const auto figure : kFigures) {
        std::vector<double> values;
        for (const ScalingRow* r : rows_of(study, size, name))
            values.push_back(r->times.*figure);
        out.*figure = median(values);
    }
    return out;
}

ScalingTimes median_ratios(const ScalingStudy& study, const std::string& size,
                           const std::string& name, const std::string& over) {
    ScalingTimes out;
    const auto others = rows_of(study, size, over);
    for (const auto figure : kFigures) {
        std::vector<double> values;
        for (const ScalingRow* r : rows_of(study, size, name))
            for (const ScalingRow* other : others)
                if (other->round == r->round && other->times.*figure > 0.0)
                    values.push_back(r->times.*figure / (other->times.*figure));
        out.*figure = median(values);
    }
    return out;
}

bool answers_agree(const ScalingStudy& study, const std::string& size) {
    double least = 0.0, most = 0.0;
    for (const ScalingRow& r : study.row)
        if (r.size == size && r.distance_sum_m > 0.0) {
            least = least > 0.0 ? std::min(least, r.distance_sum_m) : r.distance_sum_m;
            most = std::max(most, r.distance_sum_m);
        }
    return most - least <= 1e-5 * most;
}

} // namespace sim
