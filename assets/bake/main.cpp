// bake: recipe to baked organ, at build time or by hand; and surface file to organs (import_main).
// One thread; TetGen in a child process.
//
// Licence: this source is Apache-2.0 like the rest, but the program links TetGen, which is
// AGPL-3.0-or-later; the built program may be passed on under the AGPL-3.0 only. What it writes is
// not bound by that. The trainer itself does not link TetGen.
#include "assets/bake/bake.h"
#include "assets/bake/import/import_main.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

namespace {

enum ExitCode { kDone = 0, kRefused = 1, kBadInput = 2 };

struct Arguments {
    std::string recipe, out, report, obj;
    double edge_mm = 0.0, skin_mm = 0.0, time_limit_s = 60.0;
    bool quadratic = false;
};

std::string read_file(const std::string& name) {
    std::ifstream in(name, std::ios::binary);
    std::ostringstream text;
    if (!in || !(text << in.rdbuf())) {
        throw bake::RecipeError(fmt::format("{}: cannot be read", name));
    }
    return text.str();
}

/// Whole or not at all: under another name first, then renamed.
void write_file(const std::string& name, const char* data, std::size_t size) {
    const std::string part = name + ".part";
    {
        std::ofstream out(part, std::ios::binary | std::ios::trunc);
        out.write(data, static_cast<std::streamsize>(size));
        out.flush();
        if (!out) {
            throw bake::RecipeError(fmt::format("{}: cannot be written", part));
        }
    }
    if (std::rename(part.c_str(), name.c_str()) != 0) {
        throw bake::RecipeError(fmt::format("{}: cannot be renamed to {}", part, name));
    }
}

void show_share(double share) {
    static int tenth = 0;
    for (; tenth < static_cast<int>(10.0 * share); ++tenth) {
        fmt::print("  mesh terms {} %\n", 10 * (tenth + 1));
        std::fflush(stdout);
    }
}

void run(const Arguments& a) {
    bake::Recipe recipe = bake::parse_recipe(read_file(a.recipe), a.recipe);
    if (a.edge_mm > 0.0 && a.quadratic) {
        recipe.quadratic_edge_mm = a.edge_mm;
    } else if (a.edge_mm > 0.0) {
        recipe.edge_mm = a.edge_mm;
    }
    recipe.skin_mm = a.skin_mm > 0.0 ? a.skin_mm : recipe.skin_mm;
    const auto tell = [&](const std::string& line) {
        fmt::print("{}: {}\n", recipe.name, line);
        std::fflush(stdout);
    };
    const bake::Baked baked = bake::bake(recipe, {.order = a.quadratic ? 2 : 1,
                                                  .time_limit_s = a.time_limit_s,
                                                  .tell = tell,
                                                  .mesh_term_progress = show_share});
    const std::string report = report_json(recipe, baked);
    fmt::print("{}", report);
    if (!a.report.empty()) {
        write_file(a.report, report.data(), report.size());
    }
    if (!a.obj.empty()) {
        const std::string obj = obj_text(baked);
        write_file(a.obj, obj.data(), obj.size());
    }
    const auto bytes = tissue::write_organ(baked.organ);
    write_file(a.out, reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

} // namespace

int main(int argc, char** argv) {
    if (argc > 1 && std::string_view(argv[1]) == "import") {
        return bake::import_main(argc - 1, argv + 1);
    }
    Arguments a;
    CLI::App app{"Bakes an organ: recipe to tetrahedra, skin and footprints.\n"
                 "Exit 0: done; 1: refused, with the reason; 2: bad usage or bad recipe.\n"
                 "bake import SURFACE: a surface file to organs; see bake import --help."};
    app.add_option("recipe", a.recipe, "TOML file")->required()->type_name("RECIPE.toml");
    app.add_option("--out", a.out, "baked organ to write")->required()->type_name("FILE.organ");
    app.add_option("--report", a.report, "write the report as JSON")->type_name("FILE.json");
    app.add_option("--obj", a.obj, "write skin and boundary for looking at")->type_name("FILE.obj");
    app.add_flag("--quadratic", a.quadratic,
                 "coarser tetrahedra with quadratic shapes, for the tier that does not lock");
    app.add_option("--edge", a.edge_mm, "edge of the tetrahedra instead of the recipe's, mm")
        ->check(CLI::Range(1.0, 100.0));
    app.add_option("--skin", a.skin_mm, "edge of the skin instead of the recipe's, mm")
        ->check(CLI::Range(0.5, 50.0));
    app.add_option("--time-limit", a.time_limit_s, "of each attempt of TetGen, s")
        ->check(CLI::Range(0.0, 86400.0));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? kDone : kBadInput;
    }
    try {
        run(a);
        return kDone;
    } catch (const bake::RecipeError& e) {
        fmt::print(stderr, "bake: {}\n", e.what());
        return kBadInput;
    } catch (const std::exception& e) {
        fmt::print(stderr, "bake: {}: {}\n", a.recipe, e.what());
        return kRefused;
    }
}
