// Compiled once for each instruction set; which one runs is decided at the first call.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tissue/solver/quadratic_points.cpp"
#include "tissue/solver/quadratic_points.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

#include <algorithm>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace tissue::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
constexpr int kLanes = QuadraticGroup::kLanes;
template <typename T> using Lanes = QuadraticGroup::Lanes<T>;
template <typename T> using Tag = hn::CappedTag<T, kLanes>;
template <typename T> using V = hn::Vec<Tag<T>>;
template <typename T> struct alignas(64) TetVector {
    std::array<Lanes<T>, 30> at; // 3 node + component
};

// Edge node between corners.
constexpr std::array<std::array<int, 4>, 4> kBetween{
    {{-1, 4, 6, 7}, {4, -1, 5, 8}, {6, 5, -1, 9}, {7, 8, 9, -1}}};
// Coordinates of the four points (Hammer, Marlowe & Stroud 1956): own corner, other corners.
constexpr double kNear = 0.5854101966249685, kFar = 0.1381966011250105;
constexpr double kCornerBase = 4 * kFar - 1, kEdgeBase = 4 * kFar, kOwn = 4 * (kNear - kFar);

template <typename T>
void gather(const QuadraticGroup& group, const T* from, TetVector<T>& to) noexcept {
    for (int a = 0; a < 10; ++a) {
        for (int k = 0; k < kLanes; ++k) {
            const T* v = from + group.node[a][k];
            to.at[3 * a][k] = v[0];
            to.at[3 * a + 1][k] = v[1];
            to.at[3 * a + 2][k] = v[2];
        }
    }
}

template <typename T>
void scatter(const QuadraticGroup& group, const TetVector<T>& from, T* to) noexcept {
    for (int a = 0; a < 10; ++a) {
        for (int k = 0; k < kLanes; ++k) {
            T* v = to + group.node[a][k];
            v[0] += from.at[3 * a][k];
            v[1] += from.at[3 * a + 1][k];
            v[2] += from.at[3 * a + 2][k];
        }
    }
}

// Nodes to gradients at the points, and forces at the points back to nodes. Along coordinate c,
// d/dL_c of the shape functions is 4 L_c - 1 at corner c and 4 L_d on its edges to corners d: the
// same at the four points but for kOwn times one node of each c.
template <typename T> struct Shape {
    using Vec = V<T>;
    static constexpr Tag<T> kTag{};

    static Vec load(const Lanes<T>& from, int i) noexcept { return hn::Load(kTag, &from[i]); }

    // base[3 c + r] = the part of du_r/dL_c that all points share
    static void base(const TetVector<T>& u, int i, Vec* base) noexcept {
        const Vec corner = hn::Set(kTag, T(kCornerBase)), edge = hn::Set(kTag, T(kEdgeBase));
        for (int c = 0; c < 4; ++c) {
            const int d = (c + 1) & 3, e = (c + 2) & 3, f = (c + 3) & 3;
            for (int r = 0; r < 3; ++r) {
                const Vec edges = hn::Add(hn::Add(load(u.at[3 * kBetween[c][d] + r], i),
                                                  load(u.at[3 * kBetween[c][e] + r], i)),
                                          load(u.at[3 * kBetween[c][f] + r], i));
                base[3 * c + r] =
                    hn::MulAdd(edge, edges, hn::Mul(corner, load(u.at[3 * c + r], i)));
            }
        }
    }

    // grad[3 k + r] = du_r/dX_k at point q
    static void gradient(const TetVector<T>& u, const Vec* base,
                         const std::array<Lanes<T>, 9>& inverse, int q, int i, Vec* grad) noexcept {
        const Vec own = hn::Set(kTag, T(kOwn));
        for (int r = 0; r < 3; ++r) {
            Vec h[4];
            for (int c = 0; c < 4; ++c) {
                const int node = c == q ? c : kBetween[c][q];
                h[c] = hn::MulAdd(own, load(u.at[3 * node + r], i), base[3 * c + r]);
            }
            const Vec h1 = hn::Sub(h[1], h[0]), h2 = hn::Sub(h[2], h[0]), h3 = hn::Sub(h[3], h[0]);
            for (int k = 0; k < 3; ++k) {
                grad[3 * k + r] = hn::MulAdd(
                    h3, load(inverse[6 + k], i),
                    hn::MulAdd(h2, load(inverse[3 + k], i), hn::Mul(h1, load(inverse[k], i))));
            }
        }
    }

    // Adds P at point q to the nodes and to base[3 c + r], the sums over the points.
    static void add_force(const Vec* P, const std::array<Lanes<T>, 9>& inverse, int q, int i,
                          TetVector<T>& force, Vec* base) noexcept {
        const Vec own = hn::Set(kTag, T(kOwn));
        for (int r = 0; r < 3; ++r) {
            Vec t[4];
            for (int c = 1; c < 4; ++c) {
                t[c] = hn::MulAdd(P[6 + r], load(inverse[3 * c - 1], i),
                                  hn::MulAdd(P[3 + r], load(inverse[3 * c - 2], i),
                                             hn::Mul(P[r], load(inverse[3 * c - 3], i))));
            }
            t[0] = hn::Neg(hn::Add(hn::Add(t[1], t[2]), t[3]));
            for (int c = 0; c < 4; ++c) {
                T* to = &force.at[3 * (c == q ? c : kBetween[c][q]) + r][i];
                hn::Store(hn::MulAdd(own, t[c], hn::Load(kTag, to)), kTag, to);
                base[3 * c + r] = hn::Add(base[3 * c + r], t[c]);
            }
        }
    }

    static void add_base(const Vec* base, int i, TetVector<T>& force) noexcept {
        const Vec corner = hn::Set(kTag, T(kCornerBase)), edge = hn::Set(kTag, T(kEdgeBase));
        for (int c = 0; c < 4; ++c) {
            for (int r = 0; r < 3; ++r) {
                T* to = &force.at[3 * c + r][i];
                hn::Store(hn::MulAdd(corner, base[3 * c + r], hn::Load(kTag, to)), kTag, to);
                for (int d = 0; d < c; ++d) {
                    T* at = &force.at[3 * kBetween[c][d] + r][i];
                    const Vec both = hn::Add(base[3 * c + r], base[3 * d + r]);
                    hn::Store(hn::MulAdd(edge, both, hn::Load(kTag, at)), kTag, at);
                }
            }
        }
    }
};

