// tissue/material/prony.cpp
// The memory of a viscoelastic point and the law it makes. Any thread.
#include "tissue/material/prony.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

dmat3 full(const Symmetric& s) noexcept {
    return {s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]};
}

double trace(const Symmetric& s) noexcept {
    return s[0] + s[1] + s[2];
}

dmat3 cofactors(const dmat3& F) noexcept {
    return {glm::cross(F[1], F[2]), glm::cross(F[2], F[0]), glm::cross(F[0], F[1])};
}

double inner(const dmat3& a, const dmat3& b) noexcept {
    return glm::dot(a[0], b[0]) + glm::dot(a[1], b[1]) + glm::dot(a[2], b[2]);
}

dmat3 deviator_of_strain(const dmat3& F) noexcept {
    dmat3 e = 0.5 * (F + glm::transpose(F));
    const double mean = (e[0][0] + e[1][1] + e[2][2]) / 3.0;
    return e - dmat3(mean);
}

double dilation(const dmat3& F) noexcept {
    return F[0][0] + F[1][1] + F[2][2] - 3.0;
}

void check(const Material& material) {
    if (material.prony.size() > kPronyMost) {
        throw std::invalid_argument("prony has " + std::to_string(material.prony.size()) +
                                    " terms: at most " + std::to_string(kPronyMost));
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < material.prony.size(); ++i) {
        const std::string name = "prony term " + std::to_string(i);
        const PronyTerm& term = material.prony[i];
        sum += term.share;
        if (!(term.share > 0.0) || !(sum < 1.0)) {
            throw std::invalid_argument(name + " takes " + std::to_string(term.share) +
                                        " of the shear modulus: must be greater than 0, and all "
                                        "terms together less than 1");
        }
        if (!(term.time_s > 0.0) || !std::isfinite(term.time_s)) {
            throw std::invalid_argument(name + " has time_s = " + std::to_string(term.time_s) +
                                        ": must be finite and greater than 0");
        }
    }
}

} // namespace

PronyStep prony_step(const Material& material, double dt_s) {
    check(material);
    const double mu_pa = lame(material).mu_pa;
    PronyStep step{.terms = material.prony.size(), .rest_pa = mu_pa};
    for (std::size_t i = 0; i < step.terms; ++i) {
        const double x = dt_s / material.prony[i].time_s;
        const double keep = std::exp(-x), mean = x > 0.0 ? -std::expm1(-x) / x : 1.0;
        step.term[i] = {material.prony[i].share * mu_pa, keep, mean - keep, 1.0 - mean};
        step.rest_pa -= step.term[i].mu_pa;
    }
    step.mu_pa = step.rest_pa;
    for (std::size_t i = 0; i < step.terms; ++i)
        step.mu_pa += step.term[i].mu_pa * (step.term[i].keep + step.term[i].last);
    return step;
}

Symmetric relaxed(Law law, const dmat3& F) noexcept {
    if (law == Law::small_strain) {
        const dmat3 e = deviator_of_strain(F);
        return {1.0 - 2.0 * e[0][0], 1.0 - 2.0 * e[1][1], 1.0 - 2.0 * e[2][2],
                -2.0 * e[1][0],      -2.0 * e[2][1],      -2.0 * e[0][2]};
    }
    constexpr double kMost = 75.0; // of the trace
    const dmat3 C = cofactors(F);
    const double J = glm::dot(F[0], C[0]);
    if (!(J > 0.0))
        return kUnit;
    // B^-1 = J^2/3 F^-1 F^-T, F^-T = C/J
    const double scale = std::min(1.0 / (J * std::cbrt(J)), kMost / inner(C, C));
    return {scale * glm::dot(C[0], C[0]), scale * glm::dot(C[1], C[1]),
            scale * glm::dot(C[2], C[2]), scale * glm::dot(C[0], C[1]),
            scale * glm::dot(C[1], C[2]), scale * glm::dot(C[2], C[0])};
}

Symmetric shear_pa(const PronyStep& step, std::span<const Symmetric> memory,
                   const Symmetric& now) noexcept {
    Symmetric M;
    for (std::size_t k = 0; k < M.size(); ++k)
        M[k] = step.rest_pa * kUnit[k];
    for (std::size_t i = 0; i < step.terms; ++i) {
        const PronyStep::Term& t = step.term[i];
        for (std::size_t k = 0; k < M.size(); ++k)
            M[k] += t.mu_pa * (t.keep * memory[i][k] + t.last * now[k]);
    }
    return M;
}

void remember(const PronyStep& step, const Symmetric& before, const Symmetric& after,
              std::span<Symmetric> memory) noexcept {
    for (std::size_t i = 0; i < step.terms; ++i) {
        const PronyStep::Term& t = step.term[i];
        for (std::size_t k = 0; k < before.size(); ++k)
            memory[i][k] = t.keep * memory[i][k] + t.last * before[k] + t.next * after[k];
    }
}

