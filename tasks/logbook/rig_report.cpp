// tasks/logbook/rig_report.cpp
// RigReport to JSON and back; see rig_report.h.
#include "tasks/logbook/rig_report.h"

#include <limits>
#include <nlohmann/json.hpp>

namespace tasks {
namespace {

// One list of keys for both directions: `field(path, value)`.
template <class Rig, class Field> void for_each_number(Rig& rig, Field&& field) {
    field("/tick_us/p50", rig.tick_us_p50);
    field("/tick_us/p99", rig.tick_us_p99);
    field("/tick_us/p9999", rig.tick_us_p9999);
    field("/tick_us/max", rig.tick_us_max);
    field("/fem_ms/p50", rig.fem_ms_p50);
    field("/fem_ms/p99", rig.fem_ms_p99);
    field("/fem_ms/max", rig.fem_ms_max);
    field("/missed", rig.missed);
    field("/dropped", rig.dropped);
    field("/force_step_mn/p999", rig.force_step_mn_p999);
    field("/force_step_mn/max", rig.force_step_mn_max);
    field("/energy_min_j", rig.energy_min_j);
}

} // namespace

std::string rig_json(const RigReport& rig) {
    nlohmann::json json = nlohmann::json::object();
    for_each_number(rig, [&json](const char* path, const auto& value) {
        json[nlohmann::json::json_pointer(path)] = value;
    });
    json["faults"] = rig.faults;
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

RigReport parse_rig(std::string_view text) {
    try {
        const auto json = nlohmann::json::parse(text);
        if (!json.is_object())
            throw std::invalid_argument("rig report: not a JSON object");
        RigReport rig;
        for_each_number(rig, [&json](const char* path, auto& value) {
            using Value = std::remove_reference_t<decltype(value)>;
            const nlohmann::json::json_pointer pointer(path);
            if (!json.contains(pointer))
                return;
            if (std::is_floating_point_v<Value> && json.at(pointer).is_null())
                value = std::numeric_limits<Value>::quiet_NaN();
            else
                value = json.at(pointer).template get<Value>();
        });
        if (json.contains("faults"))
            rig.faults = json.at("faults").get<std::vector<std::string>>();
        return rig;
    } catch (const nlohmann::json::exception& error) {
        throw std::invalid_argument(std::string("rig report: ") + error.what());
    }
}

} // namespace tasks
