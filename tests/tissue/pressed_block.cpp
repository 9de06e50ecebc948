// tests/tissue/pressed_block.cpp
// The block put together for tests: see the header.
#include "tests/tissue/pressed_block.h"

#include "tests/tissue/block.h"
#include "tissue/response/footprint.h"
#include "tissue/response/linear_statics.h"
#include "tissue/response/mesh_term.h"
#include "tissue/solver/corotated.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

namespace block {
namespace {

using glm::dvec3;

tissue::Material block_material() {
    tissue::Material material;
    material.young_pa = kYoung_pa;
    material.poisson = kPoisson;
    return material;
}

double row(const std::vector<double>& entries, double at) {
    const auto last = static_cast<double>(entries.size() - 2);
    const double i = std::min(std::floor(at), last);
    const auto k = static_cast<std::size_t>(i);
    return entries[k] + (at - i) * (entries[k + 1] - entries[k]);
}

// D(P) of the sphere between two levels of thickness.
double local_depth_m(const tissue::SphereLaw& law, double force_n, double ratio) {
    const double x = std::cbrt(force_n / law.force_scale_n);
    std::size_t level = 0;
    while (level + 2 < law.radius_over_thickness.size() &&
           ratio >= law.radius_over_thickness[level + 1])
        ++level;
    const double low = law.radius_over_thickness[level],
                 high = law.radius_over_thickness[level + 1];
    const double part = (ratio - low) / (high - low);
    return x * ((1.0 - part) * row(law.depth_over_x_m[level], x / law.x_step) +
                part * row(law.depth_over_x_m[level + 1], x / law.x_step));
}

template <class Visit> void slide(const Visit& visit) {
    const double angle = 17.0 / 180.0 * std::numbers::pi;
    for (int i = 0; i <= 600; ++i) {
        const double way_m = 5e-5 * i;
        visit(25e-3 + way_m * std::cos(angle), 33.3e-3 + way_m * std::sin(angle));
    }
}

} // namespace

PressedBlock::PressedBlock(tissue::TetMesh mesh, std::vector<std::uint8_t> anchored,
                           tissue::ContactSurface skin, int order)
    : mesh_(std::move(mesh)), skin_(std::move(skin)) {
    if (order == 2) {
        const auto statics = tissue::make_linear_statics(mesh_, 2, kPoisson, anchored);
        tissue::SparseFactor factor(statics.pattern);
        if (!factor.factor(statics.stiffness_m))
            throw std::runtime_error("block: nothing holds it");
        find_flexibility(statics.dof, factor, 1.0 / kYoung_pa);
        return;
    }
    const auto model = tissue::make_corotated(mesh_, block_material(), anchored);
    tissue::CorotatedSystem system = tissue::make_system(model);
    tissue::linearize(model, tissue::rest_state(model), std::numeric_limits<double>::infinity(),
                      system);
    find_flexibility(model.dof, system.factor, 1.0);
}

void PressedBlock::find_flexibility(std::span<const std::int32_t> dof, tissue::SparseFactor& factor,
                                    double scale) {
    std::vector<std::uint32_t> nodes(skin_.row_node);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    std::erase_if(nodes, [&](auto node) { return dof[node] < 0; });
    slot_.assign(dof.size(), -1);
    for (const std::uint32_t node : nodes)
        slot_[node] = static_cast<std::int32_t>(slots_++);

    const std::size_t n = 3 * static_cast<std::size_t>(std::count_if(
                                  dof.begin(), dof.end(), [](auto d) { return d >= 0; }));
    constexpr std::size_t kColumns = 64;
    for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t first = 0; first < slots_; first += kColumns) {
            const std::size_t columns = std::min(kColumns, slots_ - first);
            std::vector<double> u(n * columns, 0.0);
            for (std::size_t c = 0; c < columns; ++c)
                u[c * n + dof[nodes[first + c]] + axis] = scale;
            factor.solve(u, static_cast<int>(columns));
            for (std::size_t c = 0; c < columns; ++c) {
                for (const std::uint32_t node : nodes)
                    flexibility_mpn_[axis].push_back(u[c * n + dof[node] + axis]);
            }
        }
    }
}

