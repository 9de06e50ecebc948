// See the header.
#include "tissue/rod/rod_bend.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

constexpr double kFold = 1e-3; // of 1 + te.tf: no sharper
const dvec3 kSide{1.0, 1.1, 1.2};

struct Bend {
    dvec3 te, tf, m1e, m2e, m1f, m2f;
    double chi = 2.0; // 1 + te.tf
    dvec3 kb{0.0}, tilde_t{0.0}, tilde_m1{0.0}, tilde_m2{0.0};
    double kappa1 = 0.0, kappa2 = 0.0;
};

// The direction nearest to that of `f` that is not folded back onto `e`. All the way back there is
// none: then one that the frames were folded to without twist, about the line between m1e and m1f;
// of both such the one on a side that is the same for every fold, so that a zigzag does not become
// a loop, which a rod that cannot turn at its ends never leaves.
dvec3 opened(const RodFrame& e, const RodFrame& f) noexcept {
    const double along = glm::dot(e.tangent, f.tangent);
    if (!(1.0 + along < kFold))
        return f.tangent;
    dvec3 side = f.tangent - along * e.tangent;
    const bool back = !(glm::dot(side, side) > 1e-6);
    if (back) {
        const dvec3 both = e.across + f.across, axis = both - glm::dot(both, e.tangent) * e.tangent;
        side = glm::dot(axis, axis) > 1e-6 ? glm::cross(axis, e.tangent) : e.across;
    }
    if (back && glm::dot(side, kSide) < 0.0)
        side = -side;
    constexpr double c = kFold - 1.0;
    return c * e.tangent + std::sqrt(1.0 - c * c) * glm::normalize(side);
}

Bend bend_of(const RodFrame& e, const RodFrame& f) noexcept {
    Bend b;
    b.te = e.tangent;
    b.tf = opened(e, f);
    b.m1e = e.across;
    b.m1f = carried(f.across, f.tangent, b.tf);
    b.m2e = glm::cross(b.te, b.m1e);
    b.m2f = glm::cross(b.tf, b.m1f);
    b.chi = 1.0 + glm::dot(b.te, b.tf);
    b.kb = 2.0 / b.chi * glm::cross(b.te, b.tf);
    b.tilde_t = (b.te + b.tf) / b.chi;
    b.tilde_m1 = (b.m1e + b.m1f) / b.chi;
    b.tilde_m2 = (b.m2e + b.m2f) / b.chi;
    b.kappa1 = 0.5 * glm::dot(b.m2e + b.m2f, b.kb);
    b.kappa2 = -0.5 * glm::dot(b.m1e + b.m1f, b.kb);
    return b;
}

double twist_of(const Bend& b) noexcept {
    const dvec3 m = carried(b.m1e, b.te, b.tf);
    return std::atan2(glm::dot(b.tf, glm::cross(m, b.m1f)), glm::dot(m, b.m1f));
}

dmat3 outer(const dvec3& a, const dvec3& b) noexcept {
    return {b.x * a, b.y * a, b.z * a};
}

dmat3 both(const dvec3& a, const dvec3& b) noexcept {
    return outer(a, b) + outer(b, a);
}

// [a]x b = a x b
dmat3 crossing(const dvec3& a) noexcept {
    return {0.0, a.z, -a.y, -a.z, 0.0, a.x, a.y, -a.x, 0.0};
}

BendGradient gradient(const dvec3& by_e, double by_theta_e, const dvec3& by_f, double by_theta_f) {
    return {by_e.x, by_e.y, by_e.z, by_theta_e, by_f.x, by_f.y, by_f.z, by_theta_f};
}

void put(BendHessian& h, int row, int column, const dmat3& block) noexcept {
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            h[static_cast<std::size_t>(row + r)][static_cast<std::size_t>(column + c)] =
                block[c][r];
            h[static_cast<std::size_t>(column + c)][static_cast<std::size_t>(row + r)] =
                block[c][r];
        }
    }
}

void put(BendHessian& h, int row, int column, const dvec3& by) noexcept {
    for (int r = 0; r < 3; ++r) {
        h[static_cast<std::size_t>(row + r)][static_cast<std::size_t>(column)] = by[r];
        h[static_cast<std::size_t>(column)][static_cast<std::size_t>(row + r)] = by[r];
    }
}

