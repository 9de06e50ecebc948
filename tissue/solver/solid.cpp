// See the header.
#include "tissue/solver/solid.h"

#include "tissue/mesh/quadratic_mesh.h"
#include "tissue/solver/quadratic_columns.h"
#include "tissue/solver/stress.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

CorotatedSolid make_linear_tets(bool linear, const SolidMesh& mesh, const Material& material,
                                const glm::dvec3& gravity_mps2, double dt_s) {
    CorotatedModel model =
        make_corotated(mesh.mesh, material, mesh.anchored, gravity_mps2, mesh.bed);
    CorotatedState state = rest_state(model);
    CorotatedSystem system = make_system(model);
    linearize(model, state, dt_s, system);
    Descent descent = make_descent(model);
    Chord chord = make_chord(model);
    return {std::move(model),   std::move(state), std::move(system),
            std::move(descent), std::move(chord), linear};
}

QuadraticSolid make_quadratic_tets(const SolidMesh& mesh, const Material& material,
                                   const glm::dvec3& gravity_mps2, double dt_s) {
    const QuadraticMesh ten = quadratic_mesh(mesh.mesh);
    std::vector<std::uint8_t> anchored(mesh.anchored.begin(), mesh.anchored.end());
    if (!anchored.empty()) {
        anchored.resize(ten.rest_m.size(), 0);
        for (const Tet10& tet : ten.tets) {
            for (std::size_t e = 0; e < kEdge.size(); ++e) {
                anchored[tet[4 + e]] =
                    anchored[tet[kEdge[e][0]]] != 0 && anchored[tet[kEdge[e][1]]] != 0;
            }
        }
    }
    QuadraticModel model = make_quadratic(ten, material, anchored, gravity_mps2, mesh.bed);
    QuadraticState state = rest_state(model);
    QuadraticSystem system = make_system(model, dt_s);
    linearize(model, state, system);
    QuadraticOptions options;
    options.loosest_linear = 0.1;
    auto refactoring = std::make_unique<Refactoring>(make_refactoring(model));
    const int steps = steps_to_refactor(model, system.single, dt_s);
    return {.model = std::move(model),
            .state = std::move(state),
            .system = std::move(system),
            .options = options,
            .factor_steps = steps,
            .refactoring = std::move(refactoring)};
}

RodSolid make_tube(Tier tier, const SolidMesh& mesh, const Material& material,
                   const glm::dvec3& gravity_mps2, double dt_s) {
    RodBody model = make_rod_body(*mesh.line, mesh.skin_m, material, gravity_mps2);
    RodState state = rest_state(model.rod);
    RodSystem system = make_system(model.rod);
    linearize(model.rod, state, dt_s, system);
    RodPoints points = make_points(model.rod, mesh.skin_m);
    return {std::move(model), std::move(state), std::move(system), std::move(points), tier};
}

double largest(std::span<const double> values) noexcept {
    double most = 0.0;
    for (const double v : values)
        most = std::max(most, std::abs(v));
    return most;
}

SolidReport motion(CorotatedSolid& s, bool, std::span<const double> load_n,
                   std::span<double> du) noexcept {
    const StepReport report = free_motion(s.model, s.state, s.system, du, load_n);
    return {.linear_residual = report.relative_residual,
            .inverted = report.inverted,
            .warped = !report.exact_tangent};
}

SolidReport of(const QuadraticReport& report, int needed) noexcept {
    return {.linear_residual = report.linear_force_residual,
            .residual = report.relative_residual,
            .iterations = std::max(0, report.newton_iterations - needed),
            .inverted = report.recovering ? 1 : 0,
            .warped = report.projected > 0};
}

// One Newton iteration from where the step begins: contact will be added to it.
SolidReport motion(QuadraticSolid& s, bool touched, std::span<const double> load_n,
                   std::span<double> du) noexcept {
    linearize(s.model, s.state, s.system, load_n);
    s.begun = true;
    if (!touched || s.system.recovering)
        return of(free_motion(s.model, s.options, s.system, du), 1);
    const std::size_t n = du.size();
    const std::span<double> way(s.system.unknown.data(), n), right(way.data() + n, n);
    way_and_residual(s.model, s.system, way, right);
    QuadraticOptions options = s.options;
    options.linear_tolerance = newton_linear_tolerance(options, s.system);
    const LinearReport linear = solve(s.model, options, right, s.system, du);
    s.most_iterations = std::max(s.most_iterations, linear.iterations);
    for (std::size_t k = 0; k < n; ++k)
        du[k] += way[k];
    return {.linear_residual = linear.relative_residual * s.system.residual,
            .warped = linear.projected};
}

SolidReport motion(RodSolid& s, bool, std::span<const double> load_n,
                   std::span<double> du) noexcept {
    free_motion(s.model.rod, s.state, s.system, load_n, s.points, du);
    return {.warped = s.system.projected};
}

