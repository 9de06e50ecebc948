// assets/bake/import/notes.h
// What import found and did, one line each, with places in the unit of the file. Called by all
// steps of import.
#pragma once

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace bake {

/// The surface cannot become an organ; the message says why and where. Exit 2.
struct ImportRefused : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Unit {
    std::string name = "mm"; // mm, cm or m
    double m = 1e-3;
};

struct Notes {
    Unit unit;
    std::vector<std::string> repairs, problems; // done; found and left as it is

    /// "(1.50, -2.00, 30.10) mm"
    [[nodiscard]] std::string place(const glm::dvec3& p_m) const {
        const glm::dvec3 p = p_m / unit.m;
        const int digits = unit.m > 0.5 ? 5 : 2;
        return fmt::format("({:.{}f}, {:.{}f}, {:.{}f}) {}", p.x, digits, p.y, digits, p.z, digits,
                           unit.name);
    }
    [[nodiscard]] std::string length(double m) const {
        return fmt::format("{:.3g} {}", m / unit.m, unit.name);
    }
};

} // namespace bake
