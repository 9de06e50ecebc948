// The program bake import, as trocar starts it: exit codes, messages, and what it leaves behind.
#include "assets/bake/quality.h"
#include "tests/bake/import/surface_files.h"
#include "tissue/mesh/baked_organ.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace bake_tests;
namespace fs = std::filesystem;

namespace {

std::string slurp(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

struct Folder {
    fs::path path;
    Folder() {
        std::string pattern = (fs::temp_directory_path() / "import_test_XXXXXX").string();
        REQUIRE(mkdtemp(pattern.data()) != nullptr);
        path = pattern;
        fs::create_directory(path / "place"); // where --out is: nothing else may appear in it
    }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] fs::path out() const { return path / "place" / "organ"; }
    [[nodiscard]] std::size_t left() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(path / "place"), fs::directory_iterator{}));
    }
    fs::path write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path / name, std::ios::binary) << bytes;
        return path / name;
    }
};

pid_t start(const Folder& folder, std::vector<std::string> words) {
    words.insert(words.begin(), {BAKE_PROGRAM, "import"});
    const pid_t child = fork();
    if (child == 0) {
        const int out = open((folder.path / "stdout").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        const int err = open((folder.path / "stderr").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        dup2(out, STDOUT_FILENO);
        dup2(err, STDERR_FILENO);
        std::vector<char*> argv;
        for (auto& w : words) {
            argv.push_back(w.data());
        }
        argv.push_back(nullptr);
        execv(argv[0], argv.data());
        _exit(99);
    }
    return child;
}

struct Ran {
    int status = 0;
    std::string out, errors;
    [[nodiscard]] int exit_code() const { return WIFEXITED(status) ? WEXITSTATUS(status) : -1; }
};
Ran wait_for(const Folder& folder, pid_t child) {
    Ran ran;
    waitpid(child, &ran.status, 0);
    ran.out = slurp(folder.path / "stdout");
    ran.errors = slurp(folder.path / "stderr");
    return ran;
}

Ran import_file(const Folder& folder, const fs::path& file, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {file.string(), "--unit", "mm", "--material", "liver", "--out",
                               folder.out().string()});
    return wait_for(folder, start(folder, more));
}

void expect_refused(const std::string& name, const std::string& bytes, const char* reason) {
    CAPTURE(name);
    const Folder folder;
    const auto ran = import_file(folder, folder.write(name, bytes), {"--edge", "14"});
    CAPTURE(ran.errors);
    CHECK(ran.exit_code() == 2);
    CHECK(ran.errors.find(reason) != std::string::npos);
    CHECK(ran.out.empty());
    CHECK(folder.left() == 0);
}

void expect_repaired(const std::string& name, const std::string& bytes, const char* repair) {
    CAPTURE(name);
    const Folder folder;
    const auto ran = import_file(folder, folder.write(name, bytes), {"--edge", "14", "--json"});
    CAPTURE(ran.errors);
    CAPTURE(ran.out);
    REQUIRE(ran.exit_code() == 0);
    const auto j = nlohmann::json::parse(ran.out);
    CHECK((j["repairs"].dump() + j["problems"].dump()).find(repair) != std::string::npos);
    CHECK(j["worst_dihedral_deg"].get<double>() >= 8.0);
    CHECK(std::abs(j["volume_change_percent"].get<double>()) <= 1.0);
    CHECK(j["hausdorff_m"].get<double>() <= 0.5e-3 * j["edge_mm"].get<double>());
    CHECK(folder.left() == 1);
    for (const auto& file : j["files"]) {
        CHECK(fs::file_size(folder.out() / file.get<std::string>()) > 0);
    }
}

const Surface kGlobe = globe(30.0, 24, 16);

Surface without(Surface s, std::size_t first, std::size_t count) {
    const auto begin = s.triangles.begin() + static_cast<std::ptrdiff_t>(first);
    s.triangles.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
    return s;
}

Surface scaled(Surface s, double factor) {
    for (auto& p : s.point_m) {
        p *= factor;
    }
    return s;
}

} // namespace

