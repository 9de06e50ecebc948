#include "sim/bridge/mesh_lean.h"

#include "tissue/response/footprint_kernel.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>

namespace sim {
namespace {

using glm::dmat3;
using glm::dvec3;
using tissue::SymmetricTensor;

constexpr double kLeast_mpn = 5e-3; // 200 N/m: a quarter of the usual coupling spring

dmat3 matrix(const SymmetricTensor& s) noexcept {
    return {{s[0], s[5], s[4]}, {s[5], s[1], s[3]}, {s[4], s[3], s[2]}};
}

// Least eigenvalue of a symmetric matrix (Smith 1961).
double least_eigenvalue(const dmat3& m) {
    const double mean = (m[0][0] + m[1][1] + m[2][2]) / 3.0;
    const dmat3 rest = m - dmat3{mean};
    double square = 0.0;
    for (int k = 0; k < 3; ++k)
        square += glm::dot(rest[k], rest[k]);
    const double p = std::sqrt(square / 6.0);
    if (p == 0.0)
        return mean;
    const double turn = std::acos(std::clamp(glm::determinant(rest / p) / 2.0, -1.0, 1.0)) / 3.0;
    return mean + 2.0 * p * std::cos(turn + 2.0 * std::numbers::pi / 3.0);
}

// The law's compliances at the greatest force that its table has, least of all tools.
struct LeastLaw {
    double normal_mpn, tangential_mpn;
};

LeastLaw least_law(const Body& body, std::size_t vertex) {
    LeastLaw least{std::numeric_limits<double>::infinity(),
                   std::numeric_limits<double>::infinity()};
    for (const TipLaw& tip : body.tip) {
        const haptics::LocalLaw law{.table = tip.table.get(),
                                    .radius_over_thickness =
                                        tip.radius_m * body.thinness_1pm[vertex],
                                    .normal_mpn = body.normal_mpn[vertex],
                                    .tangential_mpn = body.tangential_mpn[vertex]};
        const double x = (haptics::IndenterTable::kEntries - 1) * tip.table->x_step;
        const haptics::LawPoint at = haptics::law_at(law, x);
        least.normal_mpn = std::min(least.normal_mpn, at.ddepth_dx / at.dforce_dx);
        least.tangential_mpn =
            std::min(least.tangential_mpn, haptics::tangential_compliance(law, x));
    }
    return least;
}

// Greatest share s <= 1 of `lean` with  diag(t, t, n) + s lean >= kLeast_mpn.
double bearable_share(const SymmetricTensor& lean, const dvec3& normal, const LeastLaw& least) {
    const double n = least.normal_mpn - kLeast_mpn, t = least.tangential_mpn - kLeast_mpn;
    if (!(n > 0.0) || !(t > 0.0))
        return 0.0;
    // D^-1/2 = 1/sqrt t + (1/sqrt n - 1/sqrt t) n n^T
    const dmat3 root = dmat3{1.0 / std::sqrt(t)} + (1.0 / std::sqrt(n) - 1.0 / std::sqrt(t)) *
                                                       glm::outerProduct(normal, normal);
    const double lowest = least_eigenvalue(root * matrix(lean) * root);
    if (!std::isfinite(lowest))
        return 0.0;
    return lowest < -1.0 ? -1.0 / lowest : 1.0;
}

} // namespace

std::vector<SymmetricTensor> rest_lean(const Body& body) {
    const std::vector<SymmetricTensor>& owed_m = body.organ->surface.mesh_lean_m;
    const auto leans = [](const SymmetricTensor& s) { return s != SymmetricTensor{}; };
    if (std::ranges::none_of(owed_m, leans))
        return {};
    const tissue::ContactSurface& skin = body.organ->surface;
    const std::vector<dvec3> normal = tissue::vertex_normals(skin.rest_m, skin.triangles);
    std::vector<SymmetricTensor> lean_mpn = owed_m;
    for (std::size_t v = 0; v < lean_mpn.size(); ++v) {
        for (double& s : lean_mpn[v])
            s /= body.material.young_pa;
        const double share = bearable_share(lean_mpn[v], normal[v], least_law(body, v));
        for (double& s : lean_mpn[v])
            s = share > 0.0 ? share * s : 0.0;
    }
    return lean_mpn;
}

dmat3 turn_on(const Body& body, int triangle) noexcept {
    const tissue::ContactSurface& skin = body.organ->surface;
    const auto [a, b, c] = skin.triangles[triangle];
    return tissue::triangle_turn({skin.rest_m[a], skin.rest_m[b], skin.rest_m[c]},
                                 {body.skin_m[a], body.skin_m[b], body.skin_m[c]});
}

SymmetricTensor turned(const SymmetricTensor& s, const dmat3& by) noexcept {
    const dmat3 m = by * matrix(s) * glm::transpose(by);
    return {m[0][0], m[1][1], m[2][2], m[1][2], m[0][2], m[0][1]};
}

dmat3 lean_on(const Body& body, const haptics::SurfacePoint& at) noexcept {
    if (body.lean_mpn.empty())
        return dmat3{0.0};
    const tissue::Triangle& t = body.organ->surface.triangles[at.triangle];
    SymmetricTensor s{};
    for (int k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < s.size(); ++i)
            s[i] += at.weight[k] * body.lean_mpn[t[k]][i];
    const dmat3 by = turn_on(body, at.triangle);
    return by * matrix(s) * glm::transpose(by);
}

} // namespace sim
