// tests/tissue/reference_statics.cpp
#include "tests/tissue/reference_statics.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numeric>

namespace reference {
namespace {

using glm::dmat3;
using glm::dvec3;
using Corners = std::array<dvec3, 4>;

constexpr double kRefused = std::numeric_limits<double>::infinity();

// Eigenvectors of a symmetric 3x3 in the columns of the result, eigenvalues on a's diagonal.
dmat3 eigenvectors(dmat3& a) {
    dmat3 v(1.0);
    for (int sweep = 0; sweep < 10; ++sweep) {
        const double off = std::abs(a[1][0]) + std::abs(a[2][0]) + std::abs(a[2][1]);
        if (off < 1e-17 * (a[0][0] + a[1][1] + a[2][2]))
            break;
        for (int p = 0; p < 2; ++p) {
            for (int q = p + 1; q < 3; ++q) {
                const double angle = 0.5 * std::atan2(2 * a[q][p], a[p][p] - a[q][q]);
                dmat3 turn(1.0);
                turn[p][p] = turn[q][q] = std::cos(angle);
                turn[p][q] = std::sin(angle);
                turn[q][p] = -std::sin(angle);
                a = glm::transpose(turn) * a * turn;
                v = v * turn;
            }
        }
    }
    return v;
}

struct Element {
    dmat3 rest_inverse;
    double volume_m3;
};

class Solver {
  public:
    explicit Solver(const Beam& beam) : beam_(beam) {
        number_nodes();
        for (const tissue::Tet& t : beam.mesh.tets) {
            const dvec3 x0 = beam.mesh.rest_m[t[0]];
            const dmat3 edges{beam.mesh.rest_m[t[1]] - x0, beam.mesh.rest_m[t[2]] - x0,
                              beam.mesh.rest_m[t[3]] - x0};
            elements_.push_back({glm::inverse(edges), glm::determinant(edges) / 6});
            for (const std::uint32_t a : t) {
                for (const std::uint32_t b : t) {
                    if (place_[a] < 0 || place_[b] < 0)
                        continue;
                    band_ = std::max(band_, 3 * std::abs(place_[a] - place_[b]) + 3);
                }
            }
        }
    }

    // Adds the gradient to `out` if wanted; returns the energy, infinite if turned over.
    double element(std::size_t e, const Corners& x, Corners* out) const {
        const dmat3 F = dmat3{x[1] - x[0], x[2] - x[0], x[3] - x[0]} * elements_[e].rest_inverse;
        if (glm::determinant(F) <= 0)
            return kRefused;
        dmat3 C = glm::transpose(F) * F;
        const dmat3 v = eigenvectors(C);
        dvec3 s;
        for (int i = 0; i < 3; ++i)
            s[i] = glm::length(F * v[i]);
        const double dilation = s.x + s.y + s.z - 3;
        if (out != nullptr) {
            dmat3 P(0.0);
            for (int i = 0; i < 3; ++i) {
                const double slope = 2 * beam_.mu_pa * (s[i] - 1) + beam_.lambda_pa * dilation;
                P += glm::outerProduct(slope / s[i] * (F * v[i]), v[i]);
            }
            const dmat3 H = elements_[e].volume_m3 * P * glm::transpose(elements_[e].rest_inverse);
            for (int k = 0; k < 3; ++k) {
                (*out)[k + 1] += H[k];
                (*out)[0] -= H[k];
            }
        }
        const dvec3 d = s - 1.0;
        return elements_[e].volume_m3 *
               (beam_.mu_pa * glm::dot(d, d) + beam_.lambda_pa / 2 * dilation * dilation);
    }

    double energy(const std::vector<dvec3>& x, double share, std::vector<double>* gradient) const {
        double sum = 0;
        if (gradient != nullptr)
            gradient->assign(size_, 0.0);
        for (std::size_t e = 0; e < elements_.size(); ++e) {
            const tissue::Tet& t = beam_.mesh.tets[e];
            Corners g{};
            sum += element(e, {x[t[0]], x[t[1]], x[t[2]], x[t[3]]}, gradient ? &g : nullptr);
            const dvec3 weight =
                share * beam_.density_kgpm3 * elements_[e].volume_m3 / 4 * beam_.gravity_mps2;
            for (int a = 0; a < 4; ++a) {
                sum -= glm::dot(weight, x[t[a]]);
                for (int k = 0; gradient && place_[t[a]] >= 0 && k < 3; ++k) {
                    (*gradient)[3 * place_[t[a]] + k] += g[a][k] - weight[k];
                }
            }
        }
        return sum;
    }

