// tests/tissue/calculix.cpp
#include "tests/tissue/calculix.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <sstream>
#include <stdexcept>
#include <unistd.h>

namespace calculix {
namespace {

namespace fs = std::filesystem;
using glm::dvec3;

// A directory of this run alone, gone afterwards.
struct TemporaryDirectory {
    fs::path path;
    TemporaryDirectory() {
        std::string name = (fs::temp_directory_path() / "trocar-calculix-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr)
            throw std::runtime_error("no directory " + name);
        path = name;
    }
    TemporaryDirectory(const TemporaryDirectory&) = delete;
    TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
    ~TemporaryDirectory() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
};

// ccx takes residuals below 1e-6 in the units of its input as zero, whatever the tolerance. So its
// input is in mm, g, s: stress in Pa, force in uN.
constexpr double kMillimetres = 1e3, kMicronewtons = 1e6, kGramsPerCubicMillimetre = 1e-6;

// ccx reads 20 characters of a number.
std::string number(double x) {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.12e", x);
    return text.data();
}

void write_mesh(std::ofstream& out, const tissue::QuadraticMesh& mesh) {
    out << "*NODE, NSET=NALL\n";
    for (std::size_t i = 0; i < mesh.rest_m.size(); ++i) {
        const dvec3 x = kMillimetres * mesh.rest_m[i];
        out << i + 1 << ", " << number(x.x) << ", " << number(x.y) << ", " << number(x.z) << '\n';
    }
    out << "*ELEMENT, TYPE=C3D10, ELSET=EALL\n";
    for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
        out << i + 1;
        for (const std::uint32_t node : mesh.tets[i])
            out << ", " << node + 1;
        out << '\n';
    }
}

// The load goes on in increments that ccx chooses. Its default tolerance is half a per cent of the
// mean force: tightened to 1e-8, forces and corrections alike.
void write_step(std::ofstream& out, const Problem& p) {
    out << "*STEP, NLGEOM, INC=1000\n";
    if (p.steps > 0) {
        out << "*DYNAMIC, DIRECT, ALPHA=0\n"
            << number(p.dt_s) << ", " << number(p.steps * p.dt_s) << '\n';
    } else {
        out << "*STATIC\n0.1, 1.0, 1e-4, 0.25\n";
    }
    out << "*CONTROLS, PARAMETERS=FIELD\n1e-8, 1e-8\n";
    out << "*BOUNDARY\n";
    for (std::size_t i = 0; i < p.held.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            if ((p.held[i] >> k & 1) == 0)
                continue;
            const double way_m = p.held_m.empty() ? 0.0 : p.held_m[i][k] - p.mesh.rest_m[i][k];
            out << i + 1 << ", " << k + 1 << ", " << k + 1 << ", " << number(kMillimetres * way_m)
                << '\n';
        }
    }
    const double g = glm::length(p.gravity_mps2);
    if (g > 0.0) {
        const dvec3 n = p.gravity_mps2 / g;
        out << "*DLOAD\nEALL, GRAV, " << number(kMillimetres * g) << ", " << number(n.x) << ", "
            << number(n.y) << ", " << number(n.z) << '\n';
    }
    out << "*NODE PRINT, NSET=NALL, FREQUENCY=1000\nU, RF\n*END STEP\n";
}

// The last table with `title` in its head line: node, x, y, z in each line.
std::vector<dvec3> last_table(const fs::path& file, const std::string& title, double unit,
                              std::size_t nodes) {
    std::ifstream in(file);
    std::vector<dvec3> table;
    bool inside = false;
    for (std::string line; std::getline(in, line);) {
        std::size_t node = 0;
        dvec3 v{0.0};
        std::istringstream words(line);
        if (line.find(title) != std::string::npos) {
            inside = true;
            table.assign(nodes, dvec3{0.0});
        } else if (words >> node >> v.x >> v.y >> v.z) {
            if (inside && node >= 1 && node <= nodes)
                table[node - 1] = v / unit;
        } else if (!line.empty()) {
            inside = false; // another title
        }
    }
    return table;
}

std::string tail_of(const fs::path& file) {
    std::ifstream in(file);
    std::ostringstream all;
    all << in.rdbuf();
    const std::string text = all.str();
    return text.substr(text.size() > 1500 ? text.size() - 1500 : 0);
}

} // namespace

std::string program() {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const std::string candidate = folder + "/ccx";
        if (access(candidate.c_str(), X_OK) == 0)
            return candidate;
    }
    return {};
}

Answer solve(const Problem& problem) {
    const TemporaryDirectory folder;
    {
        std::ofstream out(folder.path / "job.inp");
        write_mesh(out, problem.mesh);
        out << "*MATERIAL, NAME=TISSUE\n*HYPERELASTIC, NEO HOOKE\n"
            << number(problem.c10_pa) << ", " << number(problem.d1_1pa) << "\n*DENSITY\n"
            << number(kGramsPerCubicMillimetre * problem.density_kgpm3)
            << "\n*SOLID SECTION, ELSET=EALL, MATERIAL=TISSUE\n";
        write_step(out, problem);
    }
    const auto begin = std::chrono::steady_clock::now();
    const int status = std::system(
        ("cd '" + folder.path.string() + "' && OMP_NUM_THREADS=1 '" + program() + "' job >log 2>&1")
            .c_str());
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    const std::size_t nodes = problem.mesh.rest_m.size();
    // the titles carry the time: the end of the step is 1
    Answer answer{last_table(folder.path / "job.dat", "displacements", kMillimetres, nodes),
                  last_table(folder.path / "job.dat", "forces", kMicronewtons, nodes),
                  took.count()};
    if (status != 0 || answer.moved_m.empty() || answer.internal_n.empty()) {
        throw std::runtime_error("ccx ended with " + std::to_string(status) + ":\n" +
                                 tail_of(folder.path / "log"));
    }
    return answer;
}

} // namespace calculix
