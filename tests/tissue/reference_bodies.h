// tests/tissue/reference_bodies.h
// Bodies and small helpers shared by the tests of the reference solver.
#pragma once

#include "tests/tissue/bodies.h"
#include "tissue/reference/reference.h"

namespace reference_bodies {

/// Flags of held components, `flag(rest place)` for every node.
template <typename Flag>
std::vector<std::uint8_t> flags(const tissue::QuadraticMesh& mesh, Flag flag) {
    std::vector<std::uint8_t> held;
    for (const glm::dvec3& x : mesh.rest_m)
        held.push_back(static_cast<std::uint8_t>(flag(x)));
    return held;
}

/// `place(rest place)` for every node.
template <typename Place>
std::vector<glm::dvec3> places(const tissue::QuadraticMesh& mesh, Place place) {
    std::vector<glm::dvec3> x;
    for (const glm::dvec3& rest : mesh.rest_m)
        x.push_back(place(rest));
    return x;
}

/// A box whose inner corners are moved about; edges stay straight, their nodes in the middle.
inline tissue::QuadraticMesh irregular_box(const glm::dvec3& size_m, int cells, unsigned seed) {
    return tissue::quadratic_mesh(tissue::box_mesh(size_m, {cells, cells, cells}, 0.2, seed));
}

inline bool on_box(const glm::dvec3& x, const glm::dvec3& size_m) {
    return glm::any(glm::lessThan(x, glm::dvec3(1e-9))) ||
           glm::any(glm::greaterThan(x, size_m - 1e-9));
}

/// Shares of a uniform traction on the boundary faces where `chosen(centroid)`: on straight faces
/// a third of the face for each edge node, nothing for the corners. They sum to the area.
template <typename Chosen>
std::vector<double> face_areas_m2(const tissue::QuadraticMesh& mesh, Chosen chosen) {
    std::vector<double> area(mesh.rest_m.size(), 0.0);
    for (const tissue::Triangle6& t : boundary_triangles(mesh)) {
        const glm::dvec3 a = mesh.rest_m[t[0]], b = mesh.rest_m[t[1]], c = mesh.rest_m[t[2]];
        if (!chosen((a + b + c) / 3.0))
            continue;
        for (int k = 3; k < 6; ++k)
            area[t[k]] += glm::length(glm::cross(b - a, c - a)) / 6;
    }
    return area;
}

/// Mean displacement over the same faces.
inline glm::dvec3 mean_displacement_m(const tissue::QuadraticMesh& mesh,
                                      const std::vector<glm::dvec3>& position_m,
                                      const std::vector<double>& area_m2) {
    glm::dvec3 sum{0.0};
    double area = 0.0;
    for (std::size_t i = 0; i < area_m2.size(); ++i) {
        sum += area_m2[i] * (position_m[i] - mesh.rest_m[i]);
        area += area_m2[i];
    }
    return sum / area;
}

struct Solved {
    tissue::ReferenceModel model;
    tissue::ReferenceState state;
    tissue::NewtonReport report;
};

inline Solved solve(const tissue::QuadraticMesh& mesh, const tissue::Material& material,
                    tissue::Law law, const std::vector<std::uint8_t>& held,
                    const tissue::ReferenceLoad& load, const glm::dvec3& gravity = {},
                    const tissue::NewtonOptions& options = {}) {
    Solved s{tissue::make_reference(mesh, material, law, held, gravity), {}, {}};
    s.state = rest_state(s.model);
    tissue::ReferenceSystem system = make_system(s.model);
    s.report = solve_static(s.model, load, options, system, s.state);
    return s;
}

/// Greatest distance of a node from `place(rest place)`.
template <typename Place> double greatest_error_m(const Solved& s, Place place) {
    double greatest = 0.0;
    for (std::size_t i = 0; i < s.model.mesh.rest_m.size(); ++i) {
        greatest =
            std::max(greatest, glm::length(s.state.position_m[i] - place(s.model.mesh.rest_m[i])));
    }
    return greatest;
}

/// The beam that other systems were measured on: 0.2 x 0.04 x 0.04 m, clamped at x = 0, rho 1000,
/// under its weight in -y.
inline Solved heavy_beam(const std::array<int, 3>& cells, double young_pa, double poisson) {
    const auto mesh = tissue::quadratic_mesh(tissue::box_mesh({0.2, 0.04, 0.04}, cells));
    const auto held = flags(mesh, [](auto x) { return x.x < 1e-9 ? tissue::kHeld : 0; });
    return solve(mesh, bodies::elastic(young_pa, poisson), tissue::Law::neo_hooke, held, {},
                 {0, -9.81, 0});
}

/// Displacement of the centre of its end face; there is a node for any number of cells.
inline glm::dvec3 tip_m(const Solved& s) {
    for (std::size_t i = 0; i < s.model.mesh.rest_m.size(); ++i) {
        if (glm::length(s.model.mesh.rest_m[i] - glm::dvec3(0.2, 0.02, 0.02)) < 1e-9)
            return s.state.position_m[i] - s.model.mesh.rest_m[i];
    }
    return glm::dvec3(0.0);
}

} // namespace reference_bodies