template <typename Vec> Vec dot9(const Vec* a, const Vec* b) noexcept {
    Vec even = hn::Mul(a[0], b[0]), odd = hn::Mul(a[1], b[1]);
    for (int k = 2; k < 8; k += 2) {
        even = hn::MulAdd(a[k], b[k], even);
        odd = hn::MulAdd(a[k + 1], b[k + 1], odd);
    }
    return hn::Add(hn::MulAdd(a[8], b[8], even), odd);
}

// C = dJ/dF: column k is column l times column m for cyclic k, l, m.
template <typename Vec> void cofactors(const Vec* F, Vec* C) noexcept {
    for (int k = 0; k < 3; ++k) {
        const int l = 3 * ((k + 1) % 3), m = 3 * ((k + 2) % 3);
        for (int r = 0; r < 3; ++r) {
            const int s = (r + 1) % 3, q = (r + 2) % 3;
            C[3 * k + r] = hn::MulSub(F[l + s], F[m + q], hn::Mul(F[l + q], F[m + s]));
        }
    }
}

using D = V<double>;
constexpr Tag<double> kD{};

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

// P, times the volume, in place of F; the formulas are those of tissue/material/hyperelastic.cpp.
void stress_at(const Law& law, D volume, int i, D* F, QuadraticTangent& tangent, int q,
               Sums& sums) noexcept {
    D C[9];
    cofactors(F, C);
    const D J = hn::MulAdd(F[0], C[0], hn::MulAdd(F[1], C[1], hn::Mul(F[2], C[2])));
    sums.least = hn::Min(sums.least, J);
    const D some = hn::Max(J, hn::Set(kD, 1e-9)); // below that the answer is not used
    const D I1 = dot9(F, F);
    const D one = hn::Set(kD, 1.0), third = hn::Set(kD, 1.0 / 3.0);
    const D shear = hn::Mul(hn::Mul(law.mu, volume),
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
    const D shape = hn::NegMulAdd(hn::Set(kD, 3.0), hn::Mul(law.mu, volume), hn::Mul(shear, I1));
    sums.shape_2j = hn::Add(sums.shape_2j, shape);
    sums.volume_2j = hn::MulAdd(hn::Mul(bulk, away), away, sums.volume_2j);
    for (int k = 0; k < 9; ++k)
        F[k] = hn::MulAdd(shear, F[k], hn::Mul(bend, C[k]));
}

// dP in place of dF.
void tangent_at(const QuadraticTangent& tangent, int q, int i, V<float>* dF) noexcept {
    using Vec = V<float>;
    using S = Shape<float>;
    const auto& at = tangent.point[q];
    Vec F[9], C[9], dP[9];
    for (int k = 0; k < 9; ++k) {
        F[k] = S::load(at[QuadraticTangent::kF + k], i);
        C[k] = S::load(at[QuadraticTangent::kC + k], i);
    }
    const Vec shear = S::load(at[QuadraticTangent::kShear], i);
    const Vec mixed = S::load(at[QuadraticTangent::kMixed], i);
    const Vec square = S::load(at[QuadraticTangent::kSquare], i);
    const Vec bend = S::load(at[QuadraticTangent::kBend], i);
    const Vec c = dot9(C, dF), f = dot9(F, dF);
    const Vec of_C = hn::MulAdd(mixed, f, hn::Mul(square, c)), of_F = hn::Mul(mixed, c);
    for (int k = 0; k < 9; ++k)
        dP[k] = hn::MulAdd(shear, dF[k], hn::MulAdd(of_F, F[k], hn::Mul(of_C, C[k])));
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

void group_stresses(const Law& law, const QuadraticGroup& group, const TetVector<double>& u, int i,
                    TetVector<double>& force, QuadraticTangent& tangent, QuadraticStretch& stretch,
                    Sums& sums) noexcept {
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
        stress_at(law, volume, i, F, tangent, q, sums);
        S::add_force(F, group.gradient_1pm[q], q, i, force, sum);
    }
    S::add_base(sum, i, force);
    for (int k = 0; k < 9; ++k)
        keep(mean[k], &stretch.volume_f_m3[k][i]);
}

} // namespace

