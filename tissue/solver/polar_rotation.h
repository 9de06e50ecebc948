// tissue/solver/polar_rotation.h
// The rotation nearest to a deformation gradient, from F alone: no warm start, so that a state
// restores exactly. Called per tet by the corotated solver, tissue loop.
//   R = argmax tr(R^T F) over rotations = the polar factor if det F > 0, and the signed-SVD
//   rotation U V^T if F is inverted, which lets inverted tets recover (Irving et al. 2004)
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace tissue {

/// Rows of dF/dx's cofactors: d det(F) / dF, columns like F.
inline glm::dmat3 cofactor(const glm::dmat3& F) noexcept {
    return {glm::cross(F[1], F[2]), glm::cross(F[2], F[0]), glm::cross(F[0], F[1])};
}

/// Any F, also inverted, flat or zero: the quaternion of the largest eigenvalue of Horn's matrix
/// (Horn 1987), by Jacobi rotations. Slow and safe.
glm::dmat3 closest_rotation(const glm::dmat3& F) noexcept;

/// The same. Well-shaped F: Newton's iteration R <- (R + R^-T)/2 (Higham 1986), scaled while far.
inline glm::dmat3 polar_rotation(const glm::dmat3& F) noexcept {
    constexpr int kMaxIterations = 12;
    constexpr double kFlat = 1e-3;  // det F of a unit-size F below which Newton is not trusted
    constexpr double kDone = 1e-17; // squared change: the next one would be below 1e-16

    glm::dmat3 R = F;
    glm::dmat3 C = cofactor(R);
    double det = glm::dot(R[0], C[0]);
    double size2 = glm::dot(R[0], R[0]) + glm::dot(R[1], R[1]) + glm::dot(R[2], R[2]);
    if (!(det > kFlat * size2 * std::sqrt(size2)))
        return closest_rotation(F);

    double scale = 1.0; // Higham's: makes the singular values straddle 1
    if (std::abs(size2 - 3.0) > 0.3 || std::abs(det - 1.0) > 0.3) {
        const double cofactor2 = glm::dot(C[0], C[0]) + glm::dot(C[1], C[1]) + glm::dot(C[2], C[2]);
        scale = std::sqrt(std::sqrt(cofactor2 / size2) / det);
    }
    for (int i = 0; i < kMaxIterations; ++i) {
        const double keep = 0.5 * scale, add = 0.5 / (scale * det);
        const glm::dmat3 next{keep * R[0] + add * C[0], keep * R[1] + add * C[1],
                              keep * R[2] + add * C[2]};
        const glm::dvec3 d0 = next[0] - R[0], d1 = next[1] - R[1], d2 = next[2] - R[2];
        const double change2 = glm::dot(d0, d0) + glm::dot(d1, d1) + glm::dot(d2, d2);
        R = next;
        if (change2 < kDone)
            break;
        C = cofactor(R);
        det = glm::dot(R[0], C[0]);
        scale = 1.0;
    }
    return R;
}

} // namespace tissue
