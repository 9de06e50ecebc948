// See the header.
#include "tissue/rod/rod_line.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

double area_m2(double radius_m) {
    return std::numbers::pi * radius_m * radius_m;
}

double edge_radius_m(const RodLine& line, std::size_t e) {
    return 0.5 * (line.radius_m[e] + line.radius_m[e + 1]);
}

double edge_length_m(const RodLine& line, std::size_t e) {
    return glm::distance(line.node_m[e], line.node_m[e + 1]);
}

// Springs of each node, N/m.
std::vector<double> springs_npm(const RodLine& line, double young_pa) {
    std::vector<double> npm;
    for (const double hold_m : line.hold_m)
        npm.push_back(young_pa * hold_m);
    for (std::size_t e = 0; e + 1 < line.node_m.size(); ++e) {
        for (const std::size_t i : {e, e + 1})
            npm[i] += 0.5 * line.bed_pa * edge_length_m(line, e);
    }
    return npm;
}

void check(const RodLine& line, const Material& material) {
    const std::size_t nodes = line.node_m.size();
    for (const std::size_t size : {line.radius_m.size(), line.held.size(), line.hold_m.size()}) {
        if (size != nodes)
            throw std::invalid_argument("a rod's line: " + std::to_string(size) + " values for " +
                                        std::to_string(nodes) + " nodes");
    }
    if (!material.prony.empty())
        throw std::invalid_argument("a rod has no memory: no Prony series");
}

} // namespace

void hold_line(const std::function<bool(const glm::dvec3&)>& inside, double length_m,
               RodLine& line) {
    if (!(length_m > 0.0 && std::isfinite(length_m)))
        throw std::invalid_argument("length_m = " + std::to_string(length_m) +
                                    ": must be greater than 0");
    constexpr int kSamples = 64; // of an edge
    line.held.assign(line.node_m.size(), 0);
    line.hold_m.assign(line.node_m.size(), 0.0);
    for (std::size_t e = 0; e + 1 < line.node_m.size(); ++e) {
        const double share_m = area_m2(edge_radius_m(line, e)) * edge_length_m(line, e) /
                               (kSamples * length_m * length_m);
        for (int k = 0; k < kSamples; ++k) {
            const double at = (k + 0.5) / kSamples;
            if (!inside((1.0 - at) * line.node_m[e] + at * line.node_m[e + 1]))
                continue;
            line.hold_m[e] += (1.0 - at) * share_m;
            line.hold_m[e + 1] += at * share_m;
        }
    }
}

void fix_line(const std::function<bool(const glm::dvec3&)>& inside, RodLine& line) {
    line.held.clear();
    for (const glm::dvec3& x : line.node_m)
        line.held.push_back(inside(x) ? 1 : 0);
    line.hold_m.assign(line.node_m.size(), 0.0);
}

double hold_npm(const RodLine& line, double young_pa) {
    double sum_npm = 0.0;
    for (const double npm : springs_npm(line, young_pa))
        sum_npm += npm;
    return sum_npm;
}

double volume_m3(const RodLine& line) {
    double sum_m3 = 0.0;
    for (std::size_t e = 0; e + 1 < line.node_m.size(); ++e) {
        const double a = line.radius_m[e], b = line.radius_m[e + 1]; // a truncated cone
        sum_m3 += std::numbers::pi / 3.0 * (a * a + a * b + b * b) * edge_length_m(line, e);
    }
    return sum_m3;
}

bool has_hold(const RodLine& line) noexcept {
    const auto fixed = [](std::uint8_t a, std::uint8_t b) { return a != 0 && b != 0; };
    return line.bed_pa > 0.0 ||
           std::any_of(line.hold_m.begin(), line.hold_m.end(), [](double k) { return k > 0.0; }) ||
           std::adjacent_find(line.held.begin(), line.held.end(), fixed) != line.held.end();
}

RodModel make_rod(const RodLine& line, const Material& material, const glm::dvec3& gravity_mps2) {
    check(line, material);
    std::vector<RodSection> section;
    for (std::size_t e = 0; e + 1 < line.node_m.size(); ++e)
        section.push_back(round_section(material, edge_radius_m(line, e)));
    RodModel model = make_rod(line.node_m, section, material, line.held, gravity_mps2);
    const std::vector<double> npm = springs_npm(line, material.young_pa);
    std::vector<double> turn_nm;
    for (std::size_t e = 0; e < section.size(); ++e) {
        // an edge between two nodes has half of each one's springs, the outermost all of theirs
        const double before = e == 0 ? 1.0 : 0.5, after = e + 1 == section.size() ? 1.0 : 0.5;
        const double r_m = edge_radius_m(line, e);
        turn_nm.push_back(0.5 * r_m * r_m * (before * npm[e] + after * npm[e + 1]));
    }
    hold_by(npm, turn_nm, model);
    return model;
}

} // namespace tissue
