#include "sim/session/crew.h"

#include <type_traits>

namespace sim {
namespace {

tasks::HandGoals goals_of(Crew& crew, const tasks::HandSight& sight) {
    return std::visit(
        [&](auto& hand) -> tasks::HandGoals {
            if constexpr (std::is_same_v<std::decay_t<decltype(hand)>, std::monostate>)
                return {};
            else
                return hand.tick(sight);
        },
        crew.hand);
}

// A person at mouse and keyboard: what he does not hold is the assistant's, if there is one.
void move_mouse_crew(Crew& crew, const HapticRig& rig, const tasks::HandGoals& assistant) {
    const bool assisted = !std::holds_alternative<std::monostate>(crew.hand);
    const PointerGoals& person = crew.pointer;
    for (int i = 0; i < kTools; ++i) {
        const bool own = person.held[i] || !assisted;
        const glm::dvec3& tip_m = own ? person.tip_m[i] : assistant.tip_m[i];
        const Instrument& instrument = rig.instrument[i];
        crew.mouse[i]->set_goal(haptics::handle_for_tip(instrument.trocar, tip_m) -
                                instrument.origin_m);
        crew.mouse[i]->set_jaw(own ? person.jaw[i] : assistant.jaw[i]);
    }
}

void move_virtual_crew(Crew& crew, const HapticRig& rig, const tasks::HandGoals& goals) {
    for (int i = 0; i < kTools; ++i) {
        const Instrument& instrument = rig.instrument[i];
        const glm::dvec3 handle = haptics::handle_for_tip(instrument.trocar, goals.tip_m[i]);
        crew.device[i]->set_goal(handle - instrument.origin_m);
        crew.device[i]->set_jaw(goals.jaw[i]);
    }
}

void move_scope(Crew& crew, const HapticRig& rig, const tasks::HandGoals& goals,
                const tasks::HandSight& sight) {
    if (!crew.scope)
        return;
    if (goals.scope.given) {
        hold_scope(rig.scope, goals.scope, *crew.scope);
        return;
    }
    tasks::ScopeGoal assistant; // is told in every tick, so that he knows what he gets back
    if (crew.camera)
        assistant = crew.camera->tick(sight);
    const PointerGoals& person = crew.pointer;
    if (person.scope_held)
        hold_scope(rig.scope,
                   haptics::EndoscopeAim{person.scope_tip_m, person.camera_rad, person.optic_rad},
                   *crew.scope);
    else if (crew.camera)
        hold_scope(rig.scope, assistant, *crew.scope);
}

// A mount keeps it where it was left.
ScopeHolder holder_now(const Crew& crew, const tasks::HandGoals& goals) {
    if (!crew.scope)
        return ScopeHolder::mount;
    if (goals.scope.given || crew.pointer.scope_held)
        return ScopeHolder::person;
    return crew.camera ? ScopeHolder::assistant : ScopeHolder::mount;
}

} // namespace

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

Crew make_mouse_crew(const Scene& scene, HapticRig& rig) {
    Crew crew;
    for (int i = 0; i < kTools; ++i) {
        crew.mouse[i] = std::make_unique<haptics::MouseDevice>(glm::dvec3{0.0});
        rig.instrument[i].device = crew.mouse[i].get();
        rig.instrument[i].metres_per_count = crew.mouse[i]->info().metres_per_count;
    }
    crew.pointer.tip_m = start_tips(scene);
    return crew;
}

std::array<glm::dvec3, kTools> start_tips(const Scene& scene) {
    std::array<glm::dvec3, kTools> start;
    for (int i = 0; i < kTools; ++i)
        start[i] = scene.tool[i].start_tip_m;
    return start;
}

void give_scope(Crew& crew, HapticRig& rig) {
    if (!rig.scope.fitted)
        return;
    crew.scope = std::make_unique<haptics::MouseDevice>(glm::dvec3{0.0});
    rig.scope.device = crew.scope.get();
    rig.scope.metres_per_count = crew.scope->info().metres_per_count;
}

void crew_tick(Crew& crew, HapticRig& rig, const tasks::HandSight& sight) {
    const tasks::HandGoals goals = goals_of(crew, sight);
    if (crew.mouse[0])
        move_mouse_crew(crew, rig, goals);
    else if (!std::holds_alternative<std::monostate>(crew.hand))
        move_virtual_crew(crew, rig, goals);
    move_scope(crew, rig, goals, sight);
    rig.scope.holder = holder_now(crew, goals);
    for (const auto& device : crew.device)
        if (device)
            device->step(kTick_s);
}

} // namespace sim
