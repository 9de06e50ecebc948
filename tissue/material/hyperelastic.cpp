// tissue/material/hyperelastic.cpp
// The two laws and the projection of a tangent. Any thread.
#include "tissue/material/hyperelastic.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

// J = det F, C = dJ/dF = J F^-T, I1 = |F|^2
struct Invariants {
    double J, I1;
    dmat3 C;
};

Invariants invariants(const dmat3& F) noexcept {
    const dmat3 C{glm::cross(F[1], F[2]), glm::cross(F[2], F[0]), glm::cross(F[0], F[1])};
    return {glm::dot(F[0], C[0]),
            glm::dot(F[0], F[0]) + glm::dot(F[1], F[1]) + glm::dot(F[2], F[2]), C};
}

// ---- small strain

dmat3 small_strain(const dmat3& F) noexcept {
    return 0.5 * (F + dmat3{F[0][0], F[1][0], F[2][0], F[0][1], F[1][1], F[2][1], F[0][2], F[1][2],
                            F[2][2]}) -
           dmat3(1.0);
}

double lambda_pa(const Elasticity& e) noexcept {
    return e.bulk_pa - 2.0 / 3.0 * e.mu_pa;
}

double small_strain_energy(const Elasticity& e, const dmat3& F) noexcept {
    const dmat3 strain = small_strain(F);
    double square = 0.0;
    for (int c = 0; c < 3; ++c)
        square += glm::dot(strain[c], strain[c]);
    const double trace = strain[0][0] + strain[1][1] + strain[2][2];
    return e.mu_pa * square + 0.5 * lambda_pa(e) * trace * trace;
}

dmat3 small_strain_stress(const Elasticity& e, const dmat3& F) noexcept {
    const dmat3 strain = small_strain(F);
    const double trace = strain[0][0] + strain[1][1] + strain[2][2];
    return 2.0 * e.mu_pa * strain + dmat3(lambda_pa(e) * trace);
}

Tangent small_strain_tangent(const Elasticity& e) noexcept {
    Tangent t{};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            t[4 * i][4 * j] += lambda_pa(e);
            t[3 * i + j][3 * i + j] += e.mu_pa;
            t[3 * i + j][3 * j + i] += e.mu_pa;
        }
    }
    return t;
}

// ---- neo-Hooke

double neo_hooke_energy(const Elasticity& e, const dmat3& F) noexcept {
    const auto [J, I1, C] = invariants(F);
    if (!(J > 0.0))
        return std::numeric_limits<double>::infinity();
    const double away = J - 1.0;
    return 0.5 * e.mu_pa * (I1 / std::cbrt(J * J) - 3.0) + 0.5 * e.bulk_pa * away * away;
}

// P = mu J^-2/3 (F - I1/(3J) C) + K (J - 1) C
dmat3 neo_hooke_stress(const Elasticity& e, const dmat3& F) noexcept {
    const auto [J, I1, C] = invariants(F);
    const double mu = e.mu_pa / std::cbrt(J * J);
    return mu * F + (e.bulk_pa * (J - 1.0) - mu * I1 / (3.0 * J)) * C;
}

// dP/dF = mu J^-2/3 [I - 2/(3J) (F C^T + C F^T) + 5 I1/(9 J^2) C C^T] + K C C^T
//         + [K (J - 1) - mu J^-2/3 I1/(3J)] dC/dF, products of vectors of nine
Tangent neo_hooke_tangent(const Elasticity& e, const dmat3& F) noexcept {
    const auto [J, I1, C] = invariants(F);
    const double mu = e.mu_pa / std::cbrt(J * J);
    const double mixed = -2.0 * mu / (3.0 * J);
    const double square = 5.0 * mu * I1 / (9.0 * J * J) + e.bulk_pa;
    Tangent t{};
    for (int i = 0; i < 9; ++i) {
        const double Fi = F[i / 3][i % 3], Ci = C[i / 3][i % 3];
        for (int j = 0; j < 9; ++j) {
            const double Fj = F[j / 3][j % 3], Cj = C[j / 3][j % 3];
            t[i][j] = mixed * (Fi * Cj + Ci * Fj) + square * Ci * Cj;
        }
        t[i][i] += mu;
    }
    // C_k = F_l x F_m for cyclic k, l, m: dC_k = dF_l x F_m + F_l x dF_m
    const double bend = e.bulk_pa * (J - 1.0) - mu * I1 / (3.0 * J);
    for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        for (int r = 0; r < 3; ++r) {
            const int s = (r + 1) % 3, q = (r + 2) % 3;
            t[3 * k + r][3 * l + s] += bend * F[m][q];
            t[3 * k + r][3 * l + q] -= bend * F[m][s];
            t[3 * k + r][3 * m + q] += bend * F[l][s];
            t[3 * k + r][3 * m + s] -= bend * F[l][q];
        }
    }
    return t;
}

