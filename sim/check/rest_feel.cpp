#include "sim/check/rest_feel.h"

#include "haptics/contact/contact_rows.h"

#include <algorithm>
#include <limits>

namespace sim {
namespace {

std::optional<tissue::SparseFactor> rest_factor(const tissue::CorotatedSolid& solid) {
    tissue::CorotatedSystem system = tissue::make_system(solid.model);
    tissue::linearize(solid.model, tissue::rest_state(solid.model),
                      std::numeric_limits<double>::infinity(), system);
    if (!system.factored)
        return std::nullopt;
    return std::move(system.factor);
}

std::optional<tissue::SparseFactor> rest_factor(const tissue::QuadraticSolid& solid) {
    tissue::SparseFactor factor(solid.model.pattern);
    if (!factor.factor(solid.model.rest_stiffness_npm))
        return std::nullopt;
    return factor;
}

tissue::RodSolid rod_at_rest(const tissue::RodSolid& solid) {
    tissue::RodSolid rest = solid;
    rest.state = tissue::rest_state(rest.model.rod);
    rest.points = tissue::make_points(rest.model.rod, rest.model.rest_m);
    tissue::linearize(rest.model.rod, rest.state, std::numeric_limits<double>::infinity(),
                      rest.system);
    return rest;
}

bool holds(const tissue::BakedOrgan& organ) {
    return tissue::has_hold(organ.line) || !organ.bed.empty() ||
           std::count(organ.anchored.begin(), organ.anchored.end(), 1) >= 3;
}

} // namespace

bool is_held(const tissue::BakedOrgan& organ, const tissue::Material& material) {
    if (organ.rigid || std::count(organ.anchored.begin(), organ.anchored.end(), 1) >= 3)
        return true;
    constexpr double kSoftest_npm = 1.0 / 5e-3;
    if (std::count(organ.line.held.begin(), organ.line.held.end(), 1) >= 2)
        return true;
    double bed_npm = tissue::hold_npm(organ.line, material.young_pa);
    for (const tissue::BedSample& sample : organ.bed)
        bed_npm += material.young_pa * sample.stiffness_m;
    return bed_npm >= kSoftest_npm;
}

RestFeel::RestFeel(const Body& body) : body_(body) {
    if (!body.soft)
        return;
    firm_ = holds(*body.organ);
    if (!firm_)
        return;
    const tissue::Solid& solid = body.soft->solid;
    if (const auto* tube = std::get_if<tissue::RodSolid>(&solid))
        rod_ = rod_at_rest(*tube);
    else if (const auto* linear = std::get_if<tissue::CorotatedSolid>(&solid))
        factor_ = rest_factor(*linear);
    else
        factor_ = rest_factor(std::get<tissue::QuadraticSolid>(solid));
    firm_ = rod_.has_value() || factor_.has_value();
    answer_m_.resize(3 * body.soft->motion_m.size());
}

glm::dmat3 RestFeel::mesh_compliance(const haptics::SurfacePoint& at) {
    if (!factor_ && !rod_)
        return glm::dmat3{0.0};
    const std::span<const std::int32_t> dofs = tissue::dofs(body_.soft->solid);
    const tissue::ContactSurface& skin = body_.organ->surface;
    const std::size_t n = body_.soft->motion_m.size();
    const std::span<double> block(answer_m_);
    std::fill(block.begin(), block.end(), 0.0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 direction{0.0};
        direction[axis] = 1.0;
        tissue::add_row(dofs, skin, tissue_point(at), direction, 1.0, block.subspan(axis * n, n));
    }
    if (rod_)
        tissue::solve(rod_->model.rod, rod_->state, rod_->system, rod_->points, block, 3);
    else
        factor_->solve(block, 3);
    glm::dmat3 compliance;
    for (int axis = 0; axis < 3; ++axis) {
        compliance[axis] =
            tissue::row_value(dofs, skin, tissue_point(at), block.subspan(axis * n, n));
    }
    return compliance;
}

double press_force_n(const haptics::LocalLaw& law, double mesh_mpn, double depth_m,
                     double radius_m) {
    haptics::ContactProblem problem;
    problem.row[0] = {.active = true,
                      .tip_m = {0.0, 0.0, radius_m - depth_m},
                      .surface_free_m = {0.0, 0.0, 0.0},
                      .normal = {0.0, 0.0, 1.0},
                      .tip_radius_m = radius_m,
                      .friction = 0.0,
                      .law = law};
    for (auto& line : problem.compliance)
        line.fill(glm::dmat3{0.0});
    problem.compliance[0][0] = glm::dmat3{mesh_mpn};
    std::array<haptics::ContactMemory, haptics::kTools> memory{};
    return haptics::solve_contact(problem, memory).force_n[0].z;
}

} // namespace sim
