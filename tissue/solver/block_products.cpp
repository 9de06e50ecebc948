// Compiled once for each instruction set; which one runs is decided at the first call.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tissue/solver/block_products.cpp"
#include "tissue/solver/block_products.h"

#include <hwy/foreach_target.h> // must come before highway.h

#include <hwy/highway.h>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace tissue::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
constexpr int kLanes = SingleFactor::kLanes;
constexpr hn::CappedTag<float, kLanes> kTag;
using V = hn::Vec<hn::CappedTag<float, kLanes>>;

// The quadrature of tissue/solver/quadratic_points.cpp, see there; lanes are columns here.
constexpr std::array<std::array<int, 4>, 4> kBetween{
    {{-1, 4, 6, 7}, {4, -1, 5, 8}, {6, 5, -1, 9}, {7, 8, 9, -1}}};
constexpr float kNear = 0.5854101966249685f, kFar = 0.1381966011250105f;
constexpr float kCornerBase = 4 * kFar - 1, kEdgeBase = 4 * kFar, kOwn = 4 * (kNear - kFar);

// A number of one tet on all columns.
V all(float value) noexcept {
    return hn::Set(kTag, value);
}

struct Tet {
    const QuadraticGroup& group;
    const QuadraticTangent& tangent;
    const QuadraticShear* memory; // null: elastic
    int lane;
    float factor;

    V inverse(int q, int k) const noexcept { return all(group.gradient_single_1pm[q][k][lane]); }
    V at(int q, int k) const noexcept { return all(tangent.point[q][k][lane]); }
    V remembered(int q, int k) const noexcept { return all(memory->point[q][k][lane]); }
    V scaled(int q, int k) const noexcept { return all(factor * tangent.point[q][k][lane]); }
};

// a : b, a(k) a number of the tet.
template <typename Entry> HWY_INLINE V dot9(const Entry& a, const V* b) noexcept {
    V s0 = hn::Mul(a(0), b[0]), s1 = hn::Mul(a(1), b[1]), s2 = hn::Mul(a(2), b[2]);
    for (int k = 3; k < 9; k += 3) {
        s0 = hn::MulAdd(a(k), b[k], s0);
        s1 = hn::MulAdd(a(k + 1), b[k + 1], s1);
        s2 = hn::MulAdd(a(k + 2), b[k + 2], s2);
    }
    return hn::Add(hn::Add(s0, s1), s2);
}

// dF M, M in the order of Symmetric.
HWY_INLINE void times_memory(const Tet& tet, int q, const V* dF, V* out) noexcept {
    constexpr std::array<std::array<int, 3>, 3> kPlace{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};
    for (int k = 0; k < 3; ++k) {
        const auto M = [&](int row) {
            return tet.remembered(q, QuadraticShear::kM + kPlace[row][k]);
        };
        for (int r = 0; r < 3; ++r) {
            out[3 * k + r] =
                hn::MulAdd(dF[6 + r], M(2), hn::MulAdd(dF[3 + r], M(1), hn::Mul(dF[r], M(0))));
        }
    }
}

