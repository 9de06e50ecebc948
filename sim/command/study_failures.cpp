// sim/command/study_failures.cpp
// trocar study failures: every contact method in every failure scene; exit 1 if one does not fail,
// or does not hold, as expected.
#include "sim/command/commands.h"
#include "sim/study/failures_study.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>

namespace sim {

void add_failures_study(CLI::App& study, int& exit_code) {
    struct Arguments {
        FailureOptions options;
        std::string out;
    };
    auto a = std::make_shared<Arguments>();
    CLI::App* c = study.add_subcommand("failures", "Where contact methods fail, and ours must not");
    c->add_option("--scenes", a->options.scenes, "F1 .. ; without it all");
    c->add_option("--seed", a->options.seed, "Of random walks and crossings");
    c->add_option("--out", a->out, "Folder for CSV, page and picture")->required();
    c->callback([a, &exit_code] {
        const std::vector<FailureRow> rows = run_failures_study(a->options);
        write_failures_study(a->options, rows, a->out);
        fmt::print("{}", failures_table(rows));
        const auto unexpected =
            std::count_if(rows.begin(), rows.end(), [](const FailureRow& r) { return !r.passed; });
        fmt::print("{} rows, {} not as expected\n", rows.size(), unexpected);
        if (unexpected > 0)
            exit_code = 1;
    });
}

} // namespace sim
