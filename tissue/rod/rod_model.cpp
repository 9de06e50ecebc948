// Setup of a rod: lengths, masses, what is held. See rod.h.
#include "tissue/rod/rod.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dvec3;

void check_section(const RodSection& s, std::size_t edge) {
    if (!(s.stretch_n > 0.0 && s.bend_nm2 > 0.0 && s.twist_nm2 > 0.0 && s.mass_kgpm > 0.0 &&
          s.inertia_kgm > 0.0))
        throw std::invalid_argument("section of edge " + std::to_string(edge) +
                                    ": stiffness and mass must be greater than 0");
}

void check(std::span<const dvec3> node_m, std::span<const RodSection> section,
           std::span<const std::uint8_t> held) {
    if (node_m.size() < 2)
        throw std::invalid_argument(std::to_string(node_m.size()) + " nodes: a rod needs 2");
    const std::size_t edges = node_m.size() - 1;
    if (section.size() != 1 && section.size() != edges)
        throw std::invalid_argument(std::to_string(section.size()) + " sections: accepted: 1 or " +
                                    std::to_string(edges));
    if (!held.empty() && held.size() != node_m.size())
        throw std::invalid_argument(std::to_string(held.size()) + " held flags for " +
                                    std::to_string(node_m.size()) + " nodes");
    for (std::size_t e = 0; e < section.size(); ++e)
        check_section(section[e], e);
    for (std::size_t i = 0; i < node_m.size(); ++i) {
        if (!std::isfinite(glm::dot(node_m[i], node_m[i])))
            throw std::invalid_argument("node " + std::to_string(i) + ": not finite");
        if (i > 0 && !(glm::distance(node_m[i - 1], node_m[i]) > 0.0))
            throw std::invalid_argument("nodes " + std::to_string(i - 1) + " and " +
                                        std::to_string(i) + " are at one place");
    }
}

// Frames that turn as little as possible along the line.
void add_frames(RodModel& model) {
    const std::size_t edges = model.rest_m.size() - 1;
    model.rest_strain.assign(edges + 1, BendStrain{});
    for (std::size_t e = 0; e < edges; ++e) {
        const dvec3 along = model.rest_m[e + 1] - model.rest_m[e];
        model.length_m.push_back(glm::length(along));
        const dvec3 t = along / model.length_m.back();
        if (e == 0) {
            const dvec3 other = std::abs(t.z) < 0.8 ? dvec3{0, 0, 1} : dvec3{1, 0, 0};
            model.rest_frame.push_back({t, glm::normalize(glm::cross(other, t))});
            continue;
        }
        if (glm::dot(model.rest_frame[e - 1].tangent, t) < -0.866)
            throw std::invalid_argument("node " + std::to_string(e) +
                                        ": the line folds by more than 150 degrees");
        model.rest_frame.push_back(
            moved({model.rest_frame[e - 1].tangent, model.rest_frame[e - 1].across}, t, 0.0));
        model.rest_strain[e] = bend_strain(model.rest_frame[e - 1], model.rest_frame[e]);
    }
}

// Masses of nodes and edges, and how much of the rod bends at each node.
void add_masses(std::span<const std::uint8_t> held, RodModel& model) {
    const std::size_t nodes = model.rest_m.size(), edges = nodes - 1;
    model.bend_length_m.assign(nodes, 0.0);
    model.mass_kg.assign(nodes, 0.0);
    for (std::size_t e = 0; e < edges; ++e) {
        const double half_m = 0.5 * model.length_m[e];
        const bool stiff = held[e] != 0 && held[e + 1] != 0;
        for (const std::size_t i : {e, e + 1}) {
            model.mass_kg[i] += half_m * model.section[e].mass_kgpm;
            if (!stiff && i > 0 && i < edges)
                model.bend_length_m[i] += half_m;
        }
        model.inertia_kgm2.push_back(model.length_m[e] * model.section[e].inertia_kgm);
    }
}

