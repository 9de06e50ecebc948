// tissue/reference/tet10.h
// Shape functions and quadrature of the ten-node tetrahedron (Zienkiewicz, Taylor & Zhu 2005).
// Internal to the reference solver; tests too.
//   corner a: L_a (2 L_a - 1), edge between a and b: 4 L_a L_b, L: barycentric coordinates
#pragma once

#include "tissue/mesh/quadratic_mesh.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace tissue {

using Barycentric = std::array<double, 4>;

struct QuadraturePoint {
    Barycentric at;
    double weight; // of the tet's volume; they sum to 1
};

/// Degree 2 (Hammer, Marlowe & Stroud 1956): exact for the stiffness of a straight tet under a
/// linear law. The points are those of C3D10 in CalculiX.
inline constexpr double kNear = 0.5854101966249685; // (5 + 3 sqrt 5)/20
inline constexpr double kFar = 0.1381966011250105;  // (5 - sqrt 5)/20
inline constexpr std::array<QuadraturePoint, 4> kFourPoints{{{{kNear, kFar, kFar, kFar}, 0.25},
                                                             {{kFar, kNear, kFar, kFar}, 0.25},
                                                             {{kFar, kFar, kNear, kFar}, 0.25},
                                                             {{kFar, kFar, kFar, kNear}, 0.25}}};

/// Degree 5, positive weights (Walkington 2000): exact for the mass of a straight tet.
inline std::array<QuadraturePoint, 14> fourteen_points() noexcept {
    constexpr std::array<double, 2> kPlace{0.31088591926330061, 0.092735250310891226};
    constexpr std::array<double, 2> kWeight{0.11268792571801585, 0.073493043116361950};
    constexpr double kEdgePlace = 0.045503704125649649, kEdgeWeight = 0.042546020777081466;
    std::array<QuadraturePoint, 14> points{};
    std::size_t n = 0;
    for (std::size_t orbit = 0; orbit < 2; ++orbit) {
        for (std::size_t k = 0; k < 4; ++k) {
            points[n].at.fill(kPlace[orbit]);
            points[n].at[k] = 1.0 - 3.0 * kPlace[orbit];
            points[n++].weight = kWeight[orbit];
        }
    }
    for (const auto& [a, b] : kEdge) {
        points[n].at.fill(kEdgePlace);
        points[n].at[a] = points[n].at[b] = 0.5 - kEdgePlace;
        points[n++].weight = kEdgeWeight;
    }
    return points;
}

inline std::array<double, 10> shape_values(const Barycentric& L) noexcept {
    std::array<double, 10> N{};
    for (std::size_t a = 0; a < 4; ++a)
        N[a] = L[a] * (2.0 * L[a] - 1.0);
    for (std::size_t k = 0; k < kEdge.size(); ++k)
        N[4 + k] = 4.0 * L[kEdge[k][0]] * L[kEdge[k][1]];
    return N;
}

struct ShapeGradients {
    std::array<glm::dvec3, 10> gradient_1pm; // with respect to the rest place
    double six_volumes_m3;                   // det of d rest / d (L1, L2, L3)
};

/// Isoparametric: edge nodes may lie off the middle of the edge.
inline ShapeGradients shape_gradients(const QuadraticMesh& mesh, const Tet10& tet,
                                      const Barycentric& L) noexcept {
    constexpr std::array<std::array<double, 3>, 4> kLocal{
        {{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; // dL_a / d (L1, L2, L3)
    std::array<glm::dvec3, 10> local{};
    for (int k = 0; k < 3; ++k) {
        for (std::size_t a = 0; a < 4; ++a)
            local[a][k] = (4.0 * L[a] - 1.0) * kLocal[a][k];
        for (std::size_t e = 0; e < kEdge.size(); ++e) {
            const auto [a, b] = kEdge[e];
            local[4 + e][k] = 4.0 * (L[a] * kLocal[b][k] + L[b] * kLocal[a][k]);
        }
    }
    glm::dmat3 J(0.0);
    for (std::size_t a = 0; a < 10; ++a)
        J += glm::outerProduct(mesh.rest_m[tet[a]], local[a]);
    const glm::dmat3 to_rest = glm::transpose(glm::inverse(J));
    ShapeGradients g{{}, glm::determinant(J)};
    for (std::size_t a = 0; a < 10; ++a)
        g.gradient_1pm[a] = to_rest * local[a];
    return g;
}

} // namespace tissue
