// tissue/solver/quadratic_measures.cpp
// Energy, volume and samples of stress at the points of a quadratic body. Tissue loop.
// Compiled once for each instruction set; which one runs is decided at the first call.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tissue/solver/quadratic_measures.cpp"
#include "tissue/solver/measures_log.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include "tissue/solver/quadratic_lanes.h"

#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

#include <array>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace tissue::HWY_NAMESPACE {
namespace {

struct Sums {
    D stored_j, volume_m3, inverted;
};

D number(double x) noexcept {
    return hn::Set(kD, x);
}

// M at once = g_inf mu I + sum g_i mu A; returns sum g_i mu (3 + ln det A) + 3 g_inf mu, what
// prony.h takes from M:B for the energy.
D shear_now(const PronyStep& prony, const QuadraticSymmetric* memory, int q, int i, D* M) noexcept {
    for (int k = 0; k < 6; ++k)
        M[k] = number(prony.rest_pa * kUnit[k]);
    D away = number(3.0 * prony.rest_pa);
    for (std::size_t t = 0; t < prony.terms; ++t) {
        D A[6];
        const D mu = number(prony.term[t].mu_pa);
        for (int k = 0; k < 6; ++k) {
            A[k] = hn::Load(kD, &memory[t].point[q][k][i]);
            M[k] = hn::MulAdd(mu, A[k], M[k]);
        }
        const D det = A[0] * (A[1] * A[2] - A[4] * A[4]) - A[3] * (A[3] * A[2] - A[4] * A[5]) +
                      A[5] * (A[3] * A[4] - A[1] * A[5]);
        const D log = hn::Log(kD, hn::Max(det, number(1e-100)));
        away = hn::MulAdd(mu, hn::Add(number(3.0), log), away);
    }
    return away;
}

// Square of the von Mises stress of J^-5/3 T F^T
D von_mises2(const D* T, const D* F, D scale) noexcept {
    const auto entry = [&](int r, int s) {
        return T[r] * F[s] + T[3 + r] * F[3 + s] + T[6 + r] * F[6 + s];
    };
    const D xx = entry(0, 0), yy = entry(1, 1), zz = entry(2, 2);
    const D xy = entry(0, 1), yz = entry(1, 2), zx = entry(2, 0);
    const D a = xx - yy, b = yy - zz, c = zz - xx;
    const D normal = a * a + b * b + c * c, shear = xy * xy + yz * yz + zx * zx;
    return (number(0.5) * normal + number(3.0) * shear) * scale * scale;
}

struct Lims {
    D stress2, c, b; // c = exp(2 limit of strain), b = 1/c
};

// As strained() in measures.cpp, the other way round.
hn::Mask<Tag<double>> within(D I1, D I2, D I3, const Lims& at) noexcept {
    const D zero = hn::Zero(kD), two = number(2.0), three = number(3.0);
    const auto p = [&](D x) { return ((x - I1) * x + I2) * x - I3; };
    const auto slope = [&](D x) { return (three * x - two * I1) * x + I2; };
    const auto below = hn::And(hn::And(hn::Gt(p(at.c), zero), hn::Gt(slope(at.c), zero)),
                               hn::Gt(three * at.c, I1));
    const auto above = hn::And(hn::And(hn::Lt(p(at.b), zero), hn::Gt(slope(at.b), zero)),
                               hn::Lt(three * at.b, I1));
    return hn::And(below, above);
}

void sample_at(const QuadraticModel& model, const PronyStep& prony,
               const QuadraticSymmetric* memory, const Lims& limits, D volume, int q, int i,
               const D* F, TissueLog& log, std::size_t first, Sums& sums) noexcept {
    D C[9], M[6], T[9];
    cofactors(F, C);
    const D J = hn::MulAdd(F[0], C[0], hn::MulAdd(F[1], C[1], hn::Mul(F[2], C[2])));
    const D zero = hn::Zero(kD), one = number(1.0);
    const auto good = hn::Gt(J, zero);
    const D away = shear_now(prony, memory, q, i, M);
    times_symmetric(F, M, T);
    const D log_j = hn::Log(kD, hn::IfThenElse(good, J, one));
    const D shape = hn::Exp(kD, hn::Mul(number(-2.0 / 3.0), log_j)); // J^-2/3
    const D dilation = J - one;
    const D density = number(0.5) * (dot9(T, F) * shape - away +
                                     number(model.elasticity.bulk_pa) * dilation * dilation);
    const D stress2 =
        hn::IfThenElseZero(good, von_mises2(T, F, shape * hn::Exp(kD, hn::Neg(log_j))));
    const auto fine = hn::And(hn::And(good, hn::Le(stress2, limits.stress2)),
                              within(dot9(F, F), dot9(C, C), J * J, limits));
    sums.stored_j = hn::MulAdd(volume, hn::IfThenElseZero(good, density), sums.stored_j);
    sums.volume_m3 = hn::MulAdd(volume, J, sums.volume_m3);
    const auto real = hn::Gt(volume, zero);
    sums.inverted = sums.inverted + hn::IfThenElseZero(real, hn::IfThenZeroElse(good, one));

    alignas(64) std::array<double, QuadraticGroup::kLanes> stress, ok;
    hn::Store(hn::Sqrt(stress2), kD, stress.data());
    hn::Store(hn::IfThenElseZero(fine, one), kD, ok.data());
    alignas(64) std::array<double, QuadraticGroup::kLanes> rest;
    hn::Store(volume, kD, rest.data());
    for (std::size_t k = 0; k < hn::Lanes(kD); ++k) {
        log.sample[first + k] = {static_cast<float>(stress[k]), static_cast<float>(rest[k])};
        log.over[first + k] =
            static_cast<std::uint8_t>((log.over[first + k] & 2) | (ok[k] == 0.0 ? 1 : 0));
    }
}

} // namespace

