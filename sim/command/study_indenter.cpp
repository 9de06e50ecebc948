// sim/command/study_indenter.cpp
// trocar study indenter: a round tip pressed deep into a half-space at finite strain; the lines of
// tissue/response/finite_sphere_table.h. 20 s of one core for each Poisson's ratio.
#include "sim/command/commands.h"
#include "sim/io/files.h"
#include "tissue/reference/half_space_press.h"
#include "tissue/response/finite_sphere_table.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sim {
namespace {

struct IndenterArguments {
    std::vector<double> poisson{tissue::kFinitePoisson.begin(), tissue::kFinitePoisson.end()};
    std::vector<double> depth{tissue::kFiniteDepth.begin(), tissue::kFiniteDepth.end()};
    tissue::HalfSpacePress press{.friction = std::numeric_limits<double>::infinity(),
                                 .depth = {},
                                 .cell = 0.1,
                                 .penalty = 300.0};
    std::string out;
};

void press_all(IndenterArguments& a) {
    std::string csv = "poisson,friction,thickness,depth,force,contact_radius,penetration,"
                      "least_det_f\n";
    a.press.depth = a.depth;
    for (const double nu : a.poisson) {
        a.press.poisson = nu;
        const tissue::HalfSpaceReport report = tissue::press_half_space(a.press);
        std::vector<std::string> force;
        for (const tissue::HalfSpacePoint& p : report.point) {
            csv += fmt::format("{:g},{:g},{:g},{:g},{:.6f},{:.4f},{:.5f},{:.3f}\n", nu,
                               a.press.friction, a.press.thickness, p.depth, p.force,
                               p.contact_radius, p.penetration, p.min_det_f);
            force.push_back(fmt::format("{:.5f}", p.force));
        }
        fmt::print("nu {:g}: {}\n", nu, fmt::join(force, ", "));
        if (report.point.size() < a.depth.size())
            fmt::print("nu {:g}: no equilibrium beyond {:.2f} tip radii\n", nu, report.reached);
    }
    if (!a.out.empty())
        write_text(std::filesystem::path(a.out) / "indenter.csv", csv);
}

} // namespace

void add_study_indenter(CLI::App& study) {
    auto a = std::make_shared<IndenterArguments>();
    CLI::App* c = study.add_subcommand(
        "indenter", "A round tip deep in a half-space at finite strain: F/(E a^2) at depths d/a");
    c->add_option("--poisson", a->poisson, "Poisson's ratios");
    c->add_option("--depths", a->depth, "In tip radii, ascending");
    c->add_option("--friction", a->press.friction, "Coulomb coefficient; inf: stuck");
    c->add_option("--thickness", a->press.thickness, "Of a bonded layer, tip radii; 0: half-space");
    c->add_option("--cell", a->press.cell, "Of the mesh under the tip, tip radii");
    c->add_option("--step", a->press.step, "Greatest step of depth, tip radii");
    c->add_option("--penalty", a->press.penalty, "Of contact, times E / radius");
    c->add_option("--out", a->out, "Folder for indenter.csv");
    c->callback([a] {
        if (!a->out.empty())
            std::filesystem::create_directories(a->out);
        press_all(*a);
    });
}

} // namespace sim
