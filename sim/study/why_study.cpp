// See the header.
#include "sim/study/why_study.h"

#include "sim/study/motions.h"
#include "sim/study/open_loop.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace sim {
namespace {

LoadedScene scene_of(const WhyOptions& o) {
    LoadedScene loaded = load_scene(o.scene);
    for (SceneOrgan& organ : loaded.scene.organ) {
        if (o.poisson >= 0.0)
            organ.material.poisson = o.poisson;
        if (o.young_pa > 0.0)
            organ.material.young_pa = o.young_pa;
    }
    return loaded;
}

std::vector<TargetWish> targets_of(const tasks::Exercise& exercise) {
    std::vector<TargetWish> wishes;
    for (const tasks::ExerciseTarget& target : exercise.target)
        wishes.push_back({target.at_m, target.organ});
    return wishes;
}

RunOptions attempt_of(const WhyOptions& o, const std::string& exercise, int fem_hz) {
    RunOptions run;
    run.exercise = exercise;
    run.scene = o.scene;
    run.fem_hz = fem_hz;
    run.seed = o.seed;
    run.max_seconds = o.max_seconds;
    return run;
}

// What each FEM step of an expert's attempt sees.
PosedMotion expert(const WhyOptions& o, const std::string& exercise) {
    const std::unique_ptr<Session> session = make_session(attempt_of(o, exercise, o.fem_hz));
    PosedMotion named{exercise, {}, targets_of(session->exercise)};
    session->poses = &named.poses;
    run_lockstep(*session, nullptr, 0);
    return named;
}

// The first fault of an expert's attempt on the chosen tiers, in words. Motions that are no
// exercise have none.
std::string fault_of(const WhyOptions& o, const WhyStudy& study,
                     std::span<const std::string> exercises, const std::string& motion, int hz) {
    if (std::find(exercises.begin(), exercises.end(), motion) == exercises.end())
        return {};
    RunOptions run = attempt_of(o, motion, hz);
    run.model = study.model;
    const Attempt::Outcome outcome = run_lockstep(*make_session(run), nullptr, 0);
    if (outcome.row.rig.faults.empty())
        return {};
    return fmt::format("the expert's attempt at {} then has the fault \"{}\"", motion,
                       outcome.row.rig.faults.front());
}

std::size_t organ_index(const WhyOptions& o, const LoadedScene& loaded) {
    std::vector<std::string> soft;
    for (std::size_t i = 0; i < loaded.organ.size(); ++i) {
        if (loaded.organ[i]->rigid)
            continue;
        if (o.organ.empty() || loaded.scene.organ[i].name == o.organ)
            return i;
        soft.push_back(loaded.scene.organ[i].name);
    }
    throw std::invalid_argument(fmt::format("organ \"{}\": scene \"{}\" has soft organs {}",
                                            o.organ, loaded.scene.id, fmt::join(soft, ", ")));
}

PosedMotion prescribed(const WhyOptions& o, const LoadedScene& loaded, const std::string& name) {
    const std::size_t organ = organ_index(o, loaded);
    const std::vector<Body> bodies = make_bodies(loaded, 1.0 / o.fem_hz);
    const double radius_m = loaded.scene.tool[0].tip_radius_m;
    const glm::dvec3 place_m = o.place_m ? *o.place_m : loaded.scene.look_at_m;
    const Motion motion =
        make_motion(name, o.speed_mps, bodies[organ], place_m, o.heading, radius_m, o.depth_scale);
    PosedMotion named{fmt::format("{} on {}", name, loaded.scene.organ[organ].name), {}, {}};
    const int period = 1000 / o.fem_hz;
    for (std::size_t tick = 0; tick < motion.tip_m.size(); tick += period)
        named.poses.push_back(
            tools_at(static_cast<std::int64_t>(tick), motion, motion.tip_m[tick], radius_m));
    return named;
}

WhyMotion run_motion(const WhyOptions& o, const LoadedScene& loaded, const PosedMotion& named,
                     void (*progress)(const std::string&)) {
    WhyMotion out{.name = named.name, .steps = static_cast<int>(named.poses.size())};
    const double step_s = 1.0 / o.fem_hz;
    for (std::size_t t = 0; t < tissue::kTierNames.size(); ++t) {
        if (progress)
            progress(fmt::format("{}: {} steps of {} tissue", named.name, named.poses.size(),
                                 tissue::kTierNames[t]));
        const ModelChoice choice(loaded.organ.size(), static_cast<tissue::Tier>(t));
        out.track.push_back(run_tier(loaded, named.targets, named.poses, choice, step_s));
    }
    for (std::size_t b = 0; b < loaded.organ.size(); ++b) {
        if (!loaded.organ[b]->rigid)
            out.organ.push_back(
                choose_tier(out.track, static_cast<int>(b), loaded.scene.organ[b].name, step_s));
    }
    for (TierTrack& track : out.track)
        track.step = {};
    return out;
}

// Over all motions: what any of them needs. Only motions that touch an organ say anything of it.
void decide(const LoadedScene& loaded, WhyStudy& study) {
    std::vector<bool> soft;
    for (std::size_t b = 0; b < loaded.organ.size(); ++b) {
        soft.push_back(!loaded.organ[b]->rigid);
        study.organ.push_back(loaded.scene.organ[b].name);
        std::optional<tissue::Tier> needed;
        for (const WhyMotion& motion : study.motion) {
            for (const OrganChoice& organ : motion.organ) {
                if (organ.organ == study.organ.back() && organ.touched)
                    needed = std::max(needed.value_or(organ.tier), organ.tier);
            }
        }
        study.choice.push_back(needed.value_or(kUsualTier));
    }
    study.model = model_text(study.choice, study.organ, soft);
}

} // namespace