PointSums point_stresses(const QuadraticModel& model, const double* moved_m, double* internal_n,
                         QuadraticTangent* tangent, QuadraticStretch* stretch) {
    const Law law{hn::Set(kD, model.elasticity.mu_pa), hn::Set(kD, model.elasticity.bulk_pa)};
    Sums sums{hn::Zero(kD), hn::Zero(kD), hn::Set(kD, std::numeric_limits<double>::max())};
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
        TetVector<double> u, force{};
        gather(model.groups[g], moved_m, u);
        for (int i = 0; i < kLanes; i += static_cast<int>(hn::Lanes(kD)))
            group_stresses(law, model.groups[g], u, i, force, tangent[g], stretch[g], sums);
        scatter(model.groups[g], force, internal_n);
    }
    const double shape_j = 0.5 * hn::GetLane(hn::SumOfLanes(kD, sums.shape_2j));
    return {shape_j + 0.5 * hn::GetLane(hn::SumOfLanes(kD, sums.volume_2j)), shape_j,
            hn::GetLane(hn::MinOfLanes(kD, sums.least))};
}

void tangent_product(const QuadraticModel& model, const QuadraticTangent* tangent, float factor,
                     const float* p, float* q) {
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
                tangent_at(tangent[g], point, i, dF);
                for (Vec& v : dF)
                    v = hn::Mul(times, v);
                S::add_force(dF, group.gradient_single_1pm[point], point, i, force, sum);
            }
            S::add_base(sum, i, force);
        }
        scatter(group, force, q);
    }
}

} // namespace tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tissue {

HWY_EXPORT(point_stresses);
HWY_EXPORT(tangent_product);

PointSums stresses(const QuadraticModel& model, std::span<const double> moved_m,
                   std::span<double> internal_n, std::span<QuadraticTangent> tangent,
                   std::span<QuadraticStretch> stretch) noexcept {
    std::fill(internal_n.begin(), internal_n.end(), 0.0);
    return HWY_DYNAMIC_DISPATCH(point_stresses)(model, moved_m.data(), internal_n.data(),
                                                tangent.data(), stretch.data());
}

void add_tangent_product(const QuadraticModel& model, std::span<const QuadraticTangent> tangent,
                         float factor, std::span<const float> p, std::span<float> q) noexcept {
    HWY_DYNAMIC_DISPATCH(tangent_product)(model, tangent.data(), factor, p.data(), q.data());
}

} // namespace tissue
#endif
