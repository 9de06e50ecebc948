// sim/session/person.cpp
// A session for one person at mouse and keyboard, and scripted assistants for what he lets go.
#include "sim/session/session.h"

namespace sim {

void give_to_person(Session& session) {
    const Scene& scene = session.scene.scene;
    const tasks::Exercise& exercise = session.exercise;
    const tasks::HandSkill skill = tasks::skill_named("expert");
    const std::uint64_t seed = session.options.seed;
    session.crew = make_mouse_crew(scene, session.haptics);
    Crew& crew = session.crew;
    give_scope(crew, session.haptics);
    if (crew.scope && exercise.scope == tasks::ScopeHold::assistant)
        crew.camera.emplace(skill, exercise, seed, start_goal(scene.view, scene.look_at_m));
    if (exercise.kind != tasks::ExerciseKind::find_tubes)
        return;
    crew.hand.emplace<tasks::FindHand>(skill, exercise, seed, start_tips(scene));
    crew.pointer.held.fill(false);
    crew.pointer.held[kFirstTool] = true;
}

} // namespace sim