TissueMeasures sample_all(const QuadraticModel& model, const PronyStep& prony,
                          const QuadraticState& state, const DamageLimits& limits, TissueLog& log) {
    const double c = std::exp(2.0 * limits.true_strain);
    const Lims lanes{number(limits.von_mises_pa * limits.von_mises_pa), number(c), number(1.0 / c)};
    Sums sums{hn::Zero(kD), hn::Zero(kD), hn::Zero(kD)};
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
        const QuadraticGroup& group = model.groups[g];
        const QuadraticSymmetric* memory =
            prony.terms > 0 ? &state.memory[(prony.terms + 1) * g] : nullptr;
        TetVector<double> u;
        gather_moved(model, group, state.position_m, u);
        for (int i = 0; i < kLanes; i += static_cast<int>(hn::Lanes(kD))) {
            D base[12], F[9];
            Shape<double>::base(u, i, base);
            for (int q = 0; q < 4; ++q) {
                deformation_at(group, u, base, q, i, F);
                sample_at(model, prony, memory, lanes, hn::Load(kD, &group.volume_m3[q][i]), q, i,
                          F, log, (4 * g + static_cast<std::size_t>(q)) * kLanes + i, sums);
            }
        }
    }
    TissueMeasures m;
    m.stored_j = hn::GetLane(hn::SumOfLanes(kD, sums.stored_j));
    m.volume_m3 = hn::GetLane(hn::SumOfLanes(kD, sums.volume_m3));
    m.inverted = static_cast<int>(hn::GetLane(hn::SumOfLanes(kD, sums.inverted)));
    return m;
}

} // namespace tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tissue {

HWY_EXPORT(sample_all);

TissueMeasures sample_points(const QuadraticModel& model, const QuadraticState& state,
                             const DamageLimits& limits, TissueLog& log) noexcept {
    return HWY_DYNAMIC_DISPATCH(sample_all)(model, prony_step(model.material, 0.0), state, limits,
                                            log);
}

} // namespace tissue
#endif
