// sim/study/failure_flap.cpp
// F18 on tissue: the flap of its scene between two tips that come from both sides at 50 mm/s, 1 mm
// deep each, answers at 50 Hz and a period late. Beside the force of the same tissue stepped in
// every tick. The last answer's force (`hold`) is that of a flap which nobody has pinched yet.
#include "sim/study/failure_bench.h"

#include "sim/session/scene.h"
#include "sim/study/open_loop.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace sim::failure {
namespace {

constexpr double kSpeed_mps = 0.05, kGap_m = 5e-3, kDeep_m = 1e-3, kRest_s = 0.5;
constexpr double kFelt_n = 1e-3; // a twentieth of what a hand notices
const dvec3 kPlace_m{0.0, -0.02, 0.0};

/// The first organ of the scene alone: the flap.
TissueRig flap_alone(const LoadedScene& loaded, const TissueConfig& config) {
    TissueRig rig = make_tissue(loaded, {}, config);
    rig.bodies.resize(1);
    return rig;
}

struct Pinch {
    Motion motion;
    dvec3 up{0.0}; // from the lower tip to the upper
};

Pinch make_pinch(const Body& flap, double radius_m) {
    const dvec3 skin_m = place_on(flap, nearest_on(flap, kPlace_m).at);
    const auto side_m = [&](double z) {
        return place_on(flap, nearest_on(flap, skin_m + dvec3{0, 0, z}).at);
    };
    const dvec3 above_m = side_m(0.02), below_m = side_m(-0.02);
    Pinch out{.motion = {.name = "pinch", .speed_mps = kSpeed_mps, .tools = 2, .tip_m = {}},
              .up = glm::normalize(above_m - below_m)};
    const int ticks = static_cast<int>(((kGap_m + kDeep_m) / kSpeed_mps + kRest_s) / kTick_s);
    for (int i = 0; i < ticks; ++i) {
        const double gap_m = std::max(-kDeep_m, kGap_m - kSpeed_mps * kTick_s * i) + radius_m;
        out.motion.tip_m.push_back(
            {above_m + gap_m * out.up, below_m - gap_m * out.up, dvec3{0, 0, 1}});
    }
    return out;
}

} // namespace

void pinched_flap(std::uint64_t seed, Rows& rows) {
    const LoadedScene loaded = load_scene("flap");
    const double radius_m = loaded.scene.tool[0].tip_radius_m;
    const auto make_rig = [&](const TissueConfig& config) { return flap_alone(loaded, config); };
    const Pinch pinch = make_pinch(make_rig({}).bodies[0], radius_m);
    const ForceTrack truth = run_monolithic(make_rig, pinch.motion, radius_m, 1);
    for (const auto& [name, coupling] :
         {std::pair{"anchored coupling", Coupling::anchored}, {"hold coupling", Coupling::hold}}) {
        const ForceTrack track = run_coupled(make_rig, pinch.motion, radius_m,
                                             {.coupling = coupling, .fem_hz = 50, .seed = seed});
        int crossed = 0;
        for (const auto& force_n : track)
            crossed += glm::dot(force_n[0], pinch.up) < -kFelt_n ||
                       glm::dot(force_n[1], pinch.up) > kFelt_n;
        const ForceError error = compare(track, truth, 2);
        const auto &last = track.back(), &right = truth.back();
        const double lean_n = glm::length(last[0] + last[1] - right[0] - right[1]);
        rows.at_most("F18", name, "flap: ticks on the wrong side", crossed, 0, false);
        rows.at_most("F18", name, "flap: error of force over its peak",
                     1e-3 * error.worst_mn / error.peak_n, 0.07, coupling == Coupling::hold);
        rows.at_most("F18", name, "flap at rest: sum of forces but its support's, share",
                     lean_n / glm::length(right[0]), 0.02, false);
    }
}

} // namespace sim::failure
