// sim/command/devices.cpp
// trocar devices: what can hold a tool, what it reports, and what it is safe to do.
#include "haptics/device/virtual_device.h"
#include "sim/command/commands.h"
#include "sim/session/scene.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace sim {
namespace {

struct Entry {
    std::string name, note;
    bool feels;
    double max_force_n, safe_stiffness_npm;
};

std::vector<Entry> entries() {
    const haptics::DeviceInfo info = haptics::VirtualDeviceModel{}.info;
    // Colgate & Schenkel 1997 with a margin: K < 0.8 x 2 b / T
    const double safe = 0.8 * 2.0 * info.damping_nspm / kTick_s;
    return {
        {"virtual",
         "simulated haptic device with a grip; three of them hold the tools in "
         "scripted runs",
         true, info.max_force_n, safe},
        {"mouse", "mouse and keyboard in the window; forces are drawn, not felt", false, 0.0, 0.0}};
}

void list(bool json) {
    if (json) {
        nlohmann::ordered_json all = nlohmann::ordered_json::array();
        for (const Entry& e : entries()) {
            all.push_back({{"name", e.name},
                           {"feels", e.feels},
                           {"max_force_n", e.max_force_n},
                           {"safe_stiffness_npm", e.safe_stiffness_npm},
                           {"note", e.note}});
        }
        fmt::print("{}\n", nlohmann::ordered_json{{"devices", all}, {"hardware", 0}}.dump());
        return;
    }
    for (const Entry& e : entries()) {
        fmt::print("{:<8} {:<12} {}\n", e.name,
                   e.feels ? fmt::format("<= {:.0f} N", e.max_force_n) : "no force", e.note);
        if (e.feels)
            fmt::print("{:<21} stiffness up to {:.0f} N/m is safe\n", "", e.safe_stiffness_npm);
    }
    fmt::print("No driver for hardware is built in yet; none was ever run on hardware.\n");
}

} // namespace

void add_devices(CLI::App& app, int&) {
    auto json = std::make_shared<bool>(false);
    CLI::App* c = app.add_subcommand("devices", "What can hold a tool, and what it is safe to do");
    c->add_flag("--json", *json, "One JSON object instead of a table");
    c->callback([json] { list(*json); });
}

} // namespace sim