    // Lower band, by columns.
    std::vector<double> tangent(const std::vector<dvec3>& x) const {
        constexpr double kStep_m = 1e-8;
        std::vector<double> band(size_ * static_cast<std::size_t>(band_), 0.0);
        for (std::size_t e = 0; e < elements_.size(); ++e) {
            const tissue::Tet& t = beam_.mesh.tets[e];
            const Corners at{x[t[0]], x[t[1]], x[t[2]], x[t[3]]};
            for (int b = 0; b < 4; ++b) {
                for (int c = 0; place_[t[b]] >= 0 && c < 3; ++c) {
                    Corners plus = at, minus = at, up{}, down{};
                    plus[b][c] += kStep_m;
                    minus[b][c] -= kStep_m;
                    element(e, plus, &up);
                    element(e, minus, &down);
                    const int column = 3 * place_[t[b]] + c;
                    for (int a = 0; a < 4; ++a) {
                        for (int k = 0; place_[t[a]] >= 0 && k < 3; ++k) {
                            const int row = 3 * place_[t[a]] + k;
                            if (row < column)
                                continue;
                            band[column * band_ + row - column] +=
                                (up[a][k] - down[a][k]) / (2 * kStep_m);
                        }
                    }
                }
            }
        }
        return band;
    }

    // Solves in place; false if not positive definite.
    bool band_solve(std::vector<double>& l, std::vector<double>& x) const {
        const int n = static_cast<int>(size_);
        for (int j = 0; j < n; ++j) {
            double* lj = &l[static_cast<std::size_t>(j) * band_];
            if (!(lj[0] > 0))
                return false;
            const int last = std::min(band_, n - j);
            const double root = std::sqrt(lj[0]);
            for (int i = 0; i < last; ++i)
                lj[i] /= root;
            for (int i = 1; i < last; ++i) {
                double* li = &l[static_cast<std::size_t>(j + i) * band_];
                for (int k = i; k < last; ++k)
                    li[k - i] -= lj[i] * lj[k];
            }
        }
        for (int j = 0; j < n; ++j) {
            const double* lj = &l[static_cast<std::size_t>(j) * band_];
            x[j] /= lj[0];
            for (int i = 1; i < std::min(band_, n - j); ++i)
                x[j + i] -= lj[i] * x[j];
        }
        for (int j = n - 1; j >= 0; --j) {
            const double* lj = &l[static_cast<std::size_t>(j) * band_];
            for (int i = 1; i < std::min(band_, n - j); ++i)
                x[j] -= lj[i] * x[j + i];
            x[j] /= lj[0];
        }
        return true;
    }

    // Newton direction, with the diagonal raised until it points downhill.
    std::vector<double> direction(const std::vector<dvec3>& x, const std::vector<double>& g) const {
        const std::vector<double> band = tangent(x);
        for (double raise = 0.0;; raise = std::max(1e-3, 4 * raise)) {
            std::vector<double> l = band, d = g;
            for (std::size_t j = 0; j < size_; ++j)
                l[j * band_] *= 1 + raise;
            if (band_solve(l, d))
                return d;
        }
    }

    std::vector<dvec3> moved(std::vector<dvec3> x, const std::vector<double>& d, double s) const {
        for (std::size_t i = 0; i < x.size(); ++i) {
            for (int k = 0; place_[i] >= 0 && k < 3; ++k)
                x[i][k] -= s * d[3 * place_[i] + k];
        }
        return x;
    }

    double weight_n() const {
        std::vector<double> g;
        energy(beam_.mesh.rest_m, 1.0, &g); // at rest the tets pull nothing
        return norm(g);
    }

    static double norm(const std::vector<double>& v) {
        return std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0));
    }

  private:
    // Along x first: the band is one cross-section wide.
    void number_nodes() {
        std::vector<std::uint32_t> order(beam_.mesh.rest_m.size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return beam_.mesh.rest_m[a].x < beam_.mesh.rest_m[b].x - 1e-9;
        });
        place_.assign(order.size(), -1);
        for (const std::uint32_t i : order) {
            if (!beam_.anchored[i])
                place_[i] = static_cast<int>(size_++);
        }
        size_ *= 3;
    }

    const Beam& beam_;
    std::vector<Element> elements_;
    std::vector<int> place_;
    std::size_t size_ = 0;
    int band_ = 0;
};

} // namespace

Equilibrium solve(const Beam& beam, int load_steps, double tolerance) {
    const Solver solver(beam);
    const double weight_n = solver.weight_n();
    Equilibrium result{beam.mesh.rest_m, 0.0, 0};
    for (int load = 1; load <= load_steps; ++load) {
        const double share = static_cast<double>(load) / load_steps;
        const bool last = load == load_steps;
        for (int i = 0; i < 60; ++i) {
            std::vector<double> g;
            const double before = solver.energy(result.position_m, share, &g);
            result.relative_residual = Solver::norm(g) / weight_n;
            if (result.relative_residual < (last ? tolerance : 1e-2))
                break;
            const std::vector<double> d = solver.direction(result.position_m, g);
            double s = 1.0;
            while (s > 1e-6 && !(solver.energy(solver.moved(result.position_m, d, s), share,
                                               nullptr) <= before + 1e-13 * std::abs(before))) {
                s /= 2;
            }
            result.position_m = solver.moved(result.position_m, d, s);
            ++result.iterations;
        }
    }
    return result;
}

} // namespace reference