// Of k = (me + mf).kb/2, where `ne`, `nf` are what me and mf turn to when theta does. kappa1 has
// m = m2, n = -m1; kappa2 has m = -m1, n = -m2.
BendHessian curvature_hessian(const Bend& b, double e_m, double f_m, double k, const dvec3& me,
                              const dvec3& mf, const dvec3& ne, const dvec3& nf) noexcept {
    const dvec3 m = (me + mf) / b.chi, tf_m = glm::cross(b.tf, m), te_m = glm::cross(b.te, m);
    const dmat3 one(1.0), tt = outer(b.tilde_t, b.tilde_t);
    BendHessian h{};
    put(h, 0, 0,
        (2.0 * k * tt - both(tf_m, b.tilde_t) - k / b.chi * (one - outer(b.te, b.te)) +
         0.25 * both(b.kb, me)) /
            (e_m * e_m));
    put(h, 4, 4,
        (2.0 * k * tt + both(te_m, b.tilde_t) - k / b.chi * (one - outer(b.tf, b.tf)) +
         0.25 * both(b.kb, mf)) /
            (f_m * f_m));
    put(h, 0, 4,
        (-k / b.chi * (one + outer(b.te, b.tf)) + 2.0 * k * tt - outer(tf_m, b.tilde_t) +
         outer(b.tilde_t, te_m) - crossing(m)) /
            (e_m * f_m));
    h[3][3] = -0.5 * glm::dot(b.kb, me);
    h[7][7] = -0.5 * glm::dot(b.kb, mf);
    // n.kb/2 as a function of the edges
    const auto by_e = [&](const dvec3& n) {
        return (-0.5 * glm::dot(n, b.kb) * b.tilde_t + glm::cross(b.tf, n) / b.chi) / e_m;
    };
    const auto by_f = [&](const dvec3& n) {
        return (-0.5 * glm::dot(n, b.kb) * b.tilde_t - glm::cross(b.te, n) / b.chi) / f_m;
    };
    put(h, 0, 3, by_e(ne));
    put(h, 0, 7, by_e(nf));
    put(h, 4, 3, by_f(ne));
    put(h, 4, 7, by_f(nf));
    return h;
}

BendHessian twist_hessian(const Bend& b, double e_m, double f_m) noexcept {
    BendHessian h{};
    put(h, 0, 0, -0.25 / (e_m * e_m) * both(b.kb, b.te + b.tilde_t));
    put(h, 4, 4, -0.25 / (f_m * f_m) * both(b.kb, b.tf + b.tilde_t));
    put(h, 0, 4, 0.5 / (e_m * f_m) * (2.0 / b.chi * crossing(b.te) - outer(b.kb, b.tilde_t)));
    return h;
}

} // namespace

// Rodrigues: b = from x to, c = from.to, v' = v + b x v + b x (b x v)/(1 + c)
dvec3 carried(const dvec3& v, const dvec3& from, const dvec3& to) noexcept {
    const double chi = 1.0 + glm::dot(from, to);
    if (!(chi > 1e-9))
        return v;
    const dvec3 b = glm::cross(from, to), bv = glm::cross(b, v);
    return v + bv + glm::cross(b, bv) / chi;
}

RodFrame moved(const RodFrame& frame, const dvec3& to, double theta_rad) noexcept {
    dvec3 m = carried(frame.across, frame.tangent, to);
    m -= glm::dot(m, to) * to;
    m = glm::normalize(m);
    return {to, std::cos(theta_rad) * m + std::sin(theta_rad) * glm::cross(to, m)};
}

BendStrain bend_strain(const RodFrame& e, const RodFrame& f) noexcept {
    const Bend b = bend_of(e, f);
    return {b.kappa1, b.kappa2, twist_of(b)};
}

std::array<BendGradient, 3> bend_gradient(const RodFrame& e, double e_m, const RodFrame& f,
                                          double f_m) noexcept {
    const Bend b = bend_of(e, f);
    const auto of = [&](double k, const dvec3& m, double by_theta_e, double by_theta_f) {
        return gradient((-k * b.tilde_t + glm::cross(b.tf, m)) / e_m, by_theta_e,
                        (-k * b.tilde_t - glm::cross(b.te, m)) / f_m, by_theta_f);
    };
    return {of(b.kappa1, b.tilde_m2, -0.5 * glm::dot(b.kb, b.m1e), -0.5 * glm::dot(b.kb, b.m1f)),
            of(b.kappa2, -b.tilde_m1, -0.5 * glm::dot(b.kb, b.m2e), -0.5 * glm::dot(b.kb, b.m2f)),
            gradient(0.5 / e_m * b.kb, -1.0, 0.5 / f_m * b.kb, 1.0)};
}

std::array<BendHessian, 3> bend_hessian(const RodFrame& e, double e_m, const RodFrame& f,
                                        double f_m) noexcept {
    const Bend b = bend_of(e, f);
    return {curvature_hessian(b, e_m, f_m, b.kappa1, b.m2e, b.m2f, -b.m1e, -b.m1f),
            curvature_hessian(b, e_m, f_m, b.kappa2, -b.m1e, -b.m1f, -b.m2e, -b.m2f),
            twist_hessian(b, e_m, f_m)};
}

} // namespace tissue