// dP from dF = grad[3 k + r]; C is linear in F, so dC is what each of two columns adds.
// With a memory, F M is for F where it is not a part of C, as in quadratic_points.cpp.
template <bool kMemory> HWY_INLINE void stress(const Tet& tet, int q, const V* dF, V* dP) noexcept {
    constexpr int kF = QuadraticTangent::kF, kC = QuadraticTangent::kC;
    const auto C = [&](int k) { return tet.at(q, kC + k); };
    const auto T = [&](int k) {
        if constexpr (kMemory)
            return tet.remembered(q, QuadraticShear::kFM + k);
        else
            return tet.at(q, kF + k);
    };
    V dFM[9];
    if constexpr (kMemory)
        times_memory(tet, q, dF, dFM);
    const V* dT = kMemory ? dFM : dF;
    const V c = dot9(C, dF), f = dot9(T, dF);
    const V mixed = tet.scaled(q, QuadraticTangent::kMixed);
    const V of_C = hn::MulAdd(mixed, f, hn::Mul(tet.scaled(q, QuadraticTangent::kSquare), c));
    const V of_F = hn::Mul(mixed, c);
    const V shear = tet.scaled(q, QuadraticTangent::kShear);
    V bent[9];
    for (int k = 0; k < 9; ++k)
        bent[k] = hn::Mul(tet.scaled(q, QuadraticTangent::kBend), dF[k]);
    for (int k = 0; k < 3; ++k) {
        const int l = 3 * ((k + 1) % 3), m = 3 * ((k + 2) % 3);
        for (int r = 0; r < 3; ++r) {
            const int s = (r + 1) % 3, t = (r + 2) % 3, i = 3 * k + r;
            V sum = hn::MulAdd(shear, dT[i], hn::Mul(of_F, T(i)));
            sum = hn::MulAdd(of_C, C(i), sum);
            V turn = hn::MulAdd(bent[l + s], tet.at(q, kF + m + t),
                                hn::Mul(bent[m + t], tet.at(q, kF + l + s)));
            turn = hn::NegMulAdd(bent[l + t], tet.at(q, kF + m + s), turn);
            turn = hn::NegMulAdd(bent[m + s], tet.at(q, kF + l + t), turn);
            dP[i] = hn::Add(sum, turn);
        }
    }
}

struct Nodes {
    const float* from[10]; // three lines each
    float* to[10];
};

// One tet, columns [i, i + Lanes).
template <bool kMemory> void add_tet(const Tet& tet, const Nodes& nodes, int i) noexcept {
    const auto load = [&](int node, int r) {
        return hn::Load(kTag, nodes.from[node] + kLanes * r + i);
    };
    V base[12], sum[12], force[30];
    for (int c = 0; c < 4; ++c) {
        const int d = (c + 1) & 3, e = (c + 2) & 3, f = (c + 3) & 3;
        for (int r = 0; r < 3; ++r) {
            const V edges = hn::Add(hn::Add(load(kBetween[c][d], r), load(kBetween[c][e], r)),
                                    load(kBetween[c][f], r));
            base[3 * c + r] =
                hn::MulAdd(all(kEdgeBase), edges, hn::Mul(all(kCornerBase), load(c, r)));
            sum[3 * c + r] = hn::Zero(kTag);
        }
    }
    std::fill_n(force, 30, hn::Zero(kTag));
    for (int q = 0; q < 4; ++q) {
        V dF[9], dP[9];
        for (int r = 0; r < 3; ++r) {
            V h[4];
            for (int c = 0; c < 4; ++c)
                h[c] = hn::MulAdd(all(kOwn), load(c == q ? c : kBetween[c][q], r), base[3 * c + r]);
            for (int c = 1; c < 4; ++c)
                h[c] = hn::Sub(h[c], h[0]);
            for (int k = 0; k < 3; ++k)
                dF[3 * k + r] = hn::MulAdd(
                    h[3], tet.inverse(q, 6 + k),
                    hn::MulAdd(h[2], tet.inverse(q, 3 + k), hn::Mul(h[1], tet.inverse(q, k))));
        }
        stress<kMemory>(tet, q, dF, dP);
        for (int r = 0; r < 3; ++r) {
            V t[4];
            for (int c = 1; c < 4; ++c)
                t[c] = hn::MulAdd(dP[6 + r], tet.inverse(q, 3 * c - 1),
                                  hn::MulAdd(dP[3 + r], tet.inverse(q, 3 * c - 2),
                                             hn::Mul(dP[r], tet.inverse(q, 3 * c - 3))));
            t[0] = hn::Neg(hn::Add(hn::Add(t[1], t[2]), t[3]));
            for (int c = 0; c < 4; ++c) {
                V& to = force[3 * (c == q ? c : kBetween[c][q]) + r];
                to = hn::MulAdd(all(kOwn), t[c], to);
                sum[3 * c + r] = hn::Add(sum[3 * c + r], t[c]);
            }
        }
    }
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 3; ++r) {
            force[3 * c + r] = hn::MulAdd(all(kCornerBase), sum[3 * c + r], force[3 * c + r]);
            for (int d = 0; d < c; ++d) {
                V& to = force[3 * kBetween[c][d] + r];
                to = hn::MulAdd(all(kEdgeBase), hn::Add(sum[3 * c + r], sum[3 * d + r]), to);
            }
        }
    }
    for (int a = 0; a < 10; ++a) {
        for (int r = 0; r < 3; ++r) {
            float* to = nodes.to[a] + kLanes * r + i;
            hn::Store(hn::Add(hn::Load(kTag, to), force[3 * a + r]), kTag, to);
        }
    }
}

