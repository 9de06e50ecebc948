// Mesh, pattern and assembly of a body of revolution.
#include "tissue/reference/axisymmetric.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dvec2;

constexpr std::array<double, 3> kAt{-0.77459666924148338, 0.0, 0.77459666924148338};
constexpr std::array<double, 3> kWeight{5.0 / 9, 8.0 / 9, 5.0 / 9};

// Components of F that a body of revolution has, as numbers of Tangent: u_r, u_z, w_r, w_z, u/r.
constexpr std::array<int, 5> kComponent{0, 3, 1, 4, 8};

std::vector<double> graded(double cell, double core, double growth, double end) {
    std::vector<double> line{0.0};
    double size = cell;
    while (line.back() < end) {
        size = cell + growth * std::max(0.0, line.back() - core);
        line.push_back(line.back() + size);
    }
    for (double& x : line)
        x *= end / line.back();
    return line;
}

std::array<double, 3> quadratic(double s) {
    return {0.5 * s * (s - 1), 1 - s * s, 0.5 * s * (s + 1)};
}
std::array<double, 3> quadratic_slope(double s) {
    return {s - 0.5, -2 * s, s + 0.5};
}

// What a Gauss point of a quad with straight, axis-parallel sides has.
struct GaussPoint {
    std::array<double, 9> shape, by_r, by_z;
    double r = 0.0, weight = 0.0; // 2 pi r included
};

GaussPoint gauss_point(const AxisymmetricMesh& mesh, const std::array<int, 9>& q, int number) {
    const int i = number % 3, j = number / 3;
    const dvec2 low = mesh.rest[q[0]], high = mesh.rest[q[8]];
    const dvec2 half = 0.5 * (high - low); // z falls from line to line
    const auto nr = quadratic(kAt[i]), nz = quadratic(kAt[j]);
    const auto dr = quadratic_slope(kAt[i]), dz = quadratic_slope(kAt[j]);
    GaussPoint p;
    for (int b = 0; b < 3; ++b) {
        for (int a = 0; a < 3; ++a) {
            p.shape[3 * b + a] = nr[a] * nz[b];
            p.by_r[3 * b + a] = dr[a] * nz[b] / half.x;
            p.by_z[3 * b + a] = nr[a] * dz[b] / half.y;
        }
    }
    p.r = low.x + half.x * (1.0 + kAt[i]);
    p.weight = 2.0 * std::numbers::pi * p.r * kWeight[i] * kWeight[j] * half.x * -half.y;
    return p;
}

// F - I
glm::dmat3 gradient(const GaussPoint& p, const std::array<int, 9>& q,
                    std::span<const dvec2> moved) {
    glm::dmat3 F(0.0);
    for (int a = 0; a < 9; ++a) {
        const dvec2 u = moved[q[a]];
        F[0][0] += p.by_r[a] * u.x;
        F[1][0] += p.by_z[a] * u.x;
        F[0][1] += p.by_r[a] * u.y;
        F[1][1] += p.by_z[a] * u.y;
        F[2][2] += p.shape[a] / p.r * u.x;
    }
    return F;
}

// energy_density_jpm3() of F = I + H to rounding of H, not of I: far away H is small and the volume
// great. J - 1 = tr H + minors + det H;  J^-2/3 I1 - 3 = 3 (J^-2/3 - 1) + J^-2/3 (2 tr H + |H|^2)
double energy_density(const Elasticity& e, const glm::dmat3& H) {
    const double plane = H[0][0] + H[1][1] + H[0][0] * H[1][1] - H[0][1] * H[1][0];
    const double dilation = plane + H[2][2] + plane * H[2][2];
    if (!(dilation > -1.0))
        return std::numeric_limits<double>::infinity();
    double square = 2.0 * (H[0][0] + H[1][1] + H[2][2]);
    for (int i = 0; i < 3; ++i)
        square += glm::dot(H[i], H[i]);
    const double shrink = std::expm1(-2.0 / 3.0 * std::log1p(dilation));
    return 0.5 * e.mu_pa * (3.0 * shrink + (1.0 + shrink) * square) +
           0.5 * e.bulk_pa * dilation * dilation;
}

// What each of the 18 unknowns does to the five components.
std::array<std::array<double, 5>, 18> strain_of(const GaussPoint& p) {
    std::array<std::array<double, 5>, 18> b{};
    for (int a = 0; a < 9; ++a) {
        b[2 * a] = {p.by_r[a], p.by_z[a], 0.0, 0.0, p.shape[a] / p.r};
        b[2 * a + 1] = {0.0, 0.0, p.by_r[a], p.by_z[a], 0.0};
    }
    return b;
}

std::int32_t unknown_of(const AxisymmetricMesh& mesh, const std::array<int, 9>& q, int local) {
    return mesh.unknown[2 * q[local / 2] + local % 2];
}

void add_point(AxisymmetricSystem& s, std::size_t e, const GaussPoint& p, const glm::dmat3& F,
               bool projected) {
    const std::array<int, 9>& q = s.mesh.quad[e];
    const glm::dmat3 P = piola_stress_pa(s.elasticity, F);
    Tangent A = piola_tangent_pa(s.elasticity, F);
    if (projected)
        project_positive(A);
    const auto b = strain_of(p);
    std::size_t entry = 0;
    for (int i = 0; i < 18; ++i) {
        std::array<double, 5> ab{};
        double force = 0.0;
        for (int k = 0; k < 5; ++k) {
            force += b[i][k] * P[kComponent[k] / 3][kComponent[k] % 3];
            for (int l = 0; l < 5; ++l)
                ab[k] += A[kComponent[k]][kComponent[l]] * b[i][l];
        }
        if (const std::int32_t at = unknown_of(s.mesh, q, i); at >= 0)
            s.slope[at] += p.weight * force;
        for (int j = 0; j <= i; ++j, ++entry) {
            double sum = 0.0;
            for (int k = 0; k < 5; ++k)
                sum += ab[k] * b[j][k];
            if (s.at[e][entry] >= 0)
                s.stiffness[s.at[e][entry]] += p.weight * sum;
        }
    }
}

