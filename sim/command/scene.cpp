// trocar scene check: what a scene lacks, or what a role cannot reach, see or press.
#include "sim/check/scene_check.h"
#include "sim/command/commands.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace sim {
namespace {

using Json = nlohmann::ordered_json;

struct SceneArguments {
    std::string scene, exercise;
    bool json = false;
};

Json problem_json(const std::string& kind, const tasks::Mention& at, const std::string& accepted) {
    return {{"kind", kind},  {"file", at.file},   {"line", at.line},
            {"key", at.key}, {"value", at.value}, {"accepted", accepted}};
}

Json exercise_json(const ExerciseCheck& exercise) {
    Json targets = Json::array();
    for (const TargetCheck& t : exercise.target) {
        targets.push_back({{"id", t.id},
                           {"role", tasks::role_name(t.role)},
                           {"organ", t.organ},
                           {"snap_mm", 1e3 * t.snap_m},
                           {"place_mm", {1e3 * t.place_m.x, 1e3 * t.place_m.y, 1e3 * t.place_m.z}},
                           {"insertion_mm", 1e3 * t.insertion_m},
                           {"shallow_mm", 1e3 * kShallowPress_m},
                           {"shallow_n", t.shallow_n},
                           {"deep_mm", 1e3 * t.deep_m},
                           {"deep_n", t.deep_n}});
    }
    return {{"id", exercise.id}, {"file", exercise.file}, {"targets", targets}};
}

Json check_json(const SceneCheck& check) {
    Json json{{"scene", check.id},
              {"file", check.file},
              {"hash", check.hash},
              {"readable", check.mistakes.empty()},
              {"usable", check.mistakes.empty() && check.finding.empty()}};
    json["organs"] = Json::array();
    for (const OrganCheck& o : check.organ) {
        json["organs"].push_back({{"name", o.name},
                                  {"rigid", o.rigid},
                                  {"rod", o.rod},
                                  {"held", o.held},
                                  {"nodes", o.nodes},
                                  {"tets", o.tets},
                                  {"volume_m3", o.volume_m3},
                                  {"held_volume_m3", o.held_volume_m3}});
    }
    json["tools"] = Json::array();
    for (const ToolCheck& t : check.tool)
        json["tools"].push_back(
            {{"role", tasks::role_name(t.role)}, {"start_insertion_mm", 1e3 * t.insertion_m}});
    json["exercises"] = Json::array();
    for (const ExerciseCheck& e : check.exercise)
        json["exercises"].push_back(exercise_json(e));
    json["problems"] = Json::array();
    for (const tasks::BadInput& m : check.mistakes)
        json["problems"].push_back(problem_json("unreadable", m.at, m.accepted));
    for (const Finding& f : check.finding)
        json["problems"].push_back(problem_json(f.kind, f.at, f.accepted));
    return json;
}

void print(const SceneCheck& check) {
    fmt::print("scene \"{}\"  {}\n", check.id, check.file);
    for (const OrganCheck& o : check.organ) {
        const std::string what =
            o.rigid
                ? "rigid"
                : fmt::format("{}, {:.0f} ml, {}",
                              o.rod ? fmt::format("rod of {} nodes", o.nodes)
                                    : fmt::format("{} nodes, {} tets", o.nodes, o.tets),
                              1e6 * o.volume_m3,
                              !o.held ? "floats"
                              : o.held_volume_m3 > 0.0
                                  ? fmt::format("{:.0f} ml held by anchors", 1e6 * o.held_volume_m3)
                                  : "held as baked");
        fmt::print("  {:<12} {}\n", o.name, what);
    }
    for (const ToolCheck& t : check.tool)
        fmt::print("  {:<12} starts {:.0f} mm inside\n", tasks::role_name(t.role),
                   1e3 * t.insertion_m);
    for (const ExerciseCheck& e : check.exercise) {
        fmt::print("  exercise {}: {} {}s\n", e.id, e.target.size(),
                   tasks::table_of_targets(e.kind));
        for (const TargetCheck& t : e.target) {
            if (t.organ.empty())
                continue;
            const std::string felt =
                t.deep_n > 0.0
                    ? fmt::format(", {:.3f} N at {:.1f} mm, {:.2f} N at {:.1f} mm", t.shallow_n,
                                  1e3 * kShallowPress_m, t.deep_n, 1e3 * t.deep_m)
                    : "";
            fmt::print("    {:<6} {:<7} {:<10} {:.0f} mm inside{}\n", t.id,
                       tasks::role_name(t.role), t.organ, 1e3 * t.insertion_m, felt);
        }
    }
    for (const tasks::BadInput& m : check.mistakes)
        fmt::print("{}\n", m.what());
    for (const Finding& f : check.finding)
        fmt::print("{}\n", text_of(f));
    const std::size_t problems = check.mistakes.size() + check.finding.size();
    if (problems == 0)
        fmt::print("usable: nothing is missing{}\n",
                   check.exercise.empty() ? "; it has no exercise of its own" : "");
    else
        fmt::print("{} problem{}\n", problems, problems == 1 ? "" : "s");
}

} // namespace

void add_scene(CLI::App& app, int& exit_code) {
    CLI::App* scene = app.add_subcommand("scene", "Scene directories");
    scene->require_subcommand(1);
    auto a = std::make_shared<SceneArguments>();
    CLI::App* c = scene->add_subcommand(
        "check", "What a scene lacks, or what a role cannot reach, see or press. Exit 0: usable; "
                 "1: something is out of reach or band; 2: it cannot be read");
    c->add_option("scene", a->scene, "Directory, file or name of a scene")->required();
    c->add_option("--exercise", a->exercise, "Name or file; default: all of the scene's own");
    c->add_flag("--json", a->json, "One JSON object instead of text");
    c->callback([a, &exit_code] {
        const SceneCheck check = check_scene(a->scene, a->exercise);
        if (a->json)
            fmt::print("{}\n", check_json(check).dump());
        else
            print(check);
        exit_code = !check.mistakes.empty() ? 2 : !check.finding.empty() ? 1 : 0;
    });
}

} // namespace sim
