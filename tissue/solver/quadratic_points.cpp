// Compiled once for each instruction set; which one runs is decided at the first call.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tissue/solver/quadratic_points.cpp"
#include "tissue/solver/quadratic_points.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include "tissue/solver/quadratic_lanes.h"

#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

#include <algorithm>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace tissue::HWY_NAMESPACE {
namespace {

struct Law {
    D mu, bulk;
};

struct Sums {
    D shape_2j, volume_2j, least;
};

void keep(D v, float* to) noexcept {
    const hn::Rebind<float, Tag<double>> half;
    hn::Store(hn::DemoteTo(half, v), half, to);
}

// P, times the volume, in place of F; the formulas are those of tissue/material/hyperelastic.cpp,
// with a memory those of prony.cpp: M for mu, F M for F where it is not a part of C.
template <bool kMemory>
void stress_at(const Law& law, D volume, int i, D* F, const QuadraticSymmetric* shear_pa,
               QuadraticTangent& tangent, QuadraticShear* shear_tangent, int q,
               Sums& sums) noexcept {
    D C[9], M[6], FM[9];
    if constexpr (kMemory) {
        for (int k = 0; k < 6; ++k)
            M[k] = Shape<double>::load(shear_pa->point[q][k], i);
        times_symmetric(F, M, FM);
    }
    const D* T = kMemory ? FM : F;
    cofactors(F, C);
    const D J = hn::MulAdd(F[0], C[0], hn::MulAdd(F[1], C[1], hn::Mul(F[2], C[2])));
    sums.least = hn::Min(sums.least, J);
    const D some = hn::Max(J, hn::Set(kD, 1e-9)); // below that the answer is not used
    const D I1 = dot9(F, T);
    const D one = hn::Set(kD, 1.0), third = hn::Set(kD, 1.0 / 3.0);
    const D shear = hn::Mul(kMemory ? volume : hn::Mul(law.mu, volume),
                            hn::Exp(kD, hn::Mul(hn::Set(kD, -2.0 / 3.0), hn::Log(kD, some))));
    const D bulk = hn::Mul(law.bulk, volume), away = hn::Sub(J, one);
    const D per_j = hn::Div(third, some); // 1/(3 J)
    const D part = hn::Mul(hn::Mul(shear, I1), per_j);
    const D bend = hn::MulSub(bulk, away, part);
    auto& to = tangent.point[q];
    for (int k = 0; k < 9; ++k) {
        keep(F[k], &to[QuadraticTangent::kF + k][i]);
        keep(C[k], &to[QuadraticTangent::kC + k][i]);
    }
    keep(shear, &to[QuadraticTangent::kShear][i]);
    keep(hn::Mul(hn::Set(kD, -2.0), hn::Mul(shear, per_j)), &to[QuadraticTangent::kMixed][i]);
    keep(hn::MulAdd(hn::Mul(hn::Set(kD, 5.0), part), per_j, bulk),
         &to[QuadraticTangent::kSquare][i]);
    keep(bend, &to[QuadraticTangent::kBend][i]);
    D trace = hn::Set(kD, 3.0), per_trace = hn::Mul(law.mu, volume);
    if constexpr (kMemory) {
        trace = hn::Add(hn::Add(M[0], M[1]), M[2]);
        per_trace = volume;
        for (int k = 0; k < 9; ++k)
            keep(FM[k], &shear_tangent->point[q][QuadraticShear::kFM + k][i]);
        for (int k = 0; k < 6; ++k)
            keep(M[k], &shear_tangent->point[q][QuadraticShear::kM + k][i]);
    }
    const D shape = hn::NegMulAdd(trace, per_trace, hn::Mul(shear, I1));
    sums.shape_2j = hn::Add(sums.shape_2j, shape);
    sums.volume_2j = hn::MulAdd(hn::Mul(bulk, away), away, sums.volume_2j);
    for (int k = 0; k < 9; ++k)
        F[k] = hn::MulAdd(shear, T[k], hn::Mul(bend, C[k]));
}

// dP in place of dF.
template <bool kMemory>
void tangent_at(const QuadraticTangent& tangent, const QuadraticShear* memory, int q, int i,
                V<float>* dF) noexcept {
    using Vec = V<float>;
    using S = Shape<float>;
    const auto& at = tangent.point[q];
    Vec F[9], C[9], dP[9], M[6], FM[9], dFM[9];
    if constexpr (kMemory) {
        for (int k = 0; k < 6; ++k)
            M[k] = S::load(memory->point[q][QuadraticShear::kM + k], i);
        for (int k = 0; k < 9; ++k)
            FM[k] = S::load(memory->point[q][QuadraticShear::kFM + k], i);
        times_symmetric(dF, M, dFM);
    }
    const Vec *T = kMemory ? FM : F, *dT = kMemory ? dFM : dF;
    for (int k = 0; k < 9; ++k) {
        F[k] = S::load(at[QuadraticTangent::kF + k], i);
        C[k] = S::load(at[QuadraticTangent::kC + k], i);
    }
    const Vec shear = S::load(at[QuadraticTangent::kShear], i);
    const Vec mixed = S::load(at[QuadraticTangent::kMixed], i);
    const Vec square = S::load(at[QuadraticTangent::kSquare], i);
    const Vec bend = S::load(at[QuadraticTangent::kBend], i);
    const Vec c = dot9(C, dF), f = dot9(T, dF);
    const Vec of_C = hn::MulAdd(mixed, f, hn::Mul(square, c)), of_F = hn::Mul(mixed, c);
    for (int k = 0; k < 9; ++k)
        dP[k] = hn::MulAdd(shear, dT[k], hn::MulAdd(of_F, T[k], hn::Mul(of_C, C[k])));
    for (int k = 0; k < 3; ++k) {
        const int l = 3 * ((k + 1) % 3), m = 3 * ((k + 2) % 3);
        for (int r = 0; r < 3; ++r) {
            const int s = (r + 1) % 3, t = (r + 2) % 3;
            const Vec first = hn::MulSub(dF[l + s], F[m + t], hn::Mul(dF[l + t], F[m + s]));
            const Vec both =
                hn::MulAdd(F[l + s], dF[m + t], hn::NegMulAdd(F[l + t], dF[m + s], first));
            dP[3 * k + r] = hn::MulAdd(bend, both, dP[3 * k + r]);
        }
    }
    std::copy_n(dP, 9, dF);
}

template <bool kMemory>
void group_stresses(const Law& law, const QuadraticGroup& group, const TetVector<double>& u, int i,
                    const QuadraticSymmetric* shear_pa, TetVector<double>& force,
                    QuadraticTangent& tangent, QuadraticShear* shear_tangent,
                    QuadraticStretch& stretch, Sums& sums) noexcept {
    using S = Shape<double>;
    D base[12], sum[12], mean[9];
    S::base(u, i, base);
    std::fill_n(sum, 12, hn::Zero(kD));
    std::fill_n(mean, 9, hn::Zero(kD));
    for (int q = 0; q < 4; ++q) {
        D F[9];
        const D volume = S::load(group.volume_m3[q], i);
        S::gradient(u, base, group.gradient_1pm[q], q, i, F);
        for (int k = 0; k < 3; ++k)
            F[4 * k] = hn::Add(F[4 * k], hn::Set(kD, 1.0));
        for (int k = 0; k < 9; ++k)
            mean[k] = hn::MulAdd(volume, F[k], mean[k]);
        stress_at<kMemory>(law, volume, i, F, shear_pa, tangent, shear_tangent, q, sums);
        S::add_force(F, group.gradient_1pm[q], q, i, force, sum);
    }
    S::add_base(sum, i, force);
    for (int k = 0; k < 9; ++k)
        keep(mean[k], &stretch.volume_f_m3[k][i]);
}

template <bool kMemory>
PointSums all_stresses(const QuadraticModel& model, const double* moved_m,
                       const QuadraticSymmetric* shear_pa, double* internal_n,
                       QuadraticTangent* tangent, QuadraticShear* shear_tangent,
                       QuadraticStretch* stretch) noexcept {
    const Law law{hn::Set(kD, model.elasticity.mu_pa), hn::Set(kD, model.elasticity.bulk_pa)};
    Sums sums{hn::Zero(kD), hn::Zero(kD), hn::Set(kD, std::numeric_limits<double>::max())};
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
        TetVector<double> u, force{};
        gather(model.groups[g], moved_m, u);
        const std::size_t m = kMemory ? g : 0;
        for (int i = 0; i < kLanes; i += static_cast<int>(hn::Lanes(kD))) {
            group_stresses<kMemory>(law, model.groups[g], u, i, shear_pa + m, force, tangent[g],
                                    shear_tangent + m, stretch[g], sums);
        }
        scatter(model.groups[g], force, internal_n);
    }
    const double shape_j = 0.5 * hn::GetLane(hn::SumOfLanes(kD, sums.shape_2j));
    return {shape_j + 0.5 * hn::GetLane(hn::SumOfLanes(kD, sums.volume_2j)), shape_j,
            hn::GetLane(hn::MinOfLanes(kD, sums.least))};
}

