#include "assets/bake/import/import_main.h"

#include "assets/bake/child.h"
#include "assets/bake/import/import.h"
#include "assets/bake/import/picture.h"
#include "assets/bake/import/staging.h"
#include "assets/bake/quadratic.h"

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace bake {
namespace {

namespace fs = std::filesystem;

enum ExitCode { kDone = 0, kBadInput = 2 };
constexpr double kLongest_s = 1800.0;                  // of a whole import
constexpr std::uintmax_t kLargestFile = 3'000'000'000; // bytes

volatile std::sig_atomic_t signal_came = 0;

void note_signal(int number) {
    signal_came = number;
}

struct Arguments {
    std::string surface, unit, material, out, picture;
    std::vector<std::string> fine;
    double edge_mm = 0.0, time_limit_s = 60.0;
    bool rigid = false, largest = false, json = false;
};

fs::path materials_file() {
    const char* assets = std::getenv("TROCAR_ASSETS");
    return fs::path(assets != nullptr && *assets != '\0' ? assets : TROCAR_ASSETS) / "organs" /
           "materials.toml";
}

std::vector<std::byte> read_bytes(const fs::path& file) {
    std::error_code error;
    const auto status = fs::status(file, error);
    if (error || !fs::is_regular_file(status)) {
        throw PathError(fmt::format("{}: {}: accepted: a file", shown_path(file),
                                    !fs::exists(status)        ? "is not there"
                                    : fs::is_directory(status) ? "is a folder"
                                                               : "is not a plain file"));
    }
    const auto size = fs::file_size(file, error);
    if (error || size > kLargestFile) {
        throw PathError(fmt::format("{}: has {} bytes: accepted: up to {}", shown_path(file), size,
                                    kLargestFile));
    }
    std::ifstream in(file, std::ios::binary);
    std::vector<std::byte> bytes(size);
    if (!in ||
        !in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) {
        throw PathError(
            fmt::format("{}: cannot be read: {}", shown_path(file), std::strerror(errno)));
    }
    return bytes;
}

/// "x,y,z,r" in millimetres.
FineSpot parse_fine(const std::string& text) {
    std::vector<double> n;
    std::size_t at = 0;
    while (at <= text.size()) {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        char* end = nullptr;
        const std::string word = text.substr(at, comma - at);
        n.push_back(std::strtod(word.c_str(), &end));
        if (word.empty() || *end != '\0' || !std::isfinite(n.back())) {
            n.clear();
            break;
        }
        at = comma + 1;
    }
    if (n.size() != 4 || n[3] <= 0.0) {
        throw PathError(fmt::format("--fine {}: accepted: x,y,z,r in millimetres, r above 0",
                                    shown_path(text)));
    }
    return {.centre_mm = {n[0], n[1], n[2]}, .radius_mm = n[3]};
}

ImportOptions make_options(const Arguments& a) {
    ImportOptions o;
    o.file_name = fs::path(a.surface).filename().string();
    o.unit = a.unit == "mm" ? Unit{"mm", 1e-3} : a.unit == "cm" ? Unit{"cm", 1e-2} : Unit{"m", 1.0};
    o.rigid = a.rigid;
    o.largest = a.largest;
    o.edge_mm = a.edge_mm;
    o.time_limit_s = a.time_limit_s;
    for (const auto& text : a.fine) {
        o.fine.push_back(parse_fine(text));
    }
    if (!a.rigid) {
        const fs::path file = materials_file();
        const auto bytes = read_bytes(file);
        o.material = find_material({reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                                   file.filename().string(), a.material);
    }
    o.tell = [](const std::string& line) { fmt::print(stderr, "import: {}\n", line); };
    return o;
}

void write_organ(const fs::path& folder, const tissue::BakedOrgan& organ, const char* ending) {
    const auto bytes = tissue::write_organ(organ);
    write_whole(folder / (organ.name + ending),
                {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// In the child: reads, computes, writes into the staged folder; returns what to print.
std::vector<std::byte> work(const Arguments& a, const ImportOptions& options,
                            const fs::path& folder) {
    const auto memory =
        static_cast<rlim_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
    const rlimit most{memory / 10 * 9, memory / 10 * 9};
    setrlimit(RLIMIT_AS, &most); // too much is an exception here, and the machine lives on
    const fs::path file(a.surface);
    const auto bytes = read_bytes(file);
    std::string text;
    try {
        const Imported imported = import_surface(bytes, options);
        for (const auto& body : imported.bodies) {
            write_organ(folder, body.organ, ".organ");
            if (body.quadratic) {
                write_organ(folder, body.quadratic->organ, kQuadraticEnding);
            }
        }
        write_whole(folder / "report.json", import_json(imported, options, false));
        write_whole(folder / "report.txt", import_text(imported, options));
        if (!a.picture.empty()) {
            write_whole(folder / "picture.png", picture_png(imported));
        }
        text = a.json
                   ? import_json(imported, options, true)
                   : import_text(imported, options) + fmt::format("{:.1f} s\n", imported.seconds);
    } catch (const PathError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw PathError(fmt::format("{}: needs more memory than there is", shown_path(file)));
    } catch (const std::exception& e) {
        throw PathError(fmt::format("{}: {}", shown_path(file), e.what()));
    }
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    return {first, first + text.size()};
}

/// A picture may be asked for in the folder of the organ itself, which is not there yet.
bool in_out(const fs::path& picture, const fs::path& out) {
    const auto plain = [](const fs::path& p) {
        const fs::path whole = fs::absolute(p).lexically_normal();
        return whole.has_filename() ? whole : whole.parent_path();
    };
    return plain(picture).parent_path() == plain(out);
}

void require_picture_place(const Arguments& a) {
    if (a.picture.empty()) {
        return;
    }
    const fs::path folder = fs::absolute(a.picture).parent_path();
    if (!in_out(a.picture, a.out) && !fs::is_directory(folder)) {
        throw PathError(
            fmt::format("--picture {}: {} is not a folder: accepted: a file in a folder "
                        "that is there, or in --out",
                        shown_path(a.picture), shown_path(folder)));
    }
    if (fs::path(a.picture).extension() != ".png") {
        throw PathError(
            fmt::format("--picture {}: accepted: a name that ends in .png", shown_path(a.picture)));
    }
}

/// The picture goes where it was asked for, whole.
void move_picture(const fs::path& from, const fs::path& to) {
    const fs::path part = to.string() + ".part";
    std::error_code error;
    fs::copy_file(from, part, fs::copy_options::overwrite_existing, error);
    if (!error) {
        fs::rename(part, to, error);
    }
    if (error) {
        std::error_code ignored;
        fs::remove(part, ignored);
        throw PathError(
            fmt::format("--picture {}: cannot be written: {}", shown_path(to), error.message()));
    }
    if (from != to) {
        fs::remove(from, error);
    }
}

void run(const Arguments& a) {
    const ImportOptions options = make_options(a);
    require_picture_place(a);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) { // before anything is made
        struct sigaction action {};
        action.sa_handler = note_signal;
        sigaction(number, &action, nullptr);
    }
    Staging staging(a.out);
    const ChildAnswer answer = run_in_child(
        [&] {
            for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
                std::signal(number, SIG_DFL);
            }
            return work(a, options, staging.folder());
        },
        kLongest_s, &signal_came);
    if (signal_came != 0) {
        throw PathError("interrupted, nothing was written");
    }
    if (!answer.done) {
        throw PathError(answer.crashed ? fmt::format("{}: {}", shown_path(a.surface), answer.reason)
                                       : answer.reason);
    }
    if (!a.picture.empty()) {
        const fs::path picture = fs::path(a.picture).filename();
        move_picture(staging.folder() / "picture.png",
                     in_out(a.picture, a.out) ? staging.folder() / picture : fs::path(a.picture));
    }
    staging.put_in_place();
    fmt::print("{}", std::string_view(reinterpret_cast<const char*>(answer.bytes.data()),
                                      answer.bytes.size()));
}

void declare(CLI::App& app, Arguments& a) {
    app.add_option("surface", a.surface, "STL, OBJ, PLY or OFF file")->required();
    app.add_option("--unit", a.unit, "Of the file's numbers: mm, cm or m")
        ->required()
        ->check(CLI::IsMember({"mm", "cm", "m"}));
    app.add_option("--material", a.material, "Tissue, by its name in organs/materials.toml");
    app.add_flag("--rigid", a.rigid, "Scenery: no tetrahedra, no material");
    app.add_option("--edge", a.edge_mm,
                   "Edge of the tetrahedra, mm; default: from volume and area, for about 500 nodes")
        ->check(CLI::Range(0.5, 100.0));
    app.add_option("--fine", a.fine, "x,y,z,r in mm: finer within r of a place; may be repeated")
        ->allow_extra_args(false);
    app.add_flag("--largest", a.largest, "Only the largest body of several");
    app.add_option("--picture", a.picture, "Draw surface, tetrahedra and anchors")
        ->type_name("FILE.png");
    app.add_option("--time-limit", a.time_limit_s, "Of each attempt of TetGen, s")
        ->check(CLI::Range(0.1, 3600.0));
    app.add_flag("--json", a.json, "One JSON object instead of text");
    app.add_option("--out", a.out, "Folder to write")->required()->type_name("DIR");
}

} // namespace

int import_main(int argc, char** argv) {
    Arguments a;
    CLI::App app{"A surface file to organs: checked, repaired, filled with tetrahedra, or refused "
                 "with the reason.\nExit 0: done; 2: bad usage, bad file or refused.",
                 "trocar import"};
    declare(app, a);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? kDone : kBadInput;
    }
    try {
        if (!a.rigid && a.material.empty()) {
            throw PathError("--material is missing: accepted: a name of organs/materials.toml, or "
                            "--rigid");
        }
        run(a);
        return kDone;
    } catch (const std::exception& e) {
        fmt::print(stderr, "import: {}\n", e.what());
    }
    if (signal_came != 0) { // end the way the sender expects
        std::signal(signal_came, SIG_DFL);
        std::raise(signal_came);
    }
    return kBadInput;
}

} // namespace bake
