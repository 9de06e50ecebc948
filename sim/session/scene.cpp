#include "sim/session/scene.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace sim {

std::vector<Body> make_bodies(const LoadedScene& loaded, double step_s, const ModelChoice& choice) {
    std::vector<Body> bodies;
    TipRadii tips{};
    for (std::size_t t = 0; t < tips.size(); ++t)
        tips[t] = loaded.scene.tool[t].tip_radius_m;
    for (std::size_t i = 0; i < loaded.organ.size(); ++i) {
        const tissue::Tier tier = choice.empty() ? kUsualTier : choice[i];
        const bool coarse = tier == tissue::Tier::quadratic && loaded.quadratic[i];
        try {
            bodies.push_back(make_body(coarse ? loaded.quadratic[i] : loaded.organ[i],
                                       loaded.scene.organ[i].material, tips, step_s, tier));
        } catch (const std::invalid_argument& e) {
            throw std::invalid_argument(fmt::format("organ \"{}\" of scene \"{}\" as {} tissue: {}",
                                                    loaded.scene.organ[i].name, loaded.scene.id,
                                                    tissue::name_of(tier), e.what()));
        }
    }
    return bodies;
}

std::optional<EmbeddedTarget> snap_target(const LoadedScene& loaded, std::span<const Body> bodies,
                                          const TargetWish& wish) {
    std::optional<EmbeddedTarget> best;
    double distance = kSnap_m;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (!wish.organ.empty() && loaded.scene.organ[b].name != wish.organ)
            continue;
        const Foot foot = nearest_on(bodies[b], wish.at_m);
        if (foot.distance_m >= distance)
            continue;
        distance = foot.distance_m;
        best = {static_cast<int>(b), foot.at};
    }
    return best;
}

void embed_targets(const LoadedScene& loaded, std::span<const TargetWish> targets, TissueRig& rig) {
    for (std::size_t t = 0; t < targets.size(); ++t) {
        const glm::dvec3& at = targets[t].at_m;
        const auto snapped = snap_target(loaded, rig.bodies, targets[t]);
        if (!snapped) {
            throw std::invalid_argument(fmt::format(
                "target {} at ({:.1f}, {:.1f}, {:.1f}) mm: no skin of {} within {:.0f} mm of it in "
                "scene \"{}\"",
                t + 1, 1e3 * at.x, 1e3 * at.y, 1e3 * at.z,
                targets[t].organ.empty() ? "any organ" : targets[t].organ, 1e3 * kSnap_m,
                loaded.scene.id));
        }
        rig.targets.push_back(*snapped);
    }
}

TissueRig make_tissue(const LoadedScene& loaded, std::span<const TargetWish> targets,
                      const TissueConfig& config) {
    TissueRig rig = make_tissue_rig(make_bodies(loaded, config.step_s, config.tier), config);
    embed_targets(loaded, targets, rig);
    return rig;
}

HapticRig make_haptics(const Scene& scene) {
    HapticRig rig;
    for (int i = 0; i < kTools; ++i) {
        const SceneTool& tool = scene.tool[i];
        Instrument& instrument = rig.instrument[i];
        instrument.trocar = tool.trocar;
        instrument.origin_m = haptics::handle_for_tip(tool.trocar, tool.start_tip_m);
        instrument.metres_per_count = tool.metres_per_count;
        instrument.tip_radius_m = tool.tip_radius_m;
        instrument.jaws = tool.jaws;
    }
    rig.scope = make_scope(scene.scope, scene.view);
    return rig;
}

tasks::Observation observe_trace(const HapticRig& geometry, const tasks::TickTrace& tick,
                                 const TissueSeen& tissue,
                                 std::span<const tasks::Target> rest_targets) {
    tasks::Observation seen;
    seen.tick = tick.tick;
    const ScopeNow scope = look_through(geometry.scope, tick.scope);
    seen.view = scope.view;
    seen.scope_present = scope.present;
    seen.horizon_rad = scope.horizon_rad;
    seen.stress_pa = tissue.stress_pa;
    for (int i = 0; i < kTools; ++i) {
        const tasks::ToolTrace& from = tick.tool[i];
        const Instrument& instrument = geometry.instrument[i];
        const ToolPlace place = place_of(instrument, from.counts);
        tasks::ToolObservation& to = seen.tool[i];
        to.tip_m = place.shaft.tip_m;
        to.shaft = place.shaft.direction;
        to.insertion_m = place.shaft.insertion_m;
        to.roll_rad = from.roll_counts * instrument.roll_rad_per_count;
        to.jaw = from.jaw_counts * 1e-3;
        to.touching = (from.flags & 1) != 0;
        to.grasping = (from.flags & 16) != 0;
        to.present = (from.flags & 2) != 0;
        for (int axis = 0; axis < 3; ++axis) {
            to.force_n[axis] = from.force_mn[axis] * 1e-3;
            to.contact_m[axis] = from.contact_um[axis] * 1e-6;
        }
    }
    seen.targets = static_cast<int>(rest_targets.size());
    for (int t = 0; t < seen.targets; ++t) {
        seen.target[t].normal = rest_targets[t].normal;
        seen.target[t].clear_rays = tissue.clear_rays[t];
        for (int axis = 0; axis < 3; ++axis) {
            seen.target[t].position_m[axis] = tissue.target_um[t][axis] * 1e-6;
        }
    }
    return seen;
}

} // namespace sim