WhyStudy run_why_study(const WhyOptions& o, void (*progress)(const std::string&)) {
    if (o.fem_hz <= 0 || 1000 % o.fem_hz != 0)
        throw std::invalid_argument(
            fmt::format("--fem-hz {}: must divide 1000 ticks a second", o.fem_hz));
    if (!(o.depth_scale > 0.0) || !(o.speed_mps > 0.0))
        throw std::invalid_argument(fmt::format("--depth-scale {}, --speed {}: must be above 0",
                                                o.depth_scale, 1e3 * o.speed_mps));
    const LoadedScene loaded = scene_of(o);
    WhyStudy study{.scene = loaded.scene.id, .scene_hash = loaded.hash};
    std::vector<std::string> exercises = o.exercise;
    if (exercises.empty() && o.motion.empty())
        exercises = exercise_names(loaded.place);
    std::vector<PosedMotion> motions;
    for (const std::string& exercise : exercises) {
        if (progress)
            progress(fmt::format("{}: the expert's motion", exercise));
        motions.push_back(expert(o, exercise));
    }
    for (const std::string& motion : o.motion)
        motions.push_back(prescribed(o, loaded, motion));
    if (motions.empty())
        throw std::invalid_argument(
            fmt::format("scene \"{}\" has no exercise of its own: name one, or a motion of {}",
                        study.scene, fmt::join(kMotionNames, ", ")));
    for (const PosedMotion& motion : motions)
        study.motion.push_back(run_motion(o, loaded, motion, progress));
    decide(loaded, study);
    const auto attempt = [&](const PosedMotion& motion, int hz) {
        return fault_of(o, study, exercises, motion.name, hz);
    };
    study.rate = {.asked_hz = o.fem_hz, .hz = o.fem_hz};
    if (o.choose_rate)
        study.rate = choose_rate(loaded, motions, study.choice, o.fem_hz, attempt, progress);
    return study;
}

std::string why_words(const WhyStudy& study) {
    std::string text;
    for (const WhyMotion& motion : study.motion) {
        for (const OrganChoice& organ : motion.organ) {
            if (organ.touched)
                text += fmt::format("{}: {}\n", motion.name, words_of(organ));
        }
    }
    if (!study.rate.tried.empty())
        text += words_of(study.rate) + "\n";
    return text + fmt::format("scene {}: --model {} --fem-hz {}\n", study.scene, study.model,
                              study.rate.hz);
}

} // namespace sim