TEST_CASE("import program: broken surfaces that can be repaired are, and it says how") {
    expect_repaired("open.stl", binary_stl(without(kGlobe, 30, 3)), "holes filled");
    auto inside_out = kGlobe;
    for (auto& t : inside_out.triangles) {
        std::swap(t[0], t[1]);
    }
    expect_repaired("flipped.obj", obj(inside_out), "1 of 1 shells faced inwards");
    auto mixed = kGlobe;
    for (std::size_t t = 0; t < mixed.triangles.size(); t += 3) {
        std::swap(mixed.triangles[t][0], mixed.triangles[t][1]);
    }
    expect_repaired("mixed.off", off(mixed), "triangles turned over");
    auto doubled = kGlobe;
    doubled.triangles.insert(doubled.triangles.end(), kGlobe.triangles.begin(),
                             kGlobe.triangles.begin() + 50);
    expect_repaired("duplicate.ply", ply(doubled, "binary_little_endian"),
                    "50 double triangles dropped");
    auto sides = both(kGlobe, inside_out);
    expect_repaired("two-sided.stl", binary_stl(sides), "there from both sides");
    expect_repaired("nested.stl", binary_stl(both(globe(40.0, 24, 16), globe(20.0, 24, 16))),
                    "taken as a cavity");
    expect_repaired(
        "touching.stl",
        binary_stl(both(brick({0, 0, 0}, {40, 30, 30}), brick({40, 0, 0}, {80, 30, 30}))),
        "bodies 1 and 2 touch at");
    expect_repaired("crossing.ply",
                    ply(both(globe(30.0, 32, 20), globe(30.0, 32, 20, {40, 0.3, 0.2})), "ascii"),
                    "bodies 1 and 2 overlap at");
}

TEST_CASE("import program: a T-junction is repaired") {
    auto s = brick({0, 0, 0}, {60, 50, 40});
    s.point_m.emplace_back(30, 0, 0);
    s.triangles[1] = {0, 3, 8};
    s.triangles.push_back({8, 3, 1});
    expect_repaired("junction.off", off(s), "T-junctions");
}

TEST_CASE("import program: broken surfaces that cannot be repaired are refused with the reason") {
    auto half = kGlobe;
    std::erase_if(half.triangles,
                  [&](const tissue::Triangle& t) { return half.point_m[t[0]].z > 0.0; });
    expect_refused("half.stl", binary_stl(half), "it is open: a hole");
    auto nan = kGlobe;
    nan.point_m[100].y = std::nan("");
    expect_refused("nan.stl", binary_stl(nan), "is nan: accepted: a finite number");
    nan.point_m[100].y = HUGE_VAL;
    expect_refused("infinity.obj", obj(nan), "a coordinate is \"inf\": accepted: a finite number");
    expect_refused("empty.stl", "", "byte 0: the file is empty");
    expect_refused("truncated.stl", binary_stl(kGlobe).substr(0, 5000), "byte 80: it counts");
    expect_refused("magic.ply", "plx" + ply(kGlobe, "ascii").substr(3),
                   "the first word is \"plx\"");
    expect_refused("one.stl", binary_stl({{{0, 0, 0}, {50, 0, 0}, {0, 50, 0}}, {{0, 1, 2}}}),
                   "it is open: a hole");
    auto flat = kGlobe;
    for (auto& p : flat.point_m) {
        p.z = 0.0;
    }
    expect_refused("flat.stl", binary_stl(flat), "accepted");
    expect_refused("metres.stl", binary_stl(scaled(kGlobe, 1e-3)),
                   "--unit m (60 mm long) would fit");
    expect_refused("moebius.stl", binary_stl(moebius_strip()), "like a Moebius strip, found at (");
    expect_refused("unknown.xyz", "0 0 0", "accepted: .stl, .obj, .ply, .off");
}

TEST_CASE("import program: what is not a readable file is refused by name") {
    const Folder folder;
    fs::create_directory(folder.path / "folder.stl");
    CHECK(import_file(folder, folder.path / "folder.stl").errors.find("is a folder") !=
          std::string::npos);
    CHECK(import_file(folder, folder.path / "none.stl").errors.find("is not there") !=
          std::string::npos);
    REQUIRE(mkfifo((folder.path / "pipe.stl").c_str(), 0600) == 0);
    CHECK(import_file(folder, folder.path / "pipe.stl").errors.find("is not a plain file") !=
          std::string::npos);
    const auto locked = folder.write("locked.stl", binary_stl(kGlobe));
    fs::permissions(locked, fs::perms::none);
    const auto ran = import_file(folder, locked);
    if (geteuid() == 0) {
        MESSAGE("skipped: root may read a file without permissions");
    } else {
        CHECK(ran.exit_code() == 2);
        CHECK(ran.errors.find("cannot be read") != std::string::npos);
    }
    const auto odd = folder.write("two\nlines.stl", "x");
    const auto refused = import_file(folder, odd);
    CHECK(refused.exit_code() == 2);
    CHECK(refused.errors.find("two?lines.stl: byte 1") != std::string::npos);
}

