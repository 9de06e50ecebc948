// sim/check/rest_feel.h
// How hard a slow press of given depth pushes back, from the static tangent at rest. Called when an
// exercise is checked: one factorisation for a body that has targets, three solves for a place.
#pragma once

#include "sim/bridge/body.h"

namespace sim {

/// Whether anything holds a body: three fixed nodes, or a bed so stiff that 1 N moves the body as
/// a whole by 5 mm at most. A softer hold gives way to any touch before the tissue does.
bool is_held(const tissue::BakedOrgan& organ, const tissue::Material& material);

class RestFeel {
  public:
    explicit RestFeel(const Body& body);

    /// Compliance of the skin point as the mesh has it, m/N; zero if rigid.
    glm::dmat3 mesh_compliance(const haptics::SurfacePoint& at);

    /// False: the body is loose, or its tangent cannot be factored: it has no static compliance.
    bool firm() const { return firm_; }

  private:
    const Body& body_;
    bool firm_ = true;
    std::optional<tissue::SparseFactor> factor_; // of the stiffness at rest
    std::optional<tissue::RodSolid> rod_;        // or a tube at rest, linearised for statics
    std::vector<double> answer_m_;
};

/// Force along the normal at `depth_m` of a tip of `radius_m`, for a mesh compliance along the
/// normal and the sub-grid law there.
double press_force_n(const haptics::LocalLaw& law, double mesh_mpn, double depth_m,
                     double radius_m);

} // namespace sim