template <bool kMemory>
void product(const QuadraticModel& model, const QuadraticTangent* tangent,
             const QuadraticShear* shear_tangent, float factor, const float* p, float* q) noexcept {
    using S = Shape<float>;
    using Vec = V<float>;
    const Vec times = hn::Set(S::kTag, factor);
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
        const QuadraticGroup& group = model.groups[g];
        TetVector<float> u, force{};
        gather(group, p, u);
        for (int i = 0; i < kLanes; i += static_cast<int>(hn::Lanes(S::kTag))) {
            Vec base[12], sum[12];
            S::base(u, i, base);
            std::fill_n(sum, 12, hn::Zero(S::kTag));
            for (int point = 0; point < 4; ++point) {
                Vec dF[9];
                S::gradient(u, base, group.gradient_single_1pm[point], point, i, dF);
                tangent_at<kMemory>(tangent[g], shear_tangent + (kMemory ? g : 0), point, i, dF);
                for (Vec& v : dF)
                    v = hn::Mul(times, v);
                S::add_force(dF, group.gradient_single_1pm[point], point, i, force, sum);
            }
            S::add_base(sum, i, force);
        }
        scatter(group, force, q);
    }
}

} // namespace

PointSums point_stresses(const QuadraticModel& model, const double* moved_m,
                         std::span<const QuadraticSymmetric> shear_pa, double* internal_n,
                         QuadraticTangent* tangent, QuadraticShear* shear_tangent,
                         QuadraticStretch* stretch) {
    return (shear_pa.empty() ? all_stresses<false>
                             : all_stresses<true>)(model, moved_m, shear_pa.data(), internal_n,
                                                   tangent, shear_tangent, stretch);
}