PressedBlock::Contact PressedBlock::find(double x_m, double y_m) const {
    for (const tissue::Triangle& t : skin_.triangles) {
        const dvec3 a = skin_.rest_m[t[0]], ab = skin_.rest_m[t[1]] - a,
                    ac = skin_.rest_m[t[2]] - a;
        const double det = ab.x * ac.y - ab.y * ac.x;
        if (std::abs(det) < 1e-15)
            continue;
        const double dx = x_m - a.x, dy = y_m - a.y;
        const double v = (dx * ac.y - dy * ac.x) / det, w = (ab.x * dy - ab.y * dx) / det;
        if (v >= -1e-12 && w >= -1e-12 && v + w <= 1.0 + 1e-12)
            return {t, {1.0 - v - w, v, w}};
    }
    throw std::out_of_range("place is not on the skin");
}

double PressedBlock::mix(const Contact& at, const std::vector<double>& value) const {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k)
        sum += at.weight[k] * value[at.vertex[k]];
    return sum;
}

double PressedBlock::mesh_mpn(const Contact& at, int axis) const {
    std::vector<std::pair<std::int32_t, double>> load;
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t v = at.vertex[k];
        for (std::uint32_t i = skin_.row_start[v]; i < skin_.row_start[v + 1]; ++i) {
            if (slot_[skin_.row_node[i]] >= 0)
                load.emplace_back(slot_[skin_.row_node[i]], at.weight[k] * skin_.row_weight[i]);
        }
    }
    double sum = 0.0;
    for (const auto& [i, wi] : load) {
        for (const auto& [j, wj] : load)
            sum += wi * wj * flexibility_mpn_[axis][i * slots_ + j];
    }
    return sum;
}

double PressedBlock::punch_mpn(double tip_radius_m, double thickness_m) const {
    const double thick_m = std::round(thickness_m * 1e9) * 1e-9; // one key for one layer
    if (punch_[0] != tip_radius_m || punch_[1] != thick_m)
        punch_ = {tip_radius_m, thick_m,
                  tissue::punch_compliance_mpn(kYoung_pa, kPoisson, tip_radius_m, thick_m)};
    return punch_[2];
}

double PressedBlock::far_mpn(const Contact& at, double thick_m) const {
    return mesh_mpn(at, 2) + mix(at, skin_.mesh_term_n_m) / kYoung_pa -
           tissue::kernel_compliance_mpn(kYoung_pa, kPoisson, mix(at, skin_.footprint_radius_m),
                                         thick_m);
}

double PressedBlock::compliance_mpn(double x_m, double y_m, int axis, double a_m,
                                    const Parts& parts) const {
    const Contact at = find(x_m, y_m);
    double sum = mesh_mpn(at, axis);
    if (parts.mesh_term)
        sum += mix(at, axis == 2 ? skin_.mesh_term_n_m : skin_.mesh_term_t_m) / kYoung_pa;
    if (parts.subgrid) {
        const double thick_m = parts.layer && axis == 2 ? mix(at, skin_.thickness_m) : 1e3;
        const double r_m = mix(at, skin_.footprint_radius_m);
        const double term = punch_mpn(a_m, thick_m) -
                            tissue::kernel_compliance_mpn(kYoung_pa, kPoisson, r_m, thick_m);
        sum += std::max(0.0, term) * (axis == 2 ? 1.0 : tissue::tangential_ratio(kPoisson));
    }
    return sum;
}

double PressedBlock::depth_m(double x_m, double y_m, double force_n, const tissue::SphereLaw& law,
                             double tip_radius_m) const {
    const Contact at = find(x_m, y_m);
    const double thick_m = mix(at, skin_.thickness_m);
    return local_depth_m(law, force_n, tip_radius_m / thick_m) + far_mpn(at, thick_m) * force_n;
}

double PressedBlock::force_n(double x_m, double y_m, double depth_m_wanted,
                             const tissue::SphereLaw& law, double tip_radius_m) const {
    const Contact at = find(x_m, y_m);
    const double thick_m = mix(at, skin_.thickness_m), far = far_mpn(at, thick_m);
    double low = 0.0, high = 10.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        const double depth = local_depth_m(law, middle, tip_radius_m / thick_m) + far * middle;
        (depth < depth_m_wanted ? low : high) = middle;
    }
    return low;
}

