// sim/main.cpp
// The one program: picks a command and runs it. Exit 0: done; 1: rig fault or a failed
// expectation; 2: bad usage or bad input, and the message says what would be accepted.
#include "sim/command/commands.h"

#include <CLI/CLI.hpp>
#include <exception>
#include <fmt/format.h>

int main(int argc, char** argv) {
    CLI::App app{"Trocar: an open trainer for laparoscopic basic skills. Not a medical device; "
                 "scores are for training, not for credentialing."};
    app.require_subcommand(1);
    app.set_help_all_flag("--help-all", "Help of every command");
    int exit_code = 0;
    sim::add_train(app, exit_code);
    sim::add_run(app, exit_code);
    sim::add_replay(app, exit_code);
    sim::add_rescore(app, exit_code);
    sim::add_trainee(app, exit_code);
    sim::add_note(app, exit_code);
    sim::add_scene(app, exit_code);
    sim::add_study(app, exit_code);
    sim::add_bench(app, exit_code);
    sim::add_import(app, exit_code);
    sim::add_devices(app, exit_code);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        const int code = app.exit(e);
        return code == 0 ? 0 : 2;
    } catch (const std::exception& e) {
        fmt::print(stderr, "trocar: {}\n", e.what());
        return 2;
    }
    return exit_code;
}