double solve_block(CorotatedSolid& s, double, std::span<const double>, std::span<double> block,
                   int columns) noexcept {
    s.system.factor.solve(block, columns);
    return 0.0;
}

double solve_block(QuadraticSolid& s, double tolerance, std::span<const double> first,
                   std::span<double> block, int columns) noexcept {
    QuadraticOptions options = s.options;
    options.linear_tolerance = tolerance;
    if (columns == 1 && first.empty() && !s.system.recovering) { // alone it is cheaper
        const std::span<double> b(s.system.unknown.data(), block.size());
        std::copy(block.begin(), block.end(), b.begin());
        const LinearReport report = solve(s.model, options, b, s.system, block);
        s.most_iterations = std::max(s.most_iterations, report.iterations);
        return report.relative_residual;
    }
    const ColumnsReport report =
        solve_columns(s.model, options, s.system, block, columns, {}, first);
    s.most_iterations = std::max(s.most_iterations, report.iterations);
    return report.relative_residual;
}

double solve_block(RodSolid& s, double, std::span<const double>, std::span<double> block,
                   int columns) noexcept {
    solve(s.model.rod, s.state, s.system, s.points, block, columns);
    return 0.0;
}

SolidReport end(CorotatedSolid& s, std::span<const double> load_n, double relinearise_m,
                bool placed, std::span<double> du) noexcept {
    s.drift_m += largest(du);
    if (s.linear || (s.system.inverted == 0 && !(s.drift_m > relinearise_m))) {
        advance(s.model, du, s.system.dt_s, s.state);
        follow_tangent(s.model, du, s.system);
        return {};
    }
    FreshEnd corrected;
    if (relinearise_m > 0.0 && !placed) {
        const bool touched = largest(load_n) > 0.0;
        if (touched) // what contact made of the step would be lost
            corrected.end = end_on_chord(s.model, load_n, du, s.system, s.chord, s.state);
        else
            corrected = end_or_begin_again(s.model, load_n, du, s.system, s.chord, s.state);
    }
    if (corrected.end.made) {
        s.drift_m = 0.0;
        return {.residual = corrected.end.residual, .new_tangent = corrected.new_tangent};
    }
    const StepEnd end = finish_step(s.model, load_n, du, s.system, s.descent, s.state);
    s.drift_m = 0.0;
    return {.residual = end.relative_residual,
            .iterations = end.iterations,
            .inverted = end.inverted,
            .new_tangent = true};
}

// What rests on the tangent alone may be that old; forces are exact in every step.
constexpr double kOld = 5.0;

// A factor of where the body is, once solves take long with the one of before: begun when they do,
// taken so many steps later. Both are counted, never timed, so that runs repeat.
void renew_factor(QuadraticSolid& s) noexcept {
    constexpr int kManyIterations = 4;
    ++s.since_factor;
    if (s.since_factor == s.factor_steps)
        take_refactoring(*s.refactoring, s.system);
    else if (s.since_factor > s.factor_steps && s.most_iterations > kManyIterations &&
             begin_refactoring(s.model, s.system, *s.refactoring))
        s.since_factor = 0;
    s.most_iterations = 0;
}

SolidReport end(QuadraticSolid& s, std::span<const double> load_n, double relinearise_m,
                bool placed, std::span<double> du) noexcept {
    if (!s.begun)
        linearize(s.model, s.state, s.system);
    s.begun = false;
    QuadraticOptions options = s.options;
    if (placed)
        options.max_newton = 0;
    SolidReport report = of(finish(s.model, options, load_n, s.system, du), 0);
    advance(s.model, s.system, du, s.state);
    renew_factor(s);
    s.drift_m += largest(du);
    report.new_tangent = s.drift_m > kOld * relinearise_m;
    if (report.new_tangent)
        s.drift_m = 0.0;
    return report;
}

SolidReport end(RodSolid& s, std::span<const double> load_n, double relinearise_m, bool,
                std::span<double> du) noexcept {
    const RodReport made = end_step(s.model.rod, load_n, {}, s.points, du, s.system, s.state);
    s.drift_m += largest(du);
    const SolidReport report{.residual = made.relative_residual,
                             .iterations = made.iterations,
                             .warped = made.projected,
                             .new_tangent = s.drift_m > kOld * relinearise_m};
    if (report.new_tangent)
        s.drift_m = 0.0;
    return report;
}

double peak_pa(const CorotatedSolid& s) noexcept {
    return s.system.peak_von_mises_pa;
}
double peak_pa(const QuadraticSolid& s) noexcept {
    return peak_von_mises_pa(s.model, s.system);
}

double peak_pa(const RodSolid& s) noexcept {
    return peak_von_mises_pa(s.model.rod, s.state);
}