PressedBlock pressed_box(const glm::dvec3& size_m, const std::array<int, 3>& cells,
                         double tip_radius_max_m, bool point_rows) {
    const tissue::FootprintOptions options{.tip_radius_max_m = tip_radius_max_m,
                                           .point_rows = point_rows};
    const tissue::TetMesh mesh = tissue::box_mesh(size_m, cells);
    const std::vector<std::uint8_t> anchored = bottom_anchored(mesh);
    tissue::ContactSurface skin = top_skin(size_m, 4e-3);
    tissue::make_footprints(mesh, anchored, options, skin);
    tissue::make_mesh_terms(mesh, kPoisson, anchored, options, skin);
    return {mesh, anchored, skin};
}

PressedBlock quadratic_box(const dvec3& size_m, const std::array<int, 3>& cells, double jitter,
                           bool point_rows, double tip_radius_max_m) {
    const tissue::TetMesh mesh = tissue::box_mesh(size_m, cells, jitter);
    const std::vector<std::uint8_t> anchored = bottom_anchored(mesh);
    tissue::ContactSurface skin = top_skin(size_m, 4e-3);
    tissue::make_footprints(
        mesh, anchored,
        {.order = 2, .tip_radius_max_m = tip_radius_max_m, .point_rows = point_rows}, skin);
    return {mesh, anchored, skin, 2};
}

double regular_mpn(double x_m, double y_m, int axis) {
    const double dx = (x_m - 40e-3) / 20e-3, dy = (y_m - 40e-3) / 20e-3;
    const double out = 0.5 * (dx * dx + dy * dy); // 1 at (20, 20) mm
    return axis == 2 ? 1e-3 * (-1.57 + 0.92 * out) : 1e-3 * (1.2 + 3.2 * out);
}

double reference_stiffness_npm(double x_m, double y_m, int axis, double tip_radius_m) {
    const double ratio = axis == 2 ? 1.0 : (2.0 - kPoisson) / (2.0 * (1.0 - kPoisson));
    const double local = ratio * (1.0 - kPoisson * kPoisson) / (2.0 * kYoung_pa * tip_radius_m);
    return 1.0 / (local + regular_mpn(x_m, y_m, axis));
}

Spread spread(const PressedBlock& pressed, int axis, double tip_radius_m, const Parts& parts) {
    std::mt19937_64 random(1);
    Spread s{0.0, 0.0, 1e9, 0.0};
    constexpr int kPlaces = 50;
    double squares = 0.0;
    for (int i = 0; i < kPlaces; ++i) {
        const double x_m = 20e-3 + 40e-3 * static_cast<double>(random() >> 11) * 0x1p-53;
        const double y_m = 20e-3 + 40e-3 * static_cast<double>(random() >> 11) * 0x1p-53;
        const double k = pressed.stiffness_npm(x_m, y_m, axis, tip_radius_m, parts) /
                         reference_stiffness_npm(x_m, y_m, axis, tip_radius_m);
        s.mean += k / kPlaces;
        squares += k * k / kPlaces;
        s.low = std::min(s.low, k);
        s.high = std::max(s.high, k);
    }
    s.deviation = std::sqrt(std::max(0.0, squares - s.mean * s.mean)) / s.mean;
    return s;
}

double worst_slide_step(const PressedBlock& pressed, int axis, double tip_radius_m,
                        const Parts& parts) {
    double last = 0.0, worst = 0.0;
    slide([&](double x_m, double y_m) {
        const double k = pressed.stiffness_npm(x_m, y_m, axis, tip_radius_m, parts);
        worst = last > 0.0 ? std::max(worst, std::abs(k / last - 1.0)) : 0.0;
        last = k;
    });
    return worst;
}

double worst_force_step_n(const PressedBlock& pressed, double depth_m, const tissue::SphereLaw& law,
                          double tip_radius_m) {
    double last = -1.0, worst = 0.0;
    slide([&](double x_m, double y_m) {
        const double force = pressed.force_n(x_m, y_m, depth_m, law, tip_radius_m);
        worst = last >= 0.0 ? std::max(worst, std::abs(force - last)) : 0.0;
        last = force;
    });
    return worst;
}

} // namespace block
