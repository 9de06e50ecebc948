#include "sim/check/rest_feel.h"

#include "haptics/contact/contact_rows.h"

#include <algorithm>
#include <limits>

namespace sim {

bool is_held(const tissue::BakedOrgan& organ, const tissue::Material& material) {
    if (organ.rigid || std::count(organ.anchored.begin(), organ.anchored.end(), 1) >= 3)
        return true;
    constexpr double kSoftest_npm = 1.0 / 5e-3;
    double bed_npm = 0.0;
    for (const tissue::BedSample& sample : organ.bed)
        bed_npm += material.young_pa * sample.stiffness_m;
    return bed_npm >= kSoftest_npm;
}

RestFeel::RestFeel(const Body& body) : body_(body) {
    if (!body.soft)
        return;
    firm_ = !body.organ->bed.empty() ||
            std::count(body.organ->anchored.begin(), body.organ->anchored.end(), 1) >= 3;
    if (!firm_)
        return;
    const tissue::CorotatedModel& model = body.soft->model;
    system_ = tissue::make_system(model);
    tissue::linearize(model, tissue::rest_state(model), std::numeric_limits<double>::infinity(),
                      *system_);
    firm_ = system_->factored;
    answer_m_.resize(3 * static_cast<std::size_t>(model.unknowns));
}

glm::dmat3 RestFeel::mesh_compliance(const haptics::SurfacePoint& at) {
    if (!system_)
        return glm::dmat3{0.0};
    const tissue::CorotatedModel& model = body_.soft->model;
    const tissue::ContactSurface& skin = body_.organ->surface;
    const std::size_t n = static_cast<std::size_t>(model.unknowns);
    const std::span<double> block(answer_m_);
    std::fill(block.begin(), block.end(), 0.0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 direction{0.0};
        direction[axis] = 1.0;
        tissue::add_row(model, skin, tissue_point(at), direction, 1.0, block.subspan(axis * n, n));
    }
    system_->factor.solve(block, 3);
    glm::dmat3 compliance;
    for (int axis = 0; axis < 3; ++axis) {
        compliance[axis] =
            tissue::row_value(model, skin, tissue_point(at), block.subspan(axis * n, n));
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