double energy_density_jpm3(const Elasticity& e, const Symmetric& M, const dmat3& F) noexcept {
    if (e.law == Law::small_strain) {
        const dmat3 dev = deviator_of_strain(F);
        const double tr = dilation(F);
        return inner(full(M), dev) + trace(M) / 3.0 * inner(dev, dev) + 0.5 * e.bulk_pa * tr * tr;
    }
    const double J = glm::dot(F[0], glm::cross(F[1], F[2]));
    if (!(J > 0.0))
        return std::numeric_limits<double>::infinity();
    const double away = J - 1.0;
    return 0.5 * (inner(F * full(M), F) / std::cbrt(J * J) - trace(M)) +
           0.5 * e.bulk_pa * away * away;
}

// P = J^-2/3 (F M - (FM:F)/(3J) C) + K (J - 1) C
dmat3 piola_stress_pa(const Elasticity& e, const Symmetric& M, const dmat3& F) noexcept {
    if (e.law == Law::small_strain) {
        return full(M) + 2.0 / 3.0 * trace(M) * deviator_of_strain(F) +
               dmat3(e.bulk_pa * dilation(F) - trace(M) / 3.0);
    }
    const dmat3 C = cofactors(F), T = F * full(M);
    const double J = glm::dot(F[0], C[0]), shear = 1.0 / std::cbrt(J * J);
    return shear * T + (e.bulk_pa * (J - 1.0) - shear * inner(T, F) / (3.0 * J)) * C;
}

// dP/dF = J^-2/3 [dF M - 2/(3J) (FM C^T + C FM^T) + 5 (FM:F)/(9 J^2) C C^T] + K C C^T
//         + [K (J - 1) - J^-2/3 (FM:F)/(3J)] dC/dF, products of vectors of nine
Tangent piola_tangent_pa(const Elasticity& e, const Symmetric& M, const dmat3& F) noexcept {
    if (e.law == Law::small_strain)
        return piola_tangent_pa({e.law, trace(M) / 3.0, e.bulk_pa}, F);
    const dmat3 C = cofactors(F), m = full(M), T = F * m;
    const double J = glm::dot(F[0], C[0]), shear = 1.0 / std::cbrt(J * J), TF = inner(T, F);
    const double mixed = -2.0 * shear / (3.0 * J);
    const double square = 5.0 * shear * TF / (9.0 * J * J) + e.bulk_pa;
    const double bend = e.bulk_pa * (J - 1.0) - shear * TF / (3.0 * J);
    Tangent t{};
    for (int i = 0; i < 9; ++i) {
        const double Ti = T[i / 3][i % 3], Ci = C[i / 3][i % 3];
        for (int j = 0; j < 9; ++j) {
            const double Tj = T[j / 3][j % 3], Cj = C[j / 3][j % 3];
            t[i][j] = mixed * (Ti * Cj + Ci * Tj) + square * Ci * Cj;
        }
        for (int c = 0; c < 3; ++c)
            t[i][3 * c + i % 3] += shear * m[c][i / 3];
    }
    // C_k = F_l x F_m for cyclic k, l, m: dC_k = dF_l x F_m + F_l x dF_m
    for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3, n = (k + 2) % 3;
        for (int r = 0; r < 3; ++r) {
            const int s = (r + 1) % 3, q = (r + 2) % 3;
            t[3 * k + r][3 * l + s] += bend * F[n][q];
            t[3 * k + r][3 * l + q] -= bend * F[n][s];
            t[3 * k + r][3 * n + q] += bend * F[l][s];
            t[3 * k + r][3 * n + s] -= bend * F[l][q];
        }
    }
    return t;
}

double stored_density_jpm3(const Elasticity& e, const PronyStep& at_once,
                           std::span<const Symmetric> memory, const dmat3& F) noexcept {
    const Elasticity rest{e.law, at_once.rest_pa, e.bulk_pa};
    double sum = energy_density_jpm3(rest, F);
    const double J = glm::dot(F[0], glm::cross(F[1], F[2]));
    const dmat3 dev = deviator_of_strain(F);
    for (std::size_t i = 0; i < at_once.terms; ++i) {
        const dmat3 A = full(memory[i]);
        if (e.law == Law::small_strain) {
            const dmat3 away = dev + 0.5 * (A - dmat3(1.0));
            sum += at_once.term[i].mu_pa * inner(away, away);
        } else {
            const double det = glm::dot(A[0], glm::cross(A[1], A[2]));
            sum += 0.5 * at_once.term[i].mu_pa *
                   (inner(F * A, F) / std::cbrt(J * J) - 3.0 - std::log(det));
        }
    }
    return sum;
}

} // namespace tissue
