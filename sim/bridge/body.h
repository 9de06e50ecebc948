// sim/bridge/body.h
// One organ of a scene while it runs: the tissue's model and state beside what the contact solver
// wants to know about its skin. Built at setup, then touched by the tissue loop only.
#pragma once

#include "haptics/contact/contact_law.h"
#include "haptics/contact/local_model.h"
#include "tissue/mesh/baked_organ.h"
#include "tissue/response/contact_basis.h"
#include "tissue/response/patch.h"
#include "tissue/solver/solid.h"

#include <limits>
#include <memory>
#include <optional>

namespace sim {

/// Where the modes of the local model were last solved for, for one tool.
struct BasisPlace {
    bool known = false, held = false;
    glm::dvec3 rest_m{0.0};
    double moved_m = 0.0; // SoftBody::moved_m there
    int of = -1;          // SoftBody::linearisations there
};

/// What deforms. Absent for a rigid body.
struct SoftBody {
    tissue::Solid solid;
    tissue::ContactBasis basis;
    tissue::SkinFrames skin_frame;
    std::vector<double> shape_by_unknown{}; // the basis, one line of modes per unknown
    std::vector<double> motion_m{};         // du of the step being made
    std::vector<double> rows{};             // of the contact, 3 columns for each tool
    std::vector<double> answer_m{};         // A^-1 of them
    std::vector<double> load_n{};           // contact forces of the step being made
    std::vector<double> drift_m{};          // since it last was not still
    std::array<haptics::SurfacePoint, haptics::kTools> answer_at{}; // where the rows are
    std::size_t answers = 0;                                        // tools with rows
    int answers_of = -1;                                            // the linearisation
    int answers_age = 0;                                            // steps since
    double answers_moved_m = 0.0;                                   // moved_m then
    int linearisations = 0; // counts them, so that what rests on one knows when it is old
    double moved_m = 0.0;   // how far anything has moved, all in all
    int basis_count = 0;    // counts bases, so that what rests on one knows when it is old
    int basis_of = -1;      // the linearisation and places that the basis was made for
    std::array<BasisPlace, haptics::kTools> basis_place{};
    double still_s = 0.0; // for how long nothing has touched it and nothing has moved
    bool resting = true;  // nothing touches it and nothing moves: steps cost nothing
};

/// What a tip of one radius meets on a material. Tools with equal tips share the table.
struct TipLaw {
    std::shared_ptr<const haptics::IndenterTable> table; // null: rigid
    double radius_m = 0.0;
};
using TipRadii = std::array<double, haptics::kTools>;

struct Body {
    std::shared_ptr<const tissue::BakedOrgan> organ;
    tissue::Material material;
    std::optional<SoftBody> soft;
    std::vector<glm::dvec3> skin_m, skin_normal; // as deformed now
    double longest_edge_m = 0.0;                 // of the skin at rest
    // the sub-grid law: at each skin vertex for this material, and for the tip of each tool
    std::vector<double> thinness_1pm, normal_mpn, tangential_mpn; // thinness: 1 / thickness
    std::vector<tissue::SymmetricTensor> lean_mpn; // at rest, see mesh_lean.h; empty: none leans
    std::array<TipLaw, haptics::kTools> tip;
};

/// `dt_s`: the FEM step that the first system is factored for. The rigid tier makes scenery of any
/// organ, and scenery is rigid in any tier. Throws on bad data, with the reason.
Body make_body(std::shared_ptr<const tissue::BakedOrgan> organ, const tissue::Material& material,
               const TipRadii& tip_radius_m, double dt_s,
               tissue::Tier tier = tissue::Tier::corotated);

/// The sub-grid law of a tool where `at` lies on the skin; `floor_mpn` is 1/Kc of the tool there.
haptics::LocalLaw law_on(const Body& body, const haptics::SurfacePoint& at, int tool,
                         double floor_mpn) noexcept;

/// Deformed place and unit normal there.
glm::dvec3 place_on(const Body& body, const haptics::SurfacePoint& at) noexcept;
glm::dvec3 normal_on(const Body& body, const haptics::SurfacePoint& at) noexcept;

/// The whole deformed skin as something haptics::walk can walk on.
struct BodySurface {
    const Body& body;
    glm::dvec3 position(int triangle, int corner) const noexcept {
        return body.skin_m[body.organ->surface.triangles[triangle][corner]];
    }
    int neighbour(int triangle, int corner) const noexcept {
        return body.organ->surface.neighbours[triangle][corner];
    }
};

/// The nearest point of the skin; exact while no edge is stretched by half. `distance_m`: to it.
/// Skin farther than `within_m` need not be found: then some point, and a distance beyond that.
struct Foot {
    haptics::SurfacePoint at;
    double distance_m = 0.0;
};
Foot nearest_on(const Body& body, const glm::dvec3& from_m,
                double within_m = std::numeric_limits<double>::infinity()) noexcept;

inline tissue::ContactPoint tissue_point(const haptics::SurfacePoint& at) noexcept {
    return {static_cast<std::uint32_t>(at.triangle), at.weight};
}

} // namespace sim
