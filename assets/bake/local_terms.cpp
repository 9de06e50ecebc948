#include "assets/bake/local_terms.h"

#include "tissue/response/subgrid.h"

#include <algorithm>
#include <limits>

namespace bake {

void keep_terms_local(double poisson, tissue::ContactSurface& surface) {
    constexpr double kHalfSpace = std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < surface.rest_m.size(); ++v) {
        const double most_m = tissue::kernel_compliance_mpn(
            1.0, poisson, surface.footprint_radius_m[v], kHalfSpace); // times E
        const double most_t_m = tissue::tangential_ratio(poisson) * most_m;
        if (surface.mesh_term_n_m[v] > most_m || surface.mesh_term_t_m[v] > most_t_m)
            surface.mesh_lean_m[v] = {};
        surface.mesh_term_n_m[v] = std::min(surface.mesh_term_n_m[v], most_m);
        surface.mesh_term_t_m[v] = std::min(surface.mesh_term_t_m[v], most_t_m);
    }
}

} // namespace bake