// Turns rows and columns p, q of `a` so that a[p][q] becomes 0, and the columns of `v` with them.
void jacobi_rotate(Tangent& a, Tangent& v, int p, int q) noexcept {
    const double angle = 0.5 * std::atan2(2.0 * a[p][q], a[q][q] - a[p][p]);
    const double c = std::cos(angle), s = std::sin(angle);
    for (int k = 0; k < 9; ++k) {
        const double kp = a[k][p], kq = a[k][q];
        a[k][p] = c * kp - s * kq;
        a[k][q] = s * kp + c * kq;
        const double vp = v[k][p], vq = v[k][q];
        v[k][p] = c * vp - s * vq;
        v[k][q] = s * vp + c * vq;
    }
    for (int k = 0; k < 9; ++k) {
        const double pk = a[p][k], qk = a[q][k];
        a[p][k] = c * pk - s * qk;
        a[q][k] = s * pk + c * qk;
    }
}

// Cholesky with a diagonal raised by so little that no projection could matter less.
bool is_positive(Tangent a) noexcept {
    constexpr double kRaised = 1e-9; // of the mean diagonal
    double trace = 0.0;
    for (int i = 0; i < 9; ++i)
        trace += a[i][i];
    for (int j = 0; j < 9; ++j) {
        double pivot = a[j][j] + kRaised * trace / 9.0;
        for (int k = 0; k < j; ++k)
            pivot -= a[j][k] * a[j][k];
        if (!(pivot > 0.0))
            return false;
        a[j][j] = std::sqrt(pivot);
        for (int i = j + 1; i < 9; ++i) {
            for (int k = 0; k < j; ++k)
                a[i][j] -= a[i][k] * a[j][k];
            a[i][j] /= a[j][j];
        }
    }
    return true;
}

} // namespace

Elasticity elasticity(const Material& material, Law law) {
    const Lame constants = lame(material);
    return {law, constants.mu_pa, constants.lambda_pa + 2.0 / 3.0 * constants.mu_pa};
}

double energy_density_jpm3(const Elasticity& e, const dmat3& F) noexcept {
    return e.law == Law::neo_hooke ? neo_hooke_energy(e, F) : small_strain_energy(e, F);
}

dmat3 piola_stress_pa(const Elasticity& e, const dmat3& F) noexcept {
    return e.law == Law::neo_hooke ? neo_hooke_stress(e, F) : small_strain_stress(e, F);
}

Tangent piola_tangent_pa(const Elasticity& e, const dmat3& F) noexcept {
    return e.law == Law::neo_hooke ? neo_hooke_tangent(e, F) : small_strain_tangent(e);
}

void project_positive(Tangent& tangent) noexcept {
    if (is_positive(tangent))
        return;
    constexpr int kSweeps = 20; // quadratic in the end: 6 to 8 are needed
    constexpr double kDone = 1e-30;
    Tangent a = tangent, v{};
    for (int i = 0; i < 9; ++i)
        v[i][i] = 1.0;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        double off = 0.0, all = 0.0;
        for (int p = 0; p < 9; ++p) {
            for (int q = 0; q < 9; ++q) {
                all += a[p][q] * a[p][q];
                off += p == q ? 0.0 : a[p][q] * a[p][q];
            }
        }
        if (off <= kDone * all)
            break;
        for (int p = 0; p < 8; ++p) {
            for (int q = p + 1; q < 9; ++q)
                jacobi_rotate(a, v, p, q);
        }
    }
    for (int k = 0; k < 9; ++k) {
        const double excess = std::max(-a[k][k], 0.0);
        for (int i = 0; i < 9; ++i) {
            for (int j = 0; j < 9; ++j)
                tangent[i][j] += excess * v[i][k] * v[j][k];
        }
    }
}

} // namespace tissue
