// See the header.
#include "tissue/solver/quadratic_refactor.h"

#include "tissue/reference/tet10.h"

#include <algorithm>
#include <cmath>
#include <system_error>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

// What of a point's tangent a pair of nodes sees, see QuadraticTangent: for u at a and v at b
//   u.K v = shear u.v a.Mb + mixed (u.Ca v.Tb + u.Ta v.Cb) + square u.Ca v.Cb + bend F(a x b).(u x
//   v)
// T = F, M = 1; with a memory T = F M.
struct Point {
    dmat3 F, C, T, M{1.0};
    double shear, mixed, square, bend;
};

Point point_of(const QuadraticTangents& tangents, std::size_t group, std::size_t q,
               std::size_t lane) noexcept {
    const auto& at = tangents.elastic[group].point[q];
    Point p;
    for (int k = 0; k < 9; ++k) {
        p.F[k / 3][k % 3] = at[QuadraticTangent::kF + k][lane];
        p.C[k / 3][k % 3] = at[QuadraticTangent::kC + k][lane];
    }
    p.T = p.F;
    p.shear = at[QuadraticTangent::kShear][lane];
    p.mixed = at[QuadraticTangent::kMixed][lane];
    p.square = at[QuadraticTangent::kSquare][lane];
    p.bend = at[QuadraticTangent::kBend][lane];
    if (tangents.shear.empty())
        return p;
    const auto& memory = tangents.shear[group].point[q];
    constexpr std::array<std::array<int, 3>, 3> kPlace{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};
    for (int k = 0; k < 9; ++k) {
        p.T[k / 3][k % 3] = memory[QuadraticShear::kFM + k][lane];
        p.M[k / 3][k % 3] = memory[QuadraticShear::kM + kPlace[k / 3][k % 3]][lane];
    }
    return p;
}

// Gradients of the ten shape functions at point q of a tet, rest frame.
std::array<dvec3, 10> gradients_at(const QuadraticGroup& group, std::size_t q,
                                   std::size_t lane) noexcept {
    std::array<dvec3, 4> barycentric;
    barycentric[0] = dvec3{0.0};
    for (int c = 0; c < 3; ++c) {
        for (int k = 0; k < 3; ++k)
            barycentric[c + 1][k] = group.gradient_1pm[q][3 * c + k][lane];
        barycentric[0] -= barycentric[c + 1];
    }
    const Barycentric& L = kFourPoints[q].at;
    std::array<dvec3, 10> g;
    for (std::size_t a = 0; a < 4; ++a)
        g[a] = (4.0 * L[a] - 1.0) * barycentric[a];
    for (std::size_t e = 0; e < kEdge.size(); ++e) {
        const auto [a, b] = kEdge[e];
        g[4 + e] = 4.0 * (L[a] * barycentric[b] + L[b] * barycentric[a]);
    }
    return g;
}

struct Seen {
    std::array<dvec3, 10> gradient, C, T, M; // of each node: g, C g, T g, M g
};

dmat3 block_of(const Point& p, const Seen& s, std::size_t a, std::size_t b) noexcept {
    dmat3 K = dmat3{p.shear * glm::dot(s.gradient[a], s.M[b])};
    K += glm::outerProduct(p.mixed * s.C[a], s.T[b]) +
         glm::outerProduct(p.mixed * s.T[a] + p.square * s.C[a], s.C[b]);
    const dvec3 w = p.bend * (p.F * glm::cross(s.gradient[a], s.gradient[b]));
    // u.(v x w): column k is e_k x w
    K[0] += dvec3{0.0, -w.z, w.y};
    K[1] += dvec3{w.z, 0.0, -w.x};
    K[2] += dvec3{-w.y, w.x, 0.0};
    return K;
}

void add_tet(const QuadraticModel& model, const QuadraticTangents& tangents, std::size_t tet,
             double factor, double geometric, std::span<double> matrix) noexcept {
    constexpr std::size_t kLanes = QuadraticGroup::kLanes;
    const std::size_t group = tet / kLanes, lane = tet % kLanes;
    std::array<dmat3, 55> block;
    block.fill(dmat3{0.0});
    for (std::size_t q = 0; q < 4; ++q) {
        Point p = point_of(tangents, group, q, lane);
        p.bend *= geometric;
        Seen s{gradients_at(model.groups[group], q, lane), {}, {}, {}};
        for (std::size_t a = 0; a < 10; ++a) {
            s.C[a] = p.C * s.gradient[a];
            s.T[a] = p.T * s.gradient[a];
            s.M[a] = p.M * s.gradient[a];
        }
        std::size_t k = 0;
        for (std::size_t a = 0; a < 10; ++a) {
            for (std::size_t b = 0; b <= a; ++b, ++k)
                block[k] += block_of(p, s, a, b);
        }
    }
    std::size_t k = 0;
    for (std::size_t a = 0; a < 10; ++a) {
        for (std::size_t b = 0; b <= a; ++b, ++k) {
            const auto& place = model.block_place[tet][k];
            if (place[0] < 0)
                continue;
            const bool same = a == b;
            const bool later =
                model.dof[model.mesh.tets[tet][a]] > model.dof[model.mesh.tets[tet][b]];
            const dmat3 K = factor * (same || later ? block[k] : glm::transpose(block[k]));
            for (int c = 0; c < 3; ++c) {
                for (int r = same ? c : 0; r < 3; ++r)
                    matrix[static_cast<std::size_t>(place[c] + (same ? r - c : r))] += K[c][r];
            }
        }
    }
}

