// tissue/material/prony.h
// Viscoelastic shear: a Prony series whose memory is one symmetric tensor A per term and quadrature
// point. Called by the reference and the quadratic solver; any thread, no allocation but at setup.
//   G(t) = G0 [1 - sum g_i (1 - exp(-t/tau_i))], the bulk modulus does not relax
// Each term is a neo-Hooke network about a rest shape that flows (Lubliner 1985):
//   psi_i = g_i mu/2 (A:B - 3 - ln det A),  dA/dt = (B^-1 - A)/tau_i,  B = J^-2/3 F^T F
// At rest A = I. It is objective, dissipates g_i mu/(2 tau_i) tr(A B + (A B)^-1 - 2 I) >= 0,
// answers a step of strain of any size with the elastic stress times G(t)/G0, and small strains as
// linear viscoelasticity does. One step, exact where B^-1 is linear in time, for any dt (the
// recursion of Taylor, Pister & Goudreau 1970 and Simo 1987):
//   A' = e A + last B^-1 + next B'^-1,  e = exp(-dt/tau)
//   last = (1 - e) tau/dt - e,  next = 1 - (1 - e) tau/dt
// B'^-1 is relaxed: it makes no stress. So the stress at the end of the step is that of
//   psi = 1/2 (M:B' - tr M) + K/2 (J' - 1)^2,  M = mu [g_inf I + sum g_i (e A + last B^-1)]
// with a positive M known before the step: neo-Hooke with a tensor for mu, and its exact tangent.
// dt = 0 gives the stress at once, dt = infinity the law of statics, g_inf mu.
// For small strains B^-1 is I - 2 dev e and psi = M:e_dev + tr M/3 |e_dev|^2 + K/2 (tr e)^2.
#pragma once

#include "tissue/material/hyperelastic.h"

#include <span>

namespace tissue {

inline constexpr std::size_t kPronyMost = 4;

/// xx, yy, zz, xy, yz, zx of a symmetric tensor.
using Symmetric = std::array<double, 6>;
inline constexpr Symmetric kUnit{1.0, 1.0, 1.0, 0.0, 0.0, 0.0};

/// What all points have in common in one step.
struct PronyStep {
    struct Term {
        double mu_pa; // g_i mu
        double keep, last, next;
    };
    std::array<Term, kPronyMost> term{};
    std::size_t terms = 0;
    double rest_pa = 0.0; // g_inf mu
    double mu_pa = 0.0;   // M at rest
};

/// 0 <= dt_s, infinity too. Throws std::invalid_argument naming the term and the value.
PronyStep prony_step(const Material& material, double dt_s);

/// B^-1. Where det F <= 0 that has no meaning and I serves: what is turned inside out forgets. For
/// B^-1 of a trace above 75 (pressed to a ninth) is scaled to 75, which is relaxed too.
Symmetric relaxed(Law law, const glm::dmat3& F) noexcept;

/// M; `memory`: A of each term, `now` = relaxed(F) before the step.
Symmetric shear_pa(const PronyStep& step, std::span<const Symmetric> memory,
                   const Symmetric& now) noexcept;

/// A' in place of A.
void remember(const PronyStep& step, const Symmetric& before, const Symmetric& after,
              std::span<Symmetric> memory) noexcept;

/// psi as of M, its P = dpsi/dF and dP/dF, as in hyperelastic.h, whose mu is not read here.
double energy_density_jpm3(const Elasticity& e, const Symmetric& M, const glm::dmat3& F) noexcept;
glm::dmat3 piola_stress_pa(const Elasticity& e, const Symmetric& M, const glm::dmat3& F) noexcept;
Tangent piola_tangent_pa(const Elasticity& e, const Symmetric& M, const glm::dmat3& F) noexcept;

/// What could be had back, per rest volume: K/2 (J - 1)^2 + g_inf mu/2 (tr B - 3) + sum psi_i.
/// `at_once` is a step of dt = 0.
double stored_density_jpm3(const Elasticity& e, const PronyStep& at_once,
                           std::span<const Symmetric> memory, const glm::dmat3& F) noexcept;

} // namespace tissue
