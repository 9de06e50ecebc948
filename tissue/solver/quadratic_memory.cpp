// tissue/solver/quadratic_memory.cpp
// What the points of a quadratic body remember, before and after a step. Tissue loop.
// Compiled once for each instruction set; which one runs is decided at the first call.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tissue/solver/quadratic_memory.cpp"
#include "tissue/solver/quadratic_points.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include "tissue/solver/quadratic_lanes.h"

#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace tissue::HWY_NAMESPACE {
namespace {

// B^-1 of relaxed() in prony.cpp
void relaxed_at(const D* F, D* out) noexcept {
    D C[9];
    cofactors(F, C);
    const D J = hn::MulAdd(F[0], C[0], hn::MulAdd(F[1], C[1], hn::Mul(F[2], C[2])));
    const auto positive = hn::Gt(J, hn::Zero(kD));
    const D some = hn::Max(J, hn::Set(kD, 1e-100)),
            size2 = hn::Max(dot9(C, C), hn::Set(kD, 1e-100));
    const D unit = hn::Exp(kD, hn::Mul(hn::Set(kD, -4.0 / 3.0), hn::Log(kD, some)));
    const D scale = hn::Min(unit, hn::Div(hn::Set(kD, 75.0), size2));
    for (int k = 0; k < 6; ++k) {
        const int a = 3 * (k % 3), b = k < 3 ? a : 3 * ((k + 1) % 3);
        const D product =
            hn::MulAdd(C[a], C[b], hn::MulAdd(C[a + 1], C[b + 1], hn::Mul(C[a + 2], C[b + 2])));
        out[k] = hn::IfThenElse(positive, hn::Mul(scale, product), hn::Set(kD, kUnit[k]));
    }
}

// A' of all terms and B'^-1 in place of A and B^-1, sixteen lanes at a time.
void remember_at(const PronyStep& prony, int q, int i, const D* now,
                 QuadraticSymmetric* memory) noexcept {
    for (int k = 0; k < 6; ++k) {
        double* before = &memory[prony.terms].point[q][k][i];
        for (std::size_t t = 0; t < prony.terms; ++t) {
            const PronyStep::Term& term = prony.term[t];
            double* A = &memory[t].point[q][k][i];
            const D left = hn::MulAdd(hn::Set(kD, term.keep), hn::Load(kD, A),
                                      hn::Mul(hn::Set(kD, term.last), hn::Load(kD, before)));
            hn::Store(hn::MulAdd(hn::Set(kD, term.next), now[k], left), kD, A);
        }
        hn::Store(now[k], kD, before);
    }
}

} // namespace

void remember_all(const QuadraticModel& model, const PronyStep& prony, QuadraticState& state) {
    using S = Shape<double>;
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
        TetVector<double> u;
        gather_moved(model, model.groups[g], state.position_m, u);
        for (int i = 0; i < kLanes; i += static_cast<int>(hn::Lanes(kD))) {
            D base[12], F[9], now[6];
            S::base(u, i, base);
            for (int q = 0; q < 4; ++q) {
                deformation_at(model.groups[g], u, base, q, i, F);
                relaxed_at(F, now);
                remember_at(prony, q, i, now, &state.memory[(prony.terms + 1) * g]);
            }
        }
    }
}

} // namespace tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tissue {

HWY_EXPORT(remember_all);

void begin_memory(const QuadraticModel& model, const QuadraticState& state,
                  QuadraticSystem& s) noexcept {
    const PronyStep& prony = s.prony;
    for (std::size_t g = 0; prony.terms > 0 && g < model.groups.size(); ++g) {
        const QuadraticSymmetric* memory = &state.memory[(prony.terms + 1) * g];
        for (std::size_t q = 0; q < 4; ++q) {
            for (std::size_t k = 0; k < 6; ++k) {
                auto& M = s.shear_pa[g].point[q][k];
                const auto& before = memory[prony.terms].point[q][k];
                M.fill(prony.rest_pa * kUnit[k]);
                for (std::size_t t = 0; t < prony.terms; ++t) {
                    const PronyStep::Term& term = prony.term[t];
                    const auto& A = memory[t].point[q][k];
                    for (std::size_t i = 0; i < M.size(); ++i)
                        M[i] += term.mu_pa * (term.keep * A[i] + term.last * before[i]);
                }
            }
        }
    }
}

void end_memory(const QuadraticModel& model, const QuadraticSystem& system,
                QuadraticState& state) noexcept {
    if (system.prony.terms > 0)
        HWY_DYNAMIC_DISPATCH(remember_all)(model, system.prony, state);
}

} // namespace tissue
#endif