TEST_CASE("import program: wrong usage is refused and says what would be accepted") {
    const Folder folder;
    const auto file = folder.write("a.stl", binary_stl(kGlobe)).string();
    const auto run = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {file, "--out", folder.out().string()});
        const auto ran = wait_for(folder, start(folder, words));
        CHECK(ran.exit_code() == 2);
        CHECK(folder.left() == 0);
        return ran.errors;
    };
    CHECK(run({"--unit", "inch", "--rigid"}).find("mm,cm,m") != std::string::npos);
    CHECK(run({"--unit", "mm"}).find("--material is missing") != std::string::npos);
    CHECK(run({"--unit", "mm", "--material", "stone"}).find("accepted: bile_duct, ") !=
          std::string::npos);
    CHECK(run({"--unit", "mm", "--rigid", "--fine", "1,2,3"}).find("accepted: x,y,z,r") !=
          std::string::npos);
    CHECK(run({"--unit", "mm", "--rigid", "--picture", "/nowhere/p.png"})
              .find("--picture /nowhere") != std::string::npos);
    CHECK(run({"--unit", "mm", "--rigid", "--edge", "0"}).find("--edge") != std::string::npos);
}

TEST_CASE("import program: an earlier import is replaced, a folder of something else is not") {
    const Folder folder;
    const auto file = folder.write("a.stl", binary_stl(kGlobe));
    REQUIRE(import_file(folder, file, {"--rigid"}).exit_code() == 0);
    const auto first = slurp(folder.out() / "a.organ");
    REQUIRE(import_file(folder, file, {"--rigid", "--picture", (folder.out() / "p.png").string()})
                .exit_code() == 0);
    CHECK(fs::exists(folder.out() / "p.png"));
    REQUIRE(import_file(folder, file, {"--rigid"}).exit_code() == 0);
    CHECK_FALSE(fs::exists(folder.out() / "p.png"));
    CHECK(slurp(folder.out() / "a.organ") == first);
    std::ofstream(folder.out() / "letter.txt") << "dear";
    const auto ran = import_file(folder, file, {"--rigid"});
    CHECK(ran.exit_code() == 2);
    CHECK(ran.errors.find("letter.txt") != std::string::npos);
    CHECK(slurp(folder.out() / "letter.txt") == "dear");
    CHECK(folder.left() == 1);
}

TEST_CASE("import program: the same import twice writes the same bytes") {
    const Folder a, b;
    for (const Folder* f : {&a, &b}) {
        const auto file = f->write("a.stl", binary_stl(kGlobe));
        REQUIRE(import_file(*f, file, {"--edge", "14", "--picture", (f->path / "p.png").string()})
                    .exit_code() == 0);
    }
    for (const char* name : {"a.organ", "a.quadratic.organ", "report.json", "report.txt"}) {
        CAPTURE(name);
        CHECK(slurp(a.out() / name) == slurp(b.out() / name));
    }
    CHECK(slurp(a.path / "p.png") == slurp(b.path / "p.png"));
    CHECK(slurp(a.path / "p.png").substr(1, 3) == "PNG");
}

TEST_CASE("import program: a signal at any moment leaves nothing behind") {
    const Folder folder;
    const auto file = folder.write("a.stl", binary_stl(globe(60.0, 200, 120)));
    for (const int wait_ms : {20, 300, 900, 1800}) {
        CAPTURE(wait_ms);
        const pid_t child = start(folder, {file.string(), "--unit", "mm", "--material", "liver",
                                           "--edge", "5", "--out", folder.out().string()});
        std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms));
        kill(child, wait_ms == 300 ? SIGTERM : SIGINT);
        const auto ran = wait_for(folder, child);
        CHECK(WIFSIGNALED(ran.status));
        CHECK(folder.left() == 0);
    }
}

TEST_CASE("import program: the seven OpenHELP organs become good tissue" *
          doctest::test_suite("slow")) {
    const fs::path folder = fs::path(ORGAN_RECIPES) / "../../../shared/data/openhelp";
    if (!fs::is_directory(folder)) {
        MESSAGE("skipped: ../shared/data/openhelp is not there");
        return;
    }
    for (const char* name :
         {"kidney_left", "spleen", "pancreas", "stomach", "duodenum", "liver", "abdominal_wall"}) {
        CAPTURE(name);
        const Folder place;
        const auto ran = import_file(place, folder / (std::string(name) + ".stl"), {"--json"});
        CAPTURE(ran.errors);
        REQUIRE(ran.exit_code() == 0);
        const auto j = nlohmann::json::parse(ran.out);
        CHECK(j["worst_dihedral_deg"].get<double>() >= 8.0);
        CHECK(std::abs(j["volume_change_percent"].get<double>()) <= 1.0);
        for (const auto& body : j["body"]) { // of the edge aimed at, and of the edge that came out
            const double away_mm = 1e3 * body["boundary_hausdorff_m"].get<double>();
            CHECK(away_mm <= 0.5 * body["edge_mm"].get<double>());
            CHECK(away_mm <= 0.5 * body["mean_edge_mm"].get<double>());
        }
    }
}
