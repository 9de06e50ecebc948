// trocar import SURFACE: becomes the program `bake`, which reads surfaces and links TetGen. TetGen
// is AGPL, so it must stay out of this program; the new program takes this one's place, so that
// signals, output and exit code are its own.
#include "sim/command/commands.h"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

namespace sim {
namespace {

namespace fs = std::filesystem;

/// $TROCAR_BAKE, or beside this program, or where the build put it.
fs::path find_bake() {
    std::error_code error;
    const char* set = std::getenv("TROCAR_BAKE");
    const fs::path named = set != nullptr ? set : "";
    const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / "bake";
    for (const fs::path& place : {named, beside, fs::path(TROCAR_BAKE)}) {
        if (!place.empty() && fs::is_regular_file(place, error))
            return place;
    }
    throw std::runtime_error(
        fmt::format("import: the program bake is not there (tried $TROCAR_BAKE, "
                    "{} and {})",
                    beside.string(), TROCAR_BAKE));
}

void become_bake(std::vector<std::string> arguments) {
    const fs::path bake = find_bake();
    std::string name = bake.string(), verb = "import";
    std::vector<char*> argv{name.data(), verb.data()};
    for (auto& a : arguments)
        argv.push_back(a.data());
    argv.push_back(nullptr);
    execv(name.c_str(), argv.data());
    throw std::runtime_error(
        fmt::format("import: {} does not start: {}", bake.string(), std::strerror(errno)));
}

} // namespace

void add_import(CLI::App& app, int&) {
    CLI::App* c = app.add_subcommand(
        "import", "A surface file (STL, OBJ, PLY, OFF) to organs: checked, repaired or refused");
    c->prefix_command(); // everything behind it is bake's, --help too
    c->set_help_flag();
    c->set_help_all_flag();
    c->callback([c] { become_bake(c->remaining()); });
}

} // namespace sim
