// tests/sim/imported_meshes_test.cpp
// Of an imported organ what is felt belongs to the tissue, not to the mesh: one body in the usual
// mesh and in a finer one, thick and slender parts.
#include "tests/sim/command_fixture.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <glm/vec3.hpp>
#include <numbers>
#include <unistd.h>

using namespace command_tests;

namespace fs = std::filesystem;

namespace {

constexpr double kLength_mm = 92.0;

// A body of 56 x 45 mm that runs out in tails of 5 mm radius, nowhere creased.
double radius_mm(double z) {
    const double from_middle = 2.0 * z / kLength_mm - 1.0;
    return (5.0 + 24.5 * std::exp(-std::pow((z - 40.0) / 18.0, 2))) *
           std::sqrt(1.0 - std::pow(from_middle, 20));
}

void write_pear(const fs::path& file) {
    constexpr int kAround = 48, kAlong = 90;
    const auto at = [](int i, int j) {
        const double z = 0.5 * kLength_mm * (1.0 - std::cos(std::numbers::pi * i / kAlong));
        const double angle = 2.0 * std::numbers::pi * (j % kAround) / kAround;
        const double r = i == 0 || i == kAlong ? 0.0 : radius_mm(z);
        return glm::dvec3(r * std::cos(angle), 0.8 * r * std::sin(angle), z);
    };
    std::ofstream out(file);
    const auto facet = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        out << "facet normal 0 0 0\nouter loop\n";
        for (const glm::dvec3& p : {a, b, c})
            out << fmt::format("vertex {:.6f} {:.6f} {:.6f}\n", p.x, p.y, p.z);
        out << "endloop\nendfacet\n";
    };
    out << "solid pear\n";
    for (int i = 0; i < kAlong; ++i) {
        for (int j = 0; j < kAround; ++j) {
            if (i > 0)
                facet(at(i, j), at(i, j + 1), at(i + 1, j + 1));
            if (i + 1 < kAlong)
                facet(at(i, j), at(i + 1, j + 1), at(i + 1, j));
        }
    }
    out << "endsolid pear\n";
}

} // namespace

TEST_CASE("imported meshes: the usual mesh and a fine one answer within 10 % at every place") {
    const fs::path folder = fs::temp_directory_path() / ("trocar_pear_" + std::to_string(getpid()));
    fs::create_directories(folder);
    write_pear(folder / "pear.stl");
    const auto import = [&](const std::string& name, const std::string& edge) {
        const Answer made =
            trocar("import '" + (folder / "pear.stl").string() +
                   "' --unit mm --material liver --out '" + (folder / name).string() + "' " + edge);
        CAPTURE(made.text);
        REQUIRE(made.exit_code == 0);
        return "'" + (folder / name / "pear.organ").string() + "'";
    };
    const std::string usual = import("usual", ""), fine = import("fine", "--edge 6");
    const auto study =
        json_of("study organ " + usual + " --against " + fine +
                " --points 200 --hold-toward 0 0 -1 --out '" + (folder / "out").string() + "'");
    CHECK(study["other"]["nodes"].get<double>() > 1.3 * study["nodes"].get<double>());
    CHECK(study["other"]["force_ratio"]["min"].get<double>() > 0.90);
    CHECK(study["other"]["force_ratio"]["max"].get<double>() < 1.10);
    fs::remove_all(folder);
}