// Three lines of a node at a time: neighbours in order, each times what they have in common.
template <typename T, typename Line>
void product(const QuadraticModel& model, const T* S, const Line* x, Line* y,
             int columns) noexcept {
    constexpr hn::CappedTag<T, kLanes> kLine;
    const int step = static_cast<int>(hn::Lanes(kLine));
    for (std::size_t i = 0; i + 1 < model.mass_start.size(); ++i) {
        for (int c = 0; c < columns; c += step) {
            auto s0 = hn::Zero(kLine), s1 = s0, s2 = s0;
            for (std::int32_t k = model.mass_start[i]; k < model.mass_start[i + 1]; ++k) {
                const auto both = hn::Set(kLine, S[k]);
                const Line* from = x + model.mass_column[k] / 4 * 3; // column: 4 times its node
                s0 = hn::MulAdd(both, hn::Load(kLine, &from[0].lane[c]), s0);
                s1 = hn::MulAdd(both, hn::Load(kLine, &from[1].lane[c]), s1);
                s2 = hn::MulAdd(both, hn::Load(kLine, &from[2].lane[c]), s2);
            }
            hn::Store(s0, kLine, &y[3 * i].lane[c]);
            hn::Store(s1, kLine, &y[3 * i + 1].lane[c]);
            hn::Store(s2, kLine, &y[3 * i + 2].lane[c]);
        }
    }
}

} // namespace

void tangent_columns(const QuadraticModel& model, const QuadraticTangents& tangents, float factor,
                     const ColumnLine* p, ColumnLine* q, int columns) {
    const bool memory = !tangents.shear.empty();
    const int step = static_cast<int>(hn::Lanes(kTag));
    for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
        const Tet tet{model.groups[e / kLanes], tangents.elastic[e / kLanes],
                      memory ? &tangents.shear[e / kLanes] : nullptr, static_cast<int>(e % kLanes),
                      factor};
        Nodes nodes;
        for (int a = 0; a < 10; ++a) {
            const std::int32_t at = tet.group.node[a][tet.lane] / 4 * 3;
            nodes.from[a] = p[at].lane.data();
            nodes.to[a] = q[at].lane.data();
        }
        for (int i = 0; i < columns; i += step) {
            if (memory)
                add_tet<true>(tet, nodes, i);
            else
                add_tet<false>(tet, nodes, i);
        }
    }
}

void scalar_columns_single(const QuadraticModel& model, const float* S, const ColumnLine* x,
                           ColumnLine* y, int columns) {
    product(model, S, x, y, columns);
}
void scalar_columns_double(const QuadraticModel& model, const double* S, const DoubleLine* x,
                           DoubleLine* y) {
    product(model, S, x, y, kLanes);
}

} // namespace tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tissue {

HWY_EXPORT(tangent_columns);
HWY_EXPORT(scalar_columns_single);
HWY_EXPORT(scalar_columns_double);

void add_tangent_product(const QuadraticModel& model, const QuadraticTangents& tangents,
                         float factor, std::span<const ColumnLine> p, std::span<ColumnLine> q,
                         int columns) noexcept {
    HWY_DYNAMIC_DISPATCH(tangent_columns)(model, tangents, factor, p.data(), q.data(), columns);
}

void scalar_product(const QuadraticModel& model, std::span<const float> S,
                    std::span<const ColumnLine> p, std::span<ColumnLine> q, int columns) noexcept {
    HWY_DYNAMIC_DISPATCH(scalar_columns_single)(model, S.data(), p.data(), q.data(), columns);
}

void scalar_product(const QuadraticModel& model, std::span<const double> S,
                    std::span<const DoubleLine> p, std::span<DoubleLine> q) noexcept {
    HWY_DYNAMIC_DISPATCH(scalar_columns_double)(model, S.data(), p.data(), q.data());
}

} // namespace tissue
#endif
