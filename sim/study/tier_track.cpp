// See the header.
#include "sim/study/tier_track.h"

#include <algorithm>
#include <ctime>
#include <glm/geometric.hpp>
#include <memory>

namespace sim {
namespace {

double cpu_ms() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

// Beside a tip the skin is theory within the kernel and a mean over it, and how wide the kernel is
// belongs to the mesh: what tiers show there says nothing of the tissue.
bool is_clear(const TissueRig& rig, const ToolsNow& tools, const EmbeddedTarget& target) {
    constexpr double kKernels = 2.0; // of the force, and of the place that is looked at
    const Body& body = rig.bodies[target.body];
    for (int i = 0; i < kTools; ++i) {
        const FemContact& contact = rig.contact[i];
        if (contact.body != target.body || contact.force_n == glm::dvec3{0.0} || !body.soft)
            continue;
        const tissue::ContactSurface& skin = body.organ->surface;
        const double radius_m = skin.footprint_radius_m[skin.triangles[contact.at.triangle][0]];
        if (glm::distance(place_on(body, target.at), tools.tip[i].centre_m) < kKernels * radius_m)
            return false;
    }
    return true;
}

TierSample sample_of(const TissueRig& rig, const ToolsNow& tools, const TissueAnswer& answer) {
    TierSample sample{};
    for (int i = 0; i < kTools; ++i) {
        const FemContact& contact = rig.contact[i];
        sample.body[i] = contact.body;
        sample.tip_m[i] = tools.tip[i].centre_m;
        if (contact.body < 0)
            continue;
        sample.force_n[i] = contact.force_n;
        sample.skin_m[i] = skin_under(rig, i);
    }
    sample.target_um = answer.seen.target_um;
    for (std::size_t t = 0; t < rig.targets.size() && t < sample.clear.size(); ++t)
        sample.clear[t] = is_clear(rig, tools, rig.targets[t]);
    return sample;
}

} // namespace

TierTrack run_tier(const LoadedScene& scene, std::span<const TargetWish> targets,
                   const Poses& poses, const ModelChoice& choice, double step_s) {
    TissueConfig config;
    config.step_s = step_s;
    config.organs_meet = scene.scene.organs_meet;
    config.tier = choice;
    TissueRig rig = make_tissue(scene, targets, config);
    TierTrack track{.choice = choice};
    track.targets = static_cast<int>(rig.targets.size());
    for (const EmbeddedTarget& target : rig.targets)
        track.target_body.push_back(target.body);
    const auto answer = std::make_unique<TissueAnswer>();
    std::vector<double> ms;
    for (const ToolsNow& tools : poses) {
        const double start_ms = cpu_ms();
        const StepOutcome outcome = tissue_step(rig, tools, *answer);
        ms.push_back(cpu_ms() - start_ms);
        track.linear_residual = std::max(track.linear_residual, outcome.linear_residual);
        track.residual = std::max(track.residual, outcome.residual);
        track.inverted += outcome.inverted > 0;
        track.step.push_back(sample_of(rig, tools, *answer));
    }
    for (const double t : ms)
        track.mean_ms += t / static_cast<double>(ms.size());
    if (!ms.empty()) {
        std::sort(ms.begin(), ms.end());
        track.p99_ms = ms[static_cast<std::size_t>(0.99 * static_cast<double>(ms.size() - 1))];
    }
    return track;
}

} // namespace sim
