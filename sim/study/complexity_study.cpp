// See the header.
#include "sim/study/complexity_study.h"

#include "tissue/response/footprint.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <malloc.h>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace sim {
namespace {

constexpr glm::dvec3 kSize_m{0.08, 0.08, 0.04};
constexpr double kTip_m = 1.5e-3, kStep_s = 0.01;

double heap_megabytes() {
    const struct mallinfo2 m = mallinfo2();
    return 1e-6 * static_cast<double>(m.uordblks + m.hblkhd);
}

// Cells across for about so many nodes. A box of n x n x n/2 cells has that many corners, and about
// seven edges to each.
std::array<int, 3> cells_for(int nodes, bool quadratic) {
    const auto count = [&](int n) {
        const double c = n, half = (n + 1) / 2;
        const double corners = (c + 1) * (c + 1) * (half + 1);
        // along x, y, z, the three diagonals of faces, the one of the cell
        const double edges = c * (c + 1) * (half + 1) * 2 + (c + 1) * (c + 1) * half +
                             c * c * (half + 1) + 2 * c * (c + 1) * half + c * c * half;
        return corners + (quadratic ? edges : 0.0);
    };
    int n = 2;
    while (count(n + 1) <= nodes)
        ++n;
    if (nodes / count(n) > count(n + 1) / nodes)
        ++n;
    return {n, n, (n + 1) / 2};
}

// Clamped below, its top a skin of 2 mm.
std::shared_ptr<const tissue::BakedOrgan> block_of(int nodes, tissue::Tier tier) {
    const bool quadratic = tier == tissue::Tier::quadratic;
    auto organ = std::make_shared<tissue::BakedOrgan>();
    organ->name = "block";
    organ->order = quadratic ? 2 : 1;
    organ->mesh = tissue::box_mesh(kSize_m, cells_for(nodes, quadratic), 0.1);
    for (const glm::dvec3& x : organ->mesh.rest_m)
        organ->anchored.push_back(x.z < 1e-9);
    constexpr std::uint32_t kAcross = 40;
    tissue::ContactSurface& skin = organ->surface;
    for (std::uint32_t j = 0; j <= kAcross; ++j) {
        for (std::uint32_t i = 0; i <= kAcross; ++i) {
            skin.rest_m.push_back({kSize_m.x * i / kAcross, kSize_m.y * j / kAcross, kSize_m.z});
            if (i == kAcross || j == kAcross)
                continue;
            const std::uint32_t v = i + j * (kAcross + 1), up = v + kAcross + 1;
            skin.triangles.push_back({v, v + 1, up + 1});
            skin.triangles.push_back({v, up + 1, up});
        }
    }
    tissue::make_footprints(organ->mesh, organ->anchored,
                            {.order = organ->order, .tip_radius_max_m = kTip_m}, skin);
    organ->tip_radius_max_m = kTip_m;
    return organ;
}

// Round the middle of the block's top, a third of a turn apart.
TipSeats seats() {
    constexpr double kAside_m = 22e-3;
    TipSeats out;
    for (int i = 0; i < kTools; ++i) {
        const double around = 2.0 * std::numbers::pi * i / kTools;
        out[i].place_m = {0.5 * kSize_m.x + kAside_m * std::cos(around),
                          0.5 * kSize_m.y + kAside_m * std::sin(around), kSize_m.z};
    }
    return out;
}

ComplexityRow run_one(const ComplexityOptions& o, int nodes, tissue::Tier tier) {
    ComplexityRow row{.tier = tier};
    const auto organ = block_of(nodes, tier);
    const tissue::Material material{.young_pa = o.young_pa,
                                    .poisson = o.poisson,
                                    .density_kgpm3 = 1060.0,
                                    .damping_mass_1ps = 5.0,
                                    .damping_stiffness_s = 1e-3,
                                    .source = "study"};
    const double heap = heap_megabytes(), begin_s = process_cpu_s();
    std::vector<Body> bodies;
    bodies.push_back(make_body(organ, material, {kTip_m, kTip_m, kTip_m}, kStep_s, tier));
    TissueConfig config;
    config.step_s = kStep_s;
    TissueRig rig = make_tissue_rig(std::move(bodies), config);
    row.setup_s = process_cpu_s() - begin_s;
    row.nodes = tissue::rest_m(rig.bodies[0].soft->solid).size();
    row.tets = organ->mesh.tets.size();
    row.times =
        time_three_tips(rig, seats(), {.radius_m = kTip_m, .depth_m = o.depth_m, .steps = o.steps});
    row.megabytes = heap_megabytes() - heap;
    return row;
}

void check(const ComplexityOptions& o) {
    const auto refuse = [](const std::string& what, const std::string& accepted) {
        throw std::invalid_argument(fmt::format("{}: accepted: {}", what, accepted));
    };
    if (o.nodes.size() < 2)
        refuse(fmt::format("--nodes: {} of them", o.nodes.size()), "two sizes or more");
    for (const int n : o.nodes)
        if (n < 100 || n > 200000)
            refuse(fmt::format("--nodes {}", n), "100 to 200000");
    if (o.steps < 10 || o.steps > 100000)
        refuse(fmt::format("--steps {}", o.steps), "10 to 100000");
    if (!(o.depth_m > 0.0) || o.depth_m > 0.5 * kSize_m.z)
        refuse(fmt::format("--depth {:g}", 1e3 * o.depth_m), "above 0, to 20 mm");
    for (const tissue::Tier tier : o.tiers)
        if (tier == tissue::Tier::rigid)
            refuse("--models rigid",
                   "linear-compliance, corotated, quadratic: nothing rigid steps");
}

} // namespace

Growth growth(std::span<const std::pair<double, double>> nodes_and_y) {
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    const double n = static_cast<double>(nodes_and_y.size());
    for (const auto& [nodes, value] : nodes_and_y) {
        if (!(nodes > 0.0) || !(value > 0.0))
            throw std::invalid_argument(
                fmt::format("growth: {:g} at {:g} nodes: accepted: above 0", value, nodes));
        const double a = std::log(nodes / 1e3), b = std::log(value);
        x += a;
        y += b;
        xx += a * a;
        xy += a * b;
    }
    const double spread = n * xx - x * x;
    if (!(spread > 0.0))
        throw std::invalid_argument("growth: two sizes or more are needed");
    const double exponent = (n * xy - x * y) / spread;
    return {exponent, std::exp((y - exponent * x) / n)};
}

std::vector<ComplexityRow>
run_complexity(const ComplexityOptions& options,
               const std::function<void(const ComplexityRow&)>& progress) {
    check(options);
    std::vector<ComplexityRow> rows;
    for (const int nodes : options.nodes) {
        for (const tissue::Tier tier : options.tiers) {
            rows.push_back(run_one(options, nodes, tier));
            progress(rows.back());
        }
    }
    return rows;
}

} // namespace sim
