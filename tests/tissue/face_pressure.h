// tests/tissue/face_pressure.h
// Nodal forces of pressure on faces of linear or quadratic tetrahedra, straight or curved, and two
// bodies that answer them, the real-time tiers as they are: for punches, layers and tubes.
#pragma once

#include "tests/tissue/bodies.h"
#include "tests/tissue/cylinders.h"
#include "tests/tissue/quadratic_bodies.h"
#include "tissue/solver/quadratic_columns.h"

#include <doctest/doctest.h>

namespace face_pressure {

/// One point of a face's integral: shapes of its nodes and corners there, dA with the outward
/// normal.
struct FacePoint {
    glm::dvec3 place_m{0.0}, area_m2{0.0}, corner{0.0};
    std::array<double, 6> shape{};
};

/// Seven points, exact for degree 5 (Radon 1948). `node_m`: of the three or six nodes.
inline std::array<FacePoint, 7> face_points(std::span<const glm::dvec3> node_m) {
    const double root = std::sqrt(15.0);
    const double near = (6 - root) / 21, far = (6 + root) / 21;
    const double near_weight = (155 - root) / 1200, far_weight = (155 + root) / 1200;
    std::array<FacePoint, 7> points;
    for (std::size_t q = 0; q < 7; ++q) {
        FacePoint& p = points[q];
        p.corner = glm::dvec3{1.0 / 3};
        double weight = 9.0 / 40;
        if (q > 0) {
            const double b = q < 4 ? near : far;
            p.corner = glm::dvec3{b};
            p.corner[static_cast<int>((q - 1) % 3)] = 1 - 2 * b;
            weight = q < 4 ? near_weight : far_weight;
        }
        std::array<glm::dvec3, 6> slope{}; // of the shapes, by the corners' coordinates
        for (int k = 0; k < 3; ++k) {
            p.shape[k] = p.corner[k];
            slope[k][k] = 1.0;
            if (node_m.size() == 6)
                slope[k][k] = 4 * p.corner[k] - 1;
        }
        if (node_m.size() == 6) {
            p.shape = tissue::triangle_shapes(p.corner);
            for (int k = 0; k < 3; ++k) {
                const int j = (k + 1) % 3;
                slope[3 + k][k] = 4 * p.corner[j];
                slope[3 + k][j] = 4 * p.corner[k];
            }
        }
        glm::dvec3 first{0.0}, second{0.0};
        for (std::size_t i = 0; i < node_m.size(); ++i) {
            p.place_m += p.shape[i] * node_m[i];
            first += (slope[i].y - slope[i].x) * node_m[i];
            second += (slope[i].z - slope[i].x) * node_m[i];
        }
        p.area_m2 = 0.5 * weight * glm::cross(first, second);
    }
    return points;
}

/// Ten-node tetrahedra, neo-Hooke.
struct Quadratic {
    static constexpr const char* kName = "quadratic";
    tissue::QuadraticModel model;
    tissue::QuadraticState state;
    tissue::QuadraticSystem system;

    Quadratic(const tissue::QuadraticMesh& mesh, const tissue::Material& material,
              const std::vector<std::uint8_t>& held, double dt_s)
        : model(make_quadratic(mesh, material, held)), state(rest_state(model)),
          system(make_system(model, dt_s)) {
        linearize(model, state, system);
    }
    auto faces() const { return boundary_triangles(model.mesh); }
    void solve(std::span<double> block, int columns) {
        CHECK(solve_columns(model, {.linear_tolerance = 1e-5}, system, block, columns)
                  .relative_residual <= 1e-5);
    }
    std::vector<double> step(std::span<const double> load_n) {
        std::vector<double> du(load_n.size());
        linearize(model, state, system, load_n);
        const auto report = free_motion(model, quadratic_bodies::exact(), system, du);
        CHECK_FALSE(report.recovering);
        CHECK(report.relative_residual < 1e-4);
        advance(model, system, du, state);
        return du;
    }
};

/// Linear tetrahedra that turn: the corners of `mesh`.
struct Corotated {
    static constexpr const char* kName = "corotated";
    tissue::CorotatedModel model;
    tissue::CorotatedState state;
    tissue::CorotatedSystem system;
    double dt_s;

    Corotated(const tissue::QuadraticMesh& mesh, const tissue::Material& material,
              const std::vector<std::uint8_t>& held, double step_s)
        : model(make(mesh, material, held)), state(rest_state(model)), system(make_system(model)),
          dt_s(step_s) {
        linearize(model, state, dt_s, system);
    }
    static tissue::CorotatedModel make(const tissue::QuadraticMesh& mesh,
                                       const tissue::Material& material,
                                       const std::vector<std::uint8_t>& held) {
        tissue::TetMesh corners;
        std::size_t nodes = 0;
        for (const tissue::Tet10& t : mesh.tets) {
            corners.tets.push_back({t[0], t[1], t[2], t[3]});
            for (int k = 0; k < 4; ++k)
                nodes = std::max<std::size_t>(nodes, t[k] + 1);
        }
        corners.rest_m.assign(mesh.rest_m.begin(),
                              mesh.rest_m.begin() + static_cast<std::ptrdiff_t>(nodes));
        return make_corotated(corners, material,
                              std::span(held).first(std::min(nodes, held.size())));
    }
    auto faces() const { return boundary_triangles(model.mesh); }
    void solve(std::span<double> block, int columns) { system.factor.solve(block, columns); }
    std::vector<double> step(std::span<const double> load_n) {
        std::vector<double> du(load_n.size());
        linearize(model, state, dt_s, system);
        CHECK(free_motion(model, state, system, du, load_n).relative_residual < 1e-6);
        advance(model, du, dt_s, state);
        return du;
    }
};

/// Adds the forces of `pressure_pa(point)` on the faces where `chosen(centroid of corners)`;
/// returns the area.
template <typename Body, typename Chosen, typename Pressure>
double add_pressure(const Body& body, Chosen chosen, Pressure pressure_pa,
                    std::span<double> load_n) {
    double area_m2 = 0.0;
    for (const auto& face : body.faces()) {
        std::array<glm::dvec3, 6> node_m{};
        for (std::size_t i = 0; i < face.size(); ++i)
            node_m[i] = body.model.mesh.rest_m[face[i]];
        if (!chosen((node_m[0] + node_m[1] + node_m[2]) / 3.0))
            continue;
        for (const FacePoint& p : face_points(std::span(node_m).first(face.size()))) {
            area_m2 += glm::length(p.area_m2);
            const glm::dvec3 force_n = -pressure_pa(p, node_m) * p.area_m2;
            for (std::size_t i = 0; i < face.size(); ++i) {
                const auto d = body.model.dof[face[i]];
                for (int k = 0; k < 3 && d >= 0; ++k)
                    load_n[static_cast<std::size_t>(d + k)] += p.shape[i] * force_n[k];
            }
        }
    }
    return area_m2;
}

} // namespace face_pressure
