// tissue/reference/reference_tangent.cpp
// Conjugate gradients (Hestenes & Stiefel 1952), preconditioned by a factor. Called by Newton.
#include "tissue/reference/reference_tangent.h"

#include "tissue/solver/plain_vectors.h"

#include <algorithm>
#include <utility>

namespace tissue {

int solve_with_old_factor(const ReferenceModel& model, ReferenceSystem& system, int products,
                          double tolerance, std::span<const double> right, std::span<double> step) {
    std::vector<double> residual(right.begin(), right.end()), scaled = residual;
    if (!system.factor.solve(scaled, 1))
        return 0;
    std::fill(step.begin(), step.end(), 0.0);
    std::vector<double> way = scaled, image(way.size());
    double size = product_of(residual, scaled);
    const double wanted = tolerance * norm_of(right);
    for (int k = 1; k <= products; ++k) {
        multiply(model.free, system.matrix, way, image);
        const double curvature = product_of(way, image);
        if (!(curvature > 0.0))
            return 0;
        const double along = size / curvature;
        for (std::size_t i = 0; i < way.size(); ++i) {
            step[i] += along * way[i];
            residual[i] -= along * image[i];
        }
        if (norm_of(residual) <= wanted)
            return k;
        scaled = residual;
        system.factor.solve(scaled, 1);
        const double last = std::exchange(size, product_of(residual, scaled));
        for (std::size_t i = 0; i < way.size(); ++i)
            way[i] = scaled[i] + size / last * way[i];
    }
    return 0;
}

} // namespace tissue