double energy_j(const CorotatedSolid& s) noexcept {
    return elastic_energy_j(s.model, s.state);
}
double energy_j(const QuadraticSolid& s) noexcept {
    return s.system.energy_j;
}
double energy_j(const RodSolid& s) noexcept {
    return s.system.energy_j;
}

std::span<const glm::dvec3> nodes_at_rest_m(const CorotatedSolid& s) noexcept {
    return s.model.mesh.rest_m;
}
std::span<const glm::dvec3> nodes_at_rest_m(const QuadraticSolid& s) noexcept {
    return s.model.mesh.rest_m;
}
std::span<const glm::dvec3> nodes_at_rest_m(const RodSolid& s) noexcept {
    return s.model.rest_m;
}

} // namespace

std::optional<Tier> tier_named(std::string_view name) noexcept {
    for (std::size_t t = 0; t < kTierNames.size(); ++t) {
        if (kTierNames[t] == name)
            return static_cast<Tier>(t);
    }
    return std::nullopt;
}

Solid make_solid(Tier tier, const SolidMesh& mesh, const Material& material,
                 const glm::dvec3& gravity_mps2, double dt_s) {
    if (!(dt_s > 0.0))
        throw std::invalid_argument("dt_s = " + std::to_string(dt_s) + ": must be greater than 0");
    if (mesh.line != nullptr && tier != Tier::rigid)
        return make_tube(tier, mesh, material, gravity_mps2, dt_s);
    switch (tier) {
    case Tier::linear:
        return make_linear_tets(true, mesh, material, gravity_mps2, dt_s);
    case Tier::corotated:
        return make_linear_tets(false, mesh, material, gravity_mps2, dt_s);
    case Tier::quadratic:
        return make_quadratic_tets(mesh, material, gravity_mps2, dt_s);
    case Tier::rigid:
        break;
    }
    throw std::invalid_argument("tier rigid: nothing of it deforms");
}

Tier tier_of(const Solid& solid) noexcept {
    if (const auto* s = std::get_if<CorotatedSolid>(&solid))
        return s->linear ? Tier::linear : Tier::corotated;
    if (const auto* s = std::get_if<RodSolid>(&solid))
        return s->tier;
    return Tier::quadratic;
}

int unknowns(const Solid& solid) noexcept {
    return std::visit([](const auto& s) { return s.model.unknowns; }, solid);
}

const Material& material_of(const Solid& solid) noexcept {
    return std::visit([](const auto& s) -> const Material& { return s.model.material; }, solid);
}

std::span<const std::int32_t> dofs(const Solid& solid) noexcept {
    return std::visit([](const auto& s) { return std::span<const std::int32_t>(s.model.dof); },
                      solid);
}

std::span<const glm::dvec3> rest_m(const Solid& solid) noexcept {
    return std::visit([](const auto& s) { return nodes_at_rest_m(s); }, solid);
}

std::span<const glm::dvec3> position_m(const Solid& solid) noexcept {
    if (const auto* s = std::get_if<RodSolid>(&solid))
        return s->points.position_m;
    return std::visit([](const auto& s) { return std::span<const glm::dvec3>(s.state.position_m); },
                      solid);
}

SolidReport free_motion(Solid& solid, bool touched, std::span<const double> load_n,
                        std::span<double> du) noexcept {
    return std::visit([&](auto& s) { return motion(s, touched, load_n, du); }, solid);
}

double solve(Solid& solid, double tolerance, std::span<const double> first, std::span<double> block,
             int columns) noexcept {
    return std::visit([&](auto& s) { return solve_block(s, tolerance, first, block, columns); },
                      solid);
}

SolidReport end_step(Solid& solid, std::span<const double> load_n, double relinearise_m,
                     std::span<double> du, bool placed) noexcept {
    return std::visit([&](auto& s) { return end(s, load_n, relinearise_m, placed, du); }, solid);
}

void stop(Solid& solid) noexcept {
    std::visit(
        [](auto& s) {
            std::fill(s.state.velocity_mps.begin(), s.state.velocity_mps.end(), glm::dvec3{0.0});
        },
        solid);
    if (auto* s = std::get_if<CorotatedSolid>(&solid))
        s->state.recovering = false;
    if (auto* s = std::get_if<RodSolid>(&solid)) {
        std::fill(s->state.spin_radps.begin(), s->state.spin_radps.end(), 0.0);
        std::fill(s->system.velocity.begin(), s->system.velocity.end(), 0.0);
    }
    if (auto* s = std::get_if<QuadraticSolid>(&solid))
        std::fill(s->state.gain_mps.begin(), s->state.gain_mps.end(), glm::dvec3{0.0});
}

double peak_von_mises_pa(const Solid& solid) noexcept {
    return std::visit([](const auto& s) { return peak_pa(s); }, solid);
}

double elastic_energy_j(const Solid& solid) noexcept {
    return std::visit([](const auto& s) { return energy_j(s); }, solid);
}

} // namespace tissue