SparsePattern pattern_of(const AxisymmetricMesh& mesh) {
    std::vector<std::vector<int>> below(mesh.unknowns);
    for (const auto& q : mesh.quad) {
        for (int i = 0; i < 18; ++i) {
            for (int j = 0; j < 18; ++j) {
                const std::int32_t a = unknown_of(mesh, q, i), b = unknown_of(mesh, q, j);
                if (b >= 0 && a >= b)
                    below[b].push_back(a);
            }
        }
    }
    SparsePattern pattern{mesh.unknowns, {0}, {}};
    for (std::vector<int>& rows : below) {
        std::sort(rows.begin(), rows.end());
        rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
        pattern.row.insert(pattern.row.end(), rows.begin(), rows.end());
        pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
    }
    return pattern;
}

} // namespace

AxisymmetricMesh disc_mesh(double cell, double core, double growth, double extent,
                           double thickness) {
    if (!(cell > 0.0 && cell <= core && core < extent && growth > 0.0 && thickness >= 0.0)) {
        throw std::invalid_argument(
            "disc: cell = " + std::to_string(cell) + ", core = " + std::to_string(core) +
            ", growth = " + std::to_string(growth) + ", extent = " + std::to_string(extent) +
            ": want 0 < cell <= core < extent, growth > 0");
    }
    const std::vector<double> r = graded(cell, core, growth, extent);
    const std::vector<double> z = graded(cell, core, growth, thickness > 0.0 ? thickness : extent);
    AxisymmetricMesh mesh{.columns = static_cast<int>(r.size()) - 1,
                          .rows = static_cast<int>(z.size()) - 1};
    const int across = 2 * mesh.columns + 1, down = 2 * mesh.rows + 1;
    const auto on = [](const std::vector<double>& line, int i) {
        return i % 2 ? 0.5 * (line[i / 2] + line[i / 2 + 1]) : line[i / 2];
    };
    for (int j = 0; j < down; ++j) {
        for (int i = 0; i < across; ++i) {
            mesh.rest.push_back({on(r, i), -on(z, j)});
            const bool held = i == across - 1 || j == down - 1;
            mesh.unknown.push_back(held || i == 0 ? -1 : mesh.unknowns++);
            mesh.unknown.push_back(held ? -1 : mesh.unknowns++);
        }
    }
    for (int j = 0; j < mesh.rows; ++j) {
        for (int i = 0; i < mesh.columns; ++i) {
            std::array<int, 9> q{};
            for (int k = 0; k < 9; ++k)
                q[k] = (2 * j + k / 3) * across + 2 * i + k % 3;
            mesh.quad.push_back(q);
        }
    }
    return mesh;
}

AxisymmetricSystem make_axisymmetric(AxisymmetricMesh mesh, const Elasticity& elasticity) {
    AxisymmetricSystem s{.mesh = std::move(mesh), .elasticity = elasticity};
    s.pattern = pattern_of(s.mesh);
    for (const auto& q : s.mesh.quad) {
        std::size_t entry = 0;
        s.at.emplace_back();
        for (int i = 0; i < 18; ++i) {
            for (int j = 0; j <= i; ++j) {
                s.at.back()[entry++] =
                    entry_of(s.pattern, unknown_of(s.mesh, q, i), unknown_of(s.mesh, q, j));
            }
        }
    }
    s.stiffness.assign(s.pattern.row.size(), 0.0);
    s.slope.assign(s.mesh.unknowns, 0.0);
    return s;
}

double axisymmetric_energy(const AxisymmetricSystem& s, std::span<const dvec2> moved) {
    double sum = 0.0;
    for (const auto& q : s.mesh.quad) {
        for (int k = 0; k < 9; ++k) {
            const GaussPoint p = gauss_point(s.mesh, q, k);
            sum += p.weight * energy_density(s.elasticity, gradient(p, q, moved));
        }
    }
    return sum;
}

void linearize(AxisymmetricSystem& s, std::span<const dvec2> moved, bool projected) {
    std::fill(s.stiffness.begin(), s.stiffness.end(), 0.0);
    std::fill(s.slope.begin(), s.slope.end(), 0.0);
    s.min_det_f = std::numeric_limits<double>::max();
    for (std::size_t e = 0; e < s.mesh.quad.size(); ++e) {
        for (int k = 0; k < 9; ++k) {
            const GaussPoint p = gauss_point(s.mesh, s.mesh.quad[e], k);
            const glm::dmat3 F = glm::dmat3(1.0) + gradient(p, s.mesh.quad[e], moved);
            s.min_det_f = std::min(s.min_det_f, glm::determinant(F));
            add_point(s, e, p, F, projected);
        }
    }
}

std::int32_t entry_of(const SparsePattern& pattern, std::int32_t i, std::int32_t j) {
    if (i < 0 || j < 0)
        return -1;
    const auto [column, row] = std::minmax(i, j);
    const auto begin = pattern.row.begin() + pattern.column_start[column];
    const auto end = pattern.row.begin() + pattern.column_start[column + 1];
    return static_cast<std::int32_t>(std::lower_bound(begin, end, row) - pattern.row.begin());
}

} // namespace tissue
