// tissue/response/unilateral.h
// Forces that only push, many of them, when all that is known of their matrix is its product with
// a vector: organs that lie on each other. Called by sim/bridge/organ_contact.cpp in the tissue
// loop; no allocation.
//   min 1/2 y'By + q'y,  y >= 0,  B symmetric and positive definite
// Conjugate gradients on the face of what pushes; gradient steps let many rows go at once, and take
// in those that want to push: modified proportioning with reduced gradient projections (Dostal &
// Schoeberl 2005). A product costs a solve of every body, so they are what is counted.
#pragma once

#include "tissue/solver/plain_vectors.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace tissue {

/// Sized once, for as many rows as there may be.
struct UnilateralScratch {
    std::vector<double> direction, product, free, wanted;
    double norm = 0.0; // of B, the largest seen: what a gradient step may be as long as hangs on it
};
inline UnilateralScratch make_unilateral_scratch(std::size_t rows) {
    const std::vector<double> empty(rows);
    return {empty, empty, empty, empty};
}

struct UnilateralReport {
    int products = 0;
    double residual = 0.0; // worst of weight * |what is not in balance|
};

namespace unilateral_detail {

// What each row lacks: of those that push, the gradient; of the others, a gradient below 0.
inline double split(std::span<const double> y, std::span<const double> gradient,
                    std::span<const double> weight, std::span<double> free,
                    std::span<double> wanted) noexcept {
    double worst = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) {
        free[i] = y[i] > 0.0 ? gradient[i] : 0.0;
        wanted[i] = y[i] > 0.0 ? 0.0 : std::min(0.0, gradient[i]);
        worst = std::max(worst, weight[i] * (std::abs(free[i]) - wanted[i]));
    }
    return worst;
}

// How far along -direction nothing begins to pull.
inline double room(std::span<const double> y, std::span<const double> direction) noexcept {
    double most = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < y.size(); ++i) {
        if (direction[i] > 0.0)
            most = std::min(most, y[i] / direction[i]);
    }
    return most;
}

} // namespace unilateral_detail

/// From `y` >= 0 with `gradient` = By + q, until weight * residual <= tolerance in every row, or
/// `most` products. Both are kept up to date. `body.product(d, out)`: out = Bd;
/// `body.move(share)`: the last d times share has been added to y.
template <class Body>
UnilateralReport solve_unilateral(Body&& body, std::span<const double> weight, double tolerance,
                                  int most, UnilateralScratch& scratch, std::span<double> y,
                                  std::span<double> gradient) noexcept {
    const std::size_t n = y.size();
    const std::span<double> p = std::span(scratch.direction).first(n),
                            Bp = std::span(scratch.product).first(n),
                            free = std::span(scratch.free).first(n),
                            wanted = std::span(scratch.wanted).first(n);
    const auto add = [&](double share) {
        for (std::size_t i = 0; i < n; ++i) {
            y[i] = std::max(0.0, y[i] + share * p[i]);
            gradient[i] += share * Bp[i];
        }
        body.move(share);
    };
    UnilateralReport report;
    const auto look = [&] {
        report.residual = unilateral_detail::split(y, gradient, weight, free, wanted);
    };
    const auto multiply = [&] { // p'Bp
        body.product(p, Bp);
        ++report.products;
        scratch.norm = std::max(scratch.norm, norm_of(Bp) / std::max(norm_of(p), 1e-300));
        return product_of(p, Bp);
    };
    look();
    std::copy(free.begin(), free.end(), p.begin());
    while (report.residual > tolerance && report.products < most) {
        const double pushing = product_of(free, free), asking = product_of(wanted, wanted);
        if (asking > pushing) { // let in what wants to push
            std::copy(wanted.begin(), wanted.end(), p.begin());
            const double pBp = multiply();
            if (!(pBp > 0.0))
                break;
            add(-product_of(gradient, p) / pBp);
            look();
            std::copy(free.begin(), free.end(), p.begin());
            continue;
        }
        const double pBp = multiply();
        if (!(pBp > 0.0))
            break;
        const double best = product_of(gradient, p) / pBp, room = unilateral_detail::room(y, p);
        if (best <= room) {
            add(-best);
            look();
            const double back = product_of(free, Bp) / pBp;
            for (std::size_t i = 0; i < n; ++i)
                p[i] = free[i] - back * p[i];
            continue;
        }
        // to the first that would pull, which lets go, and on from there along the gradient, as
        // far as it leads down
        add(-room);
        for (std::size_t i = 0; i < n; ++i) {
            if (p[i] > 0.0 && y[i] <= 1e-15 * p[i] * room)
                y[i] = 0.0;
        }
        look();
        for (std::size_t i = 0; i < n; ++i)
            p[i] = std::max(0.0, y[i] - free[i] / scratch.norm) - y[i];
        const double slope = product_of(gradient, p);
        if (slope < 0.0) {
            const double dBd = multiply();
            if (!(dBd > 0.0))
                break;
            add(std::min(1.0, -slope / dBd));
            look();
        }
        std::copy(free.begin(), free.end(), p.begin());
    }
    return report;
}

} // namespace tissue
