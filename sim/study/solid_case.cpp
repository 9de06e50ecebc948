#include "sim/study/solid_case.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace sim {
namespace {

using glm::dvec3;

constexpr std::array kModels{"linear",      "corotated", "quadratic", "reference",
                             "mass-spring", "xpbd",      "tled",      "projective"};
constexpr double kNear = 1e-6; // of the length: what is on a face

[[noreturn]] void refuse(const std::string& option, const std::string& value,
                         const std::string& accepted) {
    throw std::invalid_argument(fmt::format("--{} {}: accepted: {}", option, value, accepted));
}

void within(const char* option, double value, double least, double most, const char* unit) {
    if (!(value >= least && value <= most))
        refuse(option, fmt::format("{:g}", value),
               fmt::format("{}from {:g} to {:g}", unit, least, most));
}

void check_sizes(const SolidCase& c) {
    within("length", c.length_m, 1e-4, 10.0, "metres ");
    within("height", c.height_m, 1e-4, 10.0, "metres ");
    within("width", c.width_m, 1e-4, 10.0, "metres ");
    double tets = 6.0;
    for (const int n : c.cells) {
        if (n < 1)
            refuse("cells", cells_name(c.cells), "NXxNYxNZ, whole numbers from 1");
        tets *= n;
    }
    if (tets > 1e6)
        refuse("cells", cells_name(c.cells), "up to 1000000 tets, six a cell");
}

void check_material(const SolidCase& c) {
    const tissue::Material& m = c.material;
    within("young", 1e-3 * m.young_pa, 1e-6, 1e9, "kPa ");
    if (!(m.poisson >= 0.0 && m.poisson < 0.5))
        refuse("poisson", fmt::format("{:g}", m.poisson), "from 0, below 0.5");
    within("density", m.density_kgpm3, 1e-3, 1e5, "kg/m3 ");
    within("gravity", c.gravity_mps2, 0.0, 1e3, "m/s2 ");
    within("damping-mass", m.damping_mass_1ps, 0.0, 1e4, "1/s ");
    within("damping-stiffness", m.damping_stiffness_s, 0.0, 10.0, "s ");
}

// The patch's edges run along those of the grid, so that its size is what was asked for.
void check_patch(const SolidCase& c) {
    if (c.patch_m == 0.0)
        return;
    const std::array<std::pair<double, int>, 2> sides{
        {{c.length_m, c.cells[0]}, {c.width_m, c.cells[2]}}};
    for (const auto& [size_m, cells] : sides) {
        const double free_cells = 0.5 * (size_m - c.patch_m) / size_m * cells;
        if (c.patch_m < 0.0 || free_cells < -kNear ||
            std::abs(free_cells - std::round(free_cells)) > 1e-6)
            refuse("patch", fmt::format("{:g}", c.patch_m),
                   fmt::format("metres, a square in the middle of {:g} x {:g} m whose edges are on "
                               "the grid of --cells {}; 0: the whole top",
                               c.length_m, c.width_m, cells_name(c.cells)));
    }
}

void check_loads(const SolidCase& c) {
    if (c.press == SolidPress::punch) {
        if (c.shape != SolidShape::block)
            refuse("press", "punch", "pressure, but for the block");
        if (c.depth_m.empty())
            refuse("depths", "", "metres, at least one with --press punch");
        for (const double d : c.depth_m)
            within("depths", d, 0.0, 0.9 * c.height_m, "metres ");
    }
    for (const double f : c.load_n)
        within("load", f, -1e6, 1e6, "N ");
    const std::size_t ways = c.press == SolidPress::punch ? c.depth_m.size() : c.load_n.size();
    if (ways == 0)
        refuse("load", "", "N, at least one");
    if (!c.statics && ways != 1)
        refuse(
            c.press == SolidPress::punch ? "depths" : "load",
            fmt::format("{}", fmt::join(c.press == SolidPress::punch ? c.depth_m : c.load_n, " ")),
            "one value, several with --static");
}

bool on_loaded_face(const SolidCase& c, const dvec3& x) {
    const double near_m = kNear * c.length_m;
    if (c.shape != SolidShape::block)
        return x.x > c.length_m - near_m;
    const double side_m = c.patch_m > 0.0 ? c.patch_m : 2.0 * std::max(c.length_m, c.width_m);
    return x.y > c.height_m - near_m && std::abs(x.x - 0.5 * c.length_m) < 0.5 * side_m + near_m &&
           std::abs(x.z - 0.5 * c.width_m) < 0.5 * side_m + near_m;
}

dvec3 middle_of_loaded_face(const SolidCase& c) {
    if (c.shape == SolidShape::block)
        return {0.5 * c.length_m, c.height_m, 0.5 * c.width_m};
    const double y = c.shape == SolidShape::bar ? 0.5 * c.height_m : 52.0 / 44.0 * c.height_m;
    return {c.length_m, y, 0.5 * c.width_m};
}

tissue::TetMesh corners_of(const SolidCase& c) {
    tissue::TetMesh mesh = tissue::box_mesh({c.length_m, c.height_m, c.width_m}, c.cells);
    if (c.shape == SolidShape::membrane) {
        for (dvec3& x : mesh.rest_m) {
            const double along = x.x / c.length_m, up = x.y / c.height_m;
            x.y = c.height_m * (along + up * (1.0 + (16.0 / 44.0 - 1.0) * along));
        }
    }
    return mesh;
}

// Of a triangle at a place in its plane; false if it is outside.
bool barycentric(const std::array<dvec3, 3>& x, const dvec3& at, dvec3& out) {
    const dvec3 n = glm::cross(x[1] - x[0], x[2] - x[0]);
    for (int k = 0; k < 3; ++k)
        out[k] = glm::dot(n, glm::cross(x[(k + 1) % 3] - at, x[(k + 2) % 3] - at)) / glm::dot(n, n);
    return std::min({out.x, out.y, out.z}) > -1e-9;
}

// Loads and the place that is looked at: linear faces, a third of each at its corners.
void load_linear(const SolidCase& c, SolidBody& body) {
    for (const tissue::Triangle& t : tissue::boundary_triangles(body.corners)) {
        const std::array<dvec3, 3> x{body.rest_m[t[0]], body.rest_m[t[1]], body.rest_m[t[2]]};
        if (!std::ranges::all_of(x, [&](const dvec3& p) { return on_loaded_face(c, p); }))
            continue;
        for (const std::uint32_t node : t)
            body.load_share[node] += glm::length(glm::cross(x[1] - x[0], x[2] - x[0])) / 6.0;
        dvec3 b;
        if (body.tip.empty() && barycentric(x, middle_of_loaded_face(c), b))
            body.tip = {{t[0], b.x}, {t[1], b.y}, {t[2], b.z}};
    }
}

// Quadratic faces: a third of each at its edge nodes, nothing at the corners.
void load_quadratic(const SolidCase& c, SolidBody& body) {
    for (const tissue::Triangle6& t : tissue::boundary_triangles(body.quadratic)) {
        const std::array<dvec3, 3> x{body.rest_m[t[0]], body.rest_m[t[1]], body.rest_m[t[2]]};
        if (!std::ranges::all_of(x, [&](const dvec3& p) { return on_loaded_face(c, p); }))
            continue;
        for (int k = 3; k < 6; ++k)
            body.load_share[t[k]] += glm::length(glm::cross(x[1] - x[0], x[2] - x[0])) / 6.0;
        dvec3 b;
        if (!body.tip.empty() || !barycentric(x, middle_of_loaded_face(c), b))
            continue;
        for (int k = 0; k < 3; ++k) {
            body.tip.emplace_back(t[k], b[k] * (2.0 * b[k] - 1.0));
            body.tip.emplace_back(t[3 + k], 4.0 * b[k] * b[(k + 1) % 3]);
        }
    }
}

} // namespace

