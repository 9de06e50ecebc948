#include "sim/session/crew.h"

#include <type_traits>

namespace sim {

Crew make_crew(const Scene& scene, HapticRig& rig) {
    Crew crew;
    for (int i = 0; i < kTools; ++i) {
        haptics::VirtualDeviceModel model;
        model.info.metres_per_count = scene.tool[i].metres_per_count;
        model.info.max_force_n = rig.instrument[i].limits.max_force_n;
        crew.device[i] = std::make_unique<haptics::VirtualDevice>(model, glm::dvec3{0.0});
        rig.instrument[i].device = crew.device[i].get();
    }
    return crew;
}

Crew make_mouse_crew(HapticRig& rig) {
    Crew crew;
    for (int i = 0; i < kTools; ++i) {
        crew.mouse[i] = std::make_unique<haptics::MouseDevice>(glm::dvec3{0.0});
        rig.instrument[i].device = crew.mouse[i].get();
        rig.instrument[i].metres_per_count = crew.mouse[i]->info().metres_per_count;
    }
    return crew;
}

void move_mouse_crew(Crew& crew, const HapticRig& rig, const PointerGoals& goals) noexcept {
    for (int i = 0; i < kTools; ++i) {
        if (!crew.mouse[i])
            continue;
        const Instrument& instrument = rig.instrument[i];
        crew.mouse[i]->set_goal(haptics::handle_for_tip(instrument.trocar, goals.tip_m[i]) -
                                instrument.origin_m);
        crew.mouse[i]->set_jaw(goals.jaw[i]);
    }
}

void crew_tick(Crew& crew, const HapticRig& rig, const tasks::HandSight& sight) {
    std::visit(
        [&](auto& hand) {
            if constexpr (!std::is_same_v<std::decay_t<decltype(hand)>, std::monostate>) {
                const tasks::HandGoals goals = hand.tick(sight);
                for (int i = 0; i < kTools; ++i) {
                    const Instrument& instrument = rig.instrument[i];
                    const glm::dvec3 handle =
                        haptics::handle_for_tip(instrument.trocar, goals.tip_m[i]);
                    crew.device[i]->set_goal(handle - instrument.origin_m);
                    crew.device[i]->set_jaw(goals.jaw[i]);
                }
            }
        },
        crew.hand);
    for (const auto& device : crew.device)
        if (device)
            device->step(kTick_s);
}

} // namespace sim
