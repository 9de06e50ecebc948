// tissue/solver/corotated_element.h
// One corotated tetrahedron: energy, force, tangent. Internal to the corotated solver.
//   psi = mu |F - R|^2 + lambda/2 (tr S - 3)^2,  S = F R^T (left stretch, symmetric)
//   f_a = V [2 mu (S - I) + lambda (tr S - 3) I] g_a,  g_a = R G_a
// Tangent with the derivative of R (Chao et al. 2010; Barbic 2012). Its rotation part is
//   [g_a]x^T (mu I - c Q^-1) [g_b]x,  Q = tr(S) I - S,  c = 2 mu - lambda (tr S - 3),
// and with [Q b]x = det(Q) Q^-1 [b]x Q^-1 it needs no inverse and joins the warped part:
//   K_ab = V { lambda g_a g_b^T + 2 mu (g_a.g_b) I + c/det(Q) [q_b q_a^T - (g_a.q_b) Q] }, q = Q g
// Without it (warped): K_ab = V { lambda g_a g_b^T + mu g_b g_a^T + mu (g_a.g_b) I }.
#pragma once

#include "tissue/solver/corotated.h"
#include "tissue/solver/polar_rotation.h"

namespace tissue {

struct ElementShape {
    glm::dmat3 rotation;
    glm::dmat3 stretch; // S
    double trace;       // of S
    double det;         // of F
};

inline glm::dmat3 deformation_gradient(const CorotatedModel& model, std::size_t tet,
                                       std::span<const glm::dvec3> x) noexcept {
    const Tet& t = model.mesh.tets[tet];
    const std::array<glm::dvec3, 4>& G = model.gradient_1pm[tet];
    const glm::dvec3 e1 = x[t[1]] - x[t[0]], e2 = x[t[2]] - x[t[0]], e3 = x[t[3]] - x[t[0]];
    return {G[1].x * e1 + G[2].x * e2 + G[3].x * e3, G[1].y * e1 + G[2].y * e2 + G[3].y * e3,
            G[1].z * e1 + G[2].z * e2 + G[3].z * e3};
}

inline double determinant(const glm::dmat3& F) noexcept {
    return glm::dot(F[0], glm::cross(F[1], F[2]));
}

inline ElementShape element_shape(const CorotatedModel& model, std::size_t tet,
                                  std::span<const glm::dvec3> x) noexcept {
    const glm::dmat3 F = deformation_gradient(model, tet, x);
    const glm::dmat3 R = polar_rotation(F);
    // S = sum_k F_k R_k^T over columns k; the mean of both triangles is exactly symmetric
    glm::dmat3 S;
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r <= c; ++r) {
            const double rc = F[0][r] * R[0][c] + F[1][r] * R[1][c] + F[2][r] * R[2][c];
            const double cr = F[0][c] * R[0][r] + F[1][c] * R[1][r] + F[2][c] * R[2][r];
            S[c][r] = S[r][c] = 0.5 * (rc + cr);
        }
    }
    return {R, S, S[0][0] + S[1][1] + S[2][2], determinant(F)};
}

/// The same about a rotation that is not the nearest: S = F R^T, not symmetric. The forces are
/// those of mu |F - R|^2 + lambda/2 (tr S - 3)^2 with R held, which is convex in F.
inline ElementShape element_shape_about(const glm::dmat3& F, const glm::dmat3& R) noexcept {
    const glm::dmat3 S = F * glm::transpose(R);
    return {R, S, S[0][0] + S[1][1] + S[2][2], determinant(F)};
}

inline double element_energy_j(const CorotatedModel& model, std::size_t tet,
                               const ElementShape& s) noexcept {
    // |F - R|^2 = |S - I|^2, because F = S R
    double strain2 = 0.0;
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r)
            strain2 += std::pow(s.stretch[c][r] - (r == c ? 1.0 : 0.0), 2);
    }
    const double dilation = s.trace - 3.0;
    return model.volume_m3[tet] *
           (model.mu_pa * strain2 + 0.5 * model.lambda_pa * dilation * dilation);
}

/// V sigma: the force on corner a is this times g_a.
inline glm::dmat3 element_stress_nm(const CorotatedModel& model, std::size_t tet,
                                    const ElementShape& s) noexcept {
    const double two_mu = 2.0 * model.mu_pa * model.volume_m3[tet];
    const double pressure = model.lambda_pa * model.volume_m3[tet] * (s.trace - 3.0) - two_mu;
    glm::dmat3 sigma{two_mu * s.stretch[0], two_mu * s.stretch[1], two_mu * s.stretch[2]};
    for (int k = 0; k < 3; ++k)
        sigma[k][k] += pressure;
    return sigma;
}

/// Coefficients that make the exact and the warped block the same expression:
///   K_ab = dilation g_a g_b^T + shear (g_a.g_b) I + spin [q_b q_a^T - (g_a.q_b) Q]
struct ElementTangent {
    double dilation, shear, spin;
    glm::dmat3 Q;
};

/// Inverted and flat tets take the warped form also when `exact`: their exact tangent points the
/// wrong way, or has no bound.
inline ElementTangent element_tangent(const CorotatedModel& model, std::size_t tet,
                                      const ElementShape& s, bool exact) noexcept {
    constexpr double kFlat = 1e-6; // det Q = (s1+s2)(s2+s3)(s3+s1) is 8 at rest
    const double volume = model.volume_m3[tet];
    if (exact && s.det > 0.0) {
        glm::dmat3 Q{-s.stretch[0], -s.stretch[1], -s.stretch[2]};
        for (int k = 0; k < 3; ++k)
            Q[k][k] += s.trace;
        const double det = glm::dot(Q[0], glm::cross(Q[1], Q[2]));
        if (det > kFlat) {
            const double c = 2.0 * model.mu_pa - model.lambda_pa * (s.trace - 3.0);
            return {volume * model.lambda_pa, 2.0 * volume * model.mu_pa, volume * c / det, Q};
        }
    }
    // q = -g: the products of two q keep their sign, the last term becomes -mu (g_a.g_b) I
    return {volume * model.lambda_pa, 2.0 * volume * model.mu_pa, volume * model.mu_pa,
            glm::dmat3(-1.0)};
}

/// Of element_shape_about(): R held, whatever F does.
inline ElementTangent element_tangent_about(const CorotatedModel& model, std::size_t tet) noexcept {
    const double volume = model.volume_m3[tet];
    return {volume * model.lambda_pa, 2.0 * volume * model.mu_pa, 0.0, glm::dmat3(0.0)};
}

} // namespace tissue
