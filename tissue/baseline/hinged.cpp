#include "tissue/baseline/hinged.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>

namespace tissue {
namespace {

using glm::dvec3;

constexpr double kCarried = 1e-6; // of a hinge's mass, at the nodes that only carry

Material tensile(double young_pa) {
    return {.young_pa = young_pa,
            .poisson = 0.0,
            .damping_mass_1ps = 0.0,
            .damping_stiffness_s = 0.0,
            .source = "design value"};
}

void weigh(CorotatedModel& model, double hinge_kg) {
    for (std::size_t i = 0; i < model.mass_kg.size(); ++i)
        model.mass_kg[i] = i % 3 == 0 ? hinge_kg : kCarried * hinge_kg;
}

} // namespace

TetMesh hinged_links(int links, double link_m, double offset_m) {
    TetMesh mesh;
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(links); ++k) {
        mesh.rest_m.push_back({k * link_m, 0, 0});
        mesh.rest_m.push_back({(k + 0.5) * link_m, offset_m, 0});
        mesh.rest_m.push_back({(k + 0.5) * link_m, 0, offset_m});
        mesh.tets.push_back({3 * k, 3 * k + 3, 3 * k + 1, 3 * k + 2});
    }
    mesh.rest_m.push_back({links * link_m, 0, 0});
    return mesh;
}

double sag_m(std::span<const dvec3> position_m) {
    double largest = 0.0;
    for (std::size_t i = 0; i < position_m.size(); i += 3) {
        const double aside = std::hypot(position_m[i].y, position_m[i].z);
        if (std::isnan(aside))
            return aside;
        largest = std::max(largest, aside);
    }
    return largest;
}

double critical_step_s(const TautString& s) {
    const double n = s.free_nodes;
    const double w_radps = 2.0 * std::sqrt(s.tension_n / (s.mass_kg * s.spacing_m)) *
                           std::sin(glm::pi<double>() * n / (2.0 * (n + 1.0)));
    return 2.0 / w_radps;
}

double rest_length_m(const TautString& s) {
    // f = V sigma/l at rest = offset^2 E strain/6
    return s.spacing_m / (1.0 + 6.0 * s.tension_n / (s.offset_m * s.offset_m * s.young_pa));
}

HingedRow taut_string(const TautString& s, double kick_m, std::uint64_t seed) {
    const double rest_m = rest_length_m(s);
    const TetMesh mesh = hinged_links(s.free_nodes + 1, rest_m, s.offset_m);
    std::vector<std::uint8_t> held(mesh.rest_m.size(), 0);
    held.front() = held.back() = 1;
    HingedRow row{make_corotated(mesh, tensile(s.young_pa), held), {}};
    weigh(row.model, s.mass_kg);
    row.state = rest_state(row.model);
    std::vector<dvec3>& x = row.state.position_m;
    std::mt19937_64 random(seed);
    for (std::size_t i = 0; i < x.size(); ++i) {
        x[i].x *= s.spacing_m / rest_m;
        if (i % 3 == 0 && held[i] == 0)
            x[i].y = kick_m * (static_cast<double>(random() >> 11) * 0x1p-52 - 1.0);
    }
    for (std::size_t i = 0; i + 3 < x.size(); i += 3) {
        const double middle_m = 0.5 * (x[i].y + x[i + 3].y);
        const double turn = (x[i + 3].y - x[i].y) / s.spacing_m;
        x[i + 1] += dvec3{-turn * s.offset_m, middle_m, 0};
        x[i + 2].y += middle_m;
    }
    return row;
}

double hanging_stretch_m(const HangingChain& c) {
    return c.compliance_mpn * c.mass_kg * c.gravity_mps2 * 0.5 * c.links * (c.links + 1);
}

double young_pa(const HangingChain& c) {
    return 6.0 * c.link_m / (c.compliance_mpn * c.offset_m * c.offset_m);
}

HingedRow hanging_chain(const HangingChain& c) {
    const TetMesh mesh = hinged_links(c.links, c.link_m, c.offset_m);
    std::vector<std::uint8_t> held(mesh.rest_m.size(), 0);
    held.front() = 1;
    HingedRow row{make_corotated(mesh, tensile(young_pa(c)), held, {c.gravity_mps2, 0, 0}), {}};
    weigh(row.model, c.mass_kg);
    row.state = rest_state(row.model);
    return row;
}

} // namespace tissue