void number_unknowns(std::span<const std::uint8_t> held, const dvec3& gravity_mps2,
                     RodModel& model) {
    const std::size_t edges = model.length_m.size();
    for (std::size_t i = 0; i <= edges; ++i) {
        model.dof.push_back(held[i] != 0 ? -1 : model.unknowns);
        for (int k = 0; k < 3 && held[i] == 0; ++k, ++model.unknowns) {
            model.mass.push_back(model.mass_kg[i]);
            model.weight_n.push_back(model.mass_kg[i] * gravity_mps2[k]);
        }
        if (i == edges)
            break;
        const bool stiff = held[i] != 0 && held[i + 1] != 0;
        model.spin.push_back(stiff ? -1 : model.unknowns++);
        if (!stiff) {
            model.mass.push_back(model.inertia_kgm2[i]);
            model.weight_n.push_back(0.0);
        }
    }
}

} // namespace

RodSection round_section(const Material& material, double radius_m, double inner_m) {
    if (!(radius_m > 0.0 && std::isfinite(radius_m)))
        throw std::invalid_argument("radius_m = " + std::to_string(radius_m) +
                                    ": must be greater than 0");
    if (!(inner_m >= 0.0 && inner_m < radius_m))
        throw std::invalid_argument("inner_m = " + std::to_string(inner_m) +
                                    ": accepted: from 0 to less than radius_m");
    const double shear_pa = lame(material).mu_pa;
    const auto power = [&](int n) { return std::pow(radius_m, n) - std::pow(inner_m, n); };
    const double area_m2 = std::numbers::pi * power(2), polar_m4 = std::numbers::pi / 2 * power(4);
    return {material.young_pa * area_m2, material.young_pa * polar_m4 / 2, shear_pa * polar_m4,
            material.density_kgpm3 * area_m2, material.density_kgpm3 * polar_m4};
}

RodModel make_rod(std::span<const dvec3> node_m, std::span<const RodSection> section,
                  const Material& material, std::span<const std::uint8_t> held,
                  const dvec3& gravity_mps2) {
    check(node_m, section, held);
    RodModel model;
    model.material = material;
    model.rest_m.assign(node_m.begin(), node_m.end());
    add_frames(model);
    model.section.assign(section.begin(), section.end());
    model.section.resize(model.length_m.size(), section[0]);
    std::vector<std::uint8_t> fixed(held.begin(), held.end());
    fixed.resize(node_m.size(), 0);
    add_masses(fixed, model);
    number_unknowns(fixed, gravity_mps2, model);
    model.hold_npm.assign(node_m.size(), 0.0);
    model.hold_turn_nm.assign(model.length_m.size(), 0.0);
    return model;
}

void hold_by(std::span<const double> npm, std::span<const double> turn_nm, RodModel& model) {
    if (npm.size() != model.rest_m.size() || turn_nm.size() != model.length_m.size())
        throw std::invalid_argument(std::to_string(npm.size()) + " and " +
                                    std::to_string(turn_nm.size()) + " springs for " +
                                    std::to_string(model.rest_m.size()) + " nodes");
    for (const std::span<const double> list : {npm, turn_nm}) {
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (!(list[i] >= 0.0 && std::isfinite(list[i])))
                throw std::invalid_argument("spring " + std::to_string(i) + " = " +
                                            std::to_string(list[i]) +
                                            ": must be finite and not negative");
        }
    }
    model.hold_npm.assign(npm.begin(), npm.end());
    model.hold_turn_nm.assign(turn_nm.begin(), turn_nm.end());
}

RodState rest_state(const RodModel& model) {
    return {model.rest_m, std::vector<dvec3>(model.rest_m.size(), dvec3{0.0}), model.rest_frame,
            std::vector<double>(model.rest_frame.size(), 0.0),
            std::vector<double>(model.rest_frame.size(), 0.0)};
}

} // namespace tissue
