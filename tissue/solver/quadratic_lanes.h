// tissue/solver/quadratic_lanes.h
// From nodes to deformation gradients at the points of sixteen tets and back, in lanes. Included by
// the parts of the quadratic solver that are compiled once for each instruction set, internal.
#if defined(TISSUE_SOLVER_QUADRATIC_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TISSUE_SOLVER_QUADRATIC_LANES_H
#undef TISSUE_SOLVER_QUADRATIC_LANES_H
#else
#define TISSUE_SOLVER_QUADRATIC_LANES_H
#endif

#include "tissue/solver/quadratic.h"

#include <hwy/highway.h>

#include <algorithm>

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

// Displacements of the tets of a group, from places; those of the sink are 0.
[[maybe_unused]] void gather_moved(const QuadraticModel& model, const QuadraticGroup& group,
                                   const std::vector<glm::dvec3>& position_m,
                                   TetVector<double>& to) noexcept {
    for (int a = 0; a < 10; ++a) {
        for (int k = 0; k < kLanes; ++k) {
            const auto node = static_cast<std::size_t>(group.node[a][k] / 4);
            const glm::dvec3 u = node < position_m.size()
                                     ? position_m[node] - model.mesh.rest_m[node]
                                     : glm::dvec3{0.0};
            for (int c = 0; c < 3; ++c)
                to.at[3 * a + c][k] = u[c];
        }
    }
}

// F at point q, from displacements and their Shape::base().
[[maybe_unused]] void deformation_at(const QuadraticGroup& group, const TetVector<double>& u,
                                     const D* base, int q, int i, D* F) noexcept {
    Shape<double>::gradient(u, base, group.gradient_1pm[q], q, i, F);
    for (int k = 0; k < 3; ++k)
        F[4 * k] = hn::Add(F[4 * k], hn::Set(kD, 1.0));
}

// T = F M, M a symmetric tensor: xx, yy, zz, xy, yz, zx
template <typename Vec> void times_symmetric(const Vec* F, const Vec* M, Vec* T) noexcept {
    constexpr int kPlace[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    for (int k = 0; k < 3; ++k) {
        for (int r = 0; r < 3; ++r) {
            T[3 * k + r] =
                hn::MulAdd(F[6 + r], M[kPlace[2][k]],
                           hn::MulAdd(F[3 + r], M[kPlace[1][k]], hn::Mul(F[r], M[kPlace[0][k]])));
        }
    }
}

} // namespace
} // namespace tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
