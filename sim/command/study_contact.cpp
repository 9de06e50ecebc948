// sim/command/study_contact.cpp
// trocar study contact: collision methods in the table of H-Collide.
#include "sim/command/commands.h"
#include "sim/study/hcollide_study.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace sim {

void add_study_contact(CLI::App& study) {
    struct Arguments {
        HcollideOptions options;
        std::string out;
    };
    auto a = std::make_shared<Arguments>();
    CLI::App* c = study.add_subcommand("contact", "Collision methods in the table of H-Collide");
    c->add_option("--seed", a->options.seed, "Of the meshes and the path");
    c->add_option("--queries", a->options.queries, "Of each kind, per mesh")
        ->check(CLI::Range(1, 10'000'000));
    c->add_option("--rounds", a->options.rounds, "The least time of so many counts")
        ->check(CLI::Range(1, 1000));
    c->add_option("--out", a->out, "Folder for CSV, page and charts")->required();
    c->callback([a] {
        const auto say = [](const std::string& what) { fmt::print(stderr, "{}\n", what); };
        write_hcollide_study(a->options, run_hcollide_study(a->options, say), a->out);
    });
}

} // namespace sim