bool make_factor(const QuadraticModel& model, std::span<const double> fixed_matrix,
                 double stiffness, Refactoring& job) {
    for (const double geometric : {1.0, 0.5, 0.0}) {
        job.matrix.assign(fixed_matrix.begin(), fixed_matrix.end());
        for (std::size_t e = 0; e < model.mesh.tets.size(); ++e)
            add_tet(model, job.tangent, e, stiffness, geometric, job.matrix);
        if (!job.factor.factor(job.matrix))
            continue;
        job.single = make_single_factor(job.factor.supernodes());
        return true;
    }
    return false;
}

} // namespace

std::vector<std::array<std::array<std::int32_t, 3>, 55>> block_places(const QuadraticModel& model) {
    const auto entry = [&](std::int32_t row, std::int32_t column) {
        const auto first = model.pattern.row.begin() + model.pattern.column_start[column],
                   last = model.pattern.row.begin() + model.pattern.column_start[column + 1];
        return static_cast<std::int32_t>(std::lower_bound(first, last, row) -
                                         model.pattern.row.begin());
    };
    std::vector<std::array<std::array<std::int32_t, 3>, 55>> places(model.mesh.tets.size());
    for (std::size_t e = 0; e < places.size(); ++e) {
        std::size_t k = 0;
        for (std::size_t a = 0; a < 10; ++a) {
            for (std::size_t b = 0; b <= a; ++b, ++k) {
                const std::int32_t da = model.dof[model.mesh.tets[e][a]],
                                   db = model.dof[model.mesh.tets[e][b]];
                for (int c = 0; c < 3; ++c) {
                    const std::int32_t column = std::min(da, db) + c;
                    const std::int32_t row = da == db ? column : std::max(da, db);
                    places[e][k][c] = std::min(da, db) < 0 ? -1 : entry(row, column);
                }
            }
        }
    }
    return places;
}

Refactoring make_refactoring(const QuadraticModel& model) {
    return {.factor = SparseFactor(model.pattern),
            .matrix = {},
            .tangent = {},
            .warp = {},
            .single = {},
            .made = {}};
}

int steps_to_refactor(const QuadraticModel& model, const SingleFactor& of, double dt_s) {
    double products = 0.0; // of the factor; its diagonal blocks are inverted and multiplied in
    for (const SingleFactor::Block& block : of.block) {
        const double own = block.columns, below = block.below;
        products +=
            own * (own * own / 3.0 + own * below + below * below) + own * own * (own / 3.0 + below);
    }
    // half of what was measured, at the side of a tissue loop: 18 ms for 7e7 products and 378 tets
    constexpr double kProducts_1ps = 2.2e9, kTets_1ps = 1.2e5;
    const double seconds =
        products / kProducts_1ps + static_cast<double>(model.mesh.tets.size()) / kTets_1ps;
    return 1 + static_cast<int>(std::ceil(seconds / dt_s));
}

bool begin_refactoring(const QuadraticModel& model, const QuadraticSystem& s,
                       Refactoring& job) noexcept {
    if (s.recovering || job.made.valid())
        return false;
    job.tangent = s.tangent;
    job.warp.resize(s.warp.size());
    for (std::size_t i = 0; i < s.warp.size(); ++i)
        job.warp[i] = s.warp[i] * glm::inverse(s.unwarp[i]); // warp = W unwarp
    const double stiffness = 1.0 + model.material.damping_stiffness_s / s.dt_s;
    try {
        job.made = std::async(std::launch::async, [&model, &s, &job, stiffness] {
            return make_factor(model, s.fixed_matrix, stiffness, job);
        });
    } catch (const std::system_error&) {
        return false;
    }
    return true;
}

bool take_refactoring(Refactoring& job, QuadraticSystem& s) noexcept {
    if (!job.made.valid() || !job.made.get())
        return false;
    std::swap(s.single, job.single);
    for (std::size_t i = 0; i < s.warp.size(); ++i) {
        const glm::mat3 W = s.warp[i] * glm::inverse(s.unwarp[i]);
        s.unwarp[i] = glm::inverse(job.warp[i]);
        s.warp[i] = W * s.unwarp[i];
    }
    return true;
}

} // namespace tissue
