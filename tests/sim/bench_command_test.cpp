// What `trocar bench contact` prints, and what it says to bad input.
#include "tests/sim/command_fixture.h"

#include <filesystem>
#include <fstream>
#include <unistd.h>

using namespace command_tests;

namespace {

struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("trocar_bench_test_" + std::to_string(getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
    std::string file(const std::string& name, const std::string& text) const {
        std::ofstream(path / name) << text;
        return (path / name).string();
    }
};

// a cube of 10 cm around the origin, in OFF, wound outward
constexpr const char* kCube = "OFF\n8 12 0\n"
                              "-5 -5 -5\n5 -5 -5\n5 5 -5\n-5 5 -5\n-5 -5 5\n5 -5 5\n5 5 5\n-5 5 5\n"
                              "3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n"
                              "3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";

void refused(const std::string& arguments, const std::string& says) {
    const Answer answer = trocar("bench contact " + arguments);
    CAPTURE(arguments);
    CAPTURE(answer.text);
    CHECK(answer.exit_code == 2);
    CHECK(answer.text.find(says) != std::string::npos);
}

} // namespace

TEST_CASE("bench contact: the object has every key that others rely on") {
    const auto j = json_of("bench contact organ:1k --method brute-force --contact penalty "
                           "--probe-radius 0.002 --seconds 1 --cold --cold-every 100 --json");
    CHECK(j["method"] == "brute-force");
    CHECK(j["contact_method"] == "penalty");
    CHECK(j["triangles"] == 980);
    for (const char* part : {"contact", "free", "cold"}) {
        CAPTURE(part);
        CHECK(j[part]["n"] > 0);
        for (const char* key : {"mean_ns", "p50_ns", "p99_ns", "p9999_ns", "max_ns"})
            CHECK(j[part][key] > 0.0);
        CHECK(j[part]["p50_ns"] <= j[part]["p99_ns"]);
        CHECK(j[part]["p9999_ns"] <= j[part]["max_ns"]);
    }
    for (const char* key : {"build_ms", "refit_ms", "max_force_step_n"})
        CHECK(j[key].is_number_float());
    for (const char* key : {"lost", "stuck", "wrong_side", "sunk", "bad"})
        CHECK(j[key].is_number_integer());
}

TEST_CASE("bench contact: a mesh file under a recorded path: the force is k times the depth") {
    const Folder folder;
    const std::string mesh = folder.file("cube.off", kCube);
    // a ball of 2 mm comes down on the cube's upper face (z = 50 mm), 3 mm deep
    const std::string path = folder.file("path.csv", "name,t,x,y,z\n"
                                                     "a,0.0,0.01,0,0.060\n"
                                                     "b,0.1,0.01,0,0.049\n"
                                                     "c,0.2,0.01,0,0.049\n");
    const std::string forces = (folder.path / "forces.csv").string();
    for (const char* contact : {"none", "penalty", "virtual-proxy"}) {
        CAPTURE(contact);
        const auto j = json_of("bench contact '" + mesh + "' --unit cm --trajectory '" + path +
                               "' --contact " + contact +
                               " --probe-radius 0.002 --json --forces '" + forces + "'");
        CHECK(j["triangles"] == 12);
        CHECK(j["ticks"] == 201);
        CHECK(j["contact_ticks"] == 128); // 8 of the 11 mm of the descent, at 0.11 mm per ms
        CHECK(j["bad"] == 0);
        CHECK(j["max_force_n"].get<double>() == doctest::Approx(500.0 * 0.003).scale(0.0));
        std::ifstream in(forces);
        std::string line, last;
        int rows = -1;
        for (; std::getline(in, line); ++rows)
            last = line;
        CHECK(rows == 201);
        CHECK(last.starts_with("0.200,0.01,0,0.049,"));
        CHECK(std::stod(last.substr(last.rfind(',') + 1)) == doctest::Approx(1.5).scale(0.0));
    }
}

TEST_CASE("bench contact: bad input ends with 2 and says what would be accepted") {
    const Folder folder;
    const std::string mesh = folder.file("cube.off", kCube);
    refused("organ:1q", "organ:10k");
    refused("organ:1k --method magic", "brute-force");
    refused("organ:1k --contact magic", "virtual-proxy");
    refused("organ:1k --wave round", "travelling");
    refused("organ:1k --probe-radius -1", "--probe-radius -1: accepted: metres");
    refused("organ:1k --probe-radius 2", "--probe-radius 2: accepted: metres");
    refused("'" + mesh + "'", "--trajectory");
    const std::string path = folder.file("path.csv", "t,x,y,z\n0,1,2,3\n0.1,1,,3\n");
    refused("'" + mesh + "' --trajectory '" + path + "'", "path.csv: line 3: y is \"\"");
    const std::string good = folder.file("good.csv", "t,x,y,z\n0,0,0,1\n");
    refused("'" + mesh + "' --unit inch --trajectory '" + good + "'", "mm, cm, m");
    refused("'" + mesh + "' --breathe 2 --trajectory '" + good + "'", "--breathe");
    const std::string broken = folder.file("broken.off", "OFF\n3 1 0\n0 0 0\n1 0 x\n");
    refused("'" + broken + "' --trajectory '" + good + "'", "broken.off: line 4");
    refused("nowhere.off --trajectory '" + good + "'", "nowhere.off");
}