void tangent_product(const QuadraticModel& model, const QuadraticTangent* tangent,
                     std::span<const QuadraticShear> shear_tangent, float factor, const float* p,
                     float* q) {
    (shear_tangent.empty() ? product<false> : product<true>)(model, tangent, shear_tangent.data(),
                                                             factor, p, q);
}

} // namespace tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tissue {

HWY_EXPORT(point_stresses);
HWY_EXPORT(tangent_product);

PointSums stresses(const QuadraticModel& model, std::span<const double> moved_m,
                   std::span<const QuadraticSymmetric> shear_pa, std::span<double> internal_n,
                   QuadraticTangents& tangents, std::span<QuadraticStretch> stretch) noexcept {
    std::fill(internal_n.begin(), internal_n.end(), 0.0);
    return HWY_DYNAMIC_DISPATCH(point_stresses)(model, moved_m.data(), shear_pa, internal_n.data(),
                                                tangents.elastic.data(), tangents.shear.data(),
                                                stretch.data());
}

void add_tangent_product(const QuadraticModel& model, const QuadraticTangents& tangents,
                         float factor, std::span<const float> p, std::span<float> q) noexcept {
    HWY_DYNAMIC_DISPATCH(tangent_product)
    (model, tangents.elastic.data(), tangents.shear, factor, p.data(), q.data());
}

} // namespace tissue
#endif