std::span<const char* const> solid_models() {
    return kModels;
}

SolidElement element_of(const SolidCase& c) {
    if (std::ranges::find(kModels, c.model) == kModels.end())
        refuse("model", c.model, fmt::format("{}", fmt::join(kModels, ", ")));
    if (!c.element.empty() && c.element != "p1" && c.element != "p2")
        refuse("element", c.element, "p1, p2");
    if (c.model == "linear")
        return c.element == "p1" ? SolidElement::linear : SolidElement::quadratic;
    const bool quadratic = c.model == "quadratic" || c.model == "reference";
    if (!c.element.empty() && (c.element == "p2") != quadratic)
        refuse("element", c.element,
               fmt::format("{} for the model {}", quadratic ? "p2" : "p1", c.model));
    return quadratic ? SolidElement::quadratic : SolidElement::linear;
}

void check(const SolidCase& c) {
    check_sizes(c);
    check_material(c);
    check_patch(c);
    check_loads(c);
    within("dt", c.dt_s, 1e-6, 1.0, "seconds ");
    if (c.steps < 1 || c.steps > 1000000)
        refuse("steps", std::to_string(c.steps), "from 1 to 1000000");
    if (element_of(c) == SolidElement::linear && c.model == "linear" &&
        c.press == SolidPress::punch)
        refuse("element", "p1", "p2 for the model linear under a punch");
}

SolidBody make_solid_body(const SolidCase& c) {
    check(c);
    SolidBody body;
    body.corners = corners_of(c);
    const bool linear = element_of(c) == SolidElement::linear;
    if (!linear)
        body.quadratic = tissue::quadratic_mesh(body.corners);
    body.rest_m = linear ? body.corners.rest_m : body.quadratic.rest_m;
    body.load_share.assign(body.rest_m.size(), 0.0);
    if (c.shape == SolidShape::membrane)
        body.load_direction = {0.0, 1.0, 0.0};
    linear ? load_linear(c, body) : load_quadratic(c, body);
    double area_m2 = 0.0;
    for (const double a : body.load_share)
        area_m2 += a;
    for (double& a : body.load_share)
        a /= area_m2;
    for (const dvec3& x : body.rest_m) {
        const double height_m = c.shape == SolidShape::block ? x.y : x.x;
        body.clamped.push_back(height_m < kNear * c.length_m ? 1 : 0);
        if (c.press == SolidPress::punch)
            body.punched.push_back(on_loaded_face(c, x) ? 1 : 0);
    }
    return body;
}

dvec3 tip_of(const SolidBody& body, std::span<const dvec3> position_m) {
    dvec3 sum{0.0};
    for (const auto& [node, weight] : body.tip)
        sum += weight * (position_m[node] - body.rest_m[node]);
    return sum;
}

dvec3 mean_of(const SolidBody& body, std::span<const dvec3> position_m) {
    dvec3 sum{0.0};
    for (std::size_t i = 0; i < body.rest_m.size(); ++i)
        sum += body.load_share[i] * (position_m[i] - body.rest_m[i]);
    return sum;
}

std::array<int, 3> cells_of(const std::string& text) {
    std::array<int, 3> cells{};
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%dx%d%c", &cells[0], &cells[1], &cells[2], &rest) != 3 ||
        *std::ranges::min_element(cells) < 1)
        refuse("cells", text, "NXxNYxNZ, whole numbers from 1, such as 10x2x2");
    return cells;
}

std::string cells_name(const std::array<int, 3>& cells) {
    return fmt::format("{}x{}x{}", cells[0], cells[1], cells[2]);
}

} // namespace sim
