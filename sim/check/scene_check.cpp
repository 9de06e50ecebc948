#include "sim/check/scene_check.h"

#include "sim/io/files.h"
#include "sim/session/rehold.h"
#include "tasks/exercise/exercise.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace sim {
namespace {

using glm::dvec3;
using tasks::TomlTable;

std::string mm(const dvec3& p) {
    return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", 1e3 * p.x, 1e3 * p.y, 1e3 * p.z);
}

// How much of an organ a hold holds, m^3.
double held_m3(const tissue::BakedOrgan& body, double length_m) {
    if (!tissue::is_rod(body))
        return held_volume_m3(body.bed, length_m);
    double sum_m = 0.0;
    for (const double hold_m : body.line.hold_m)
        sum_m += hold_m;
    return sum_m * length_m * length_m;
}

bool holds_some(const DistanceField& field, const tissue::BakedOrgan& body, double length_m) {
    if (!tissue::is_rod(body))
        return !bed_of(body.mesh, {field}, length_m).empty();
    return held_m3(rod_held_by(
                       body, [&](const dvec3& p) { return field(p) <= 0.0; }, length_m),
                   length_m) > 0.0;
}

// What each anchor holds by itself: one that holds nothing is a mistake that the others hide.
void check_anchors(const LoadedScene& scene, std::size_t index, const TomlTable& table,
                   OrganCheck& organ, std::vector<Finding>& finding) {
    const SceneOrgan& wanted = scene.scene.organ[index];
    const tissue::BakedOrgan& body = *scene.organ[index];
    if (!wanted.anchor.empty())
        organ.held_volume_m3 = held_m3(body, wanted.hold_length_m);
    const std::vector<DistanceField> fields = anchor_fields(scene, index);
    const std::vector<TomlTable> anchors = table.tables("anchor");
    constexpr std::array<const char*, 4> kKey{"low_mm", "centre_mm", "touching", "region"};
    for (std::size_t a = 0; a < fields.size(); ++a) {
        if (holds_some(fields[a], body, wanted.hold_length_m))
            continue;
        finding.push_back(
            {"anchor_empty", anchors[a].mention(kKey[wanted.anchor[a].index()]),
             fmt::format("an anchor that meets \"{}\"; this one holds none of it", organ.name)});
    }
    if (!organ.held) {
        tasks::Mention at = table.mention("anchor");
        at.value.clear();
        finding.push_back({"not_held", at,
                           fmt::format("[[organ.anchor]] tables that hold \"{}\" so that 1 N moves "
                                       "it by 5 mm at most; now it floats",
                                       organ.name)});
    }
}

double mean_edge_m(const tissue::ContactSurface& skin) {
    double sum_m = 0.0;
    for (const tissue::Triangle& t : skin.triangles) {
        for (int k = 0; k < 3; ++k)
            sum_m += glm::distance(skin.rest_m[t[k]], skin.rest_m[t[(k + 1) % 3]]);
    }
    return sum_m / (3.0 * static_cast<double>(skin.triangles.size()));
}

void check_organs(const LoadedScene& scene, std::span<const Solid> solids,
                  const std::vector<TomlTable>& tables, SceneCheck& out) {
    for (std::size_t i = 0; i < scene.organ.size(); ++i) {
        const tissue::BakedOrgan& body = *scene.organ[i];
        OrganCheck organ{.name = scene.scene.organ[i].name,
                         .rigid = body.rigid,
                         .held = is_held(body, scene.scene.organ[i].material),
                         .rod = tissue::is_rod(body),
                         .nodes = body.mesh.rest_m.size() + body.line.node_m.size(),
                         .tets = body.mesh.tets.size(),
                         .volume_m3 = tissue::volume_m3(body.mesh, body.mesh.rest_m) +
                                      tissue::volume_m3(body.line)};
        check_anchors(scene, i, tables[i], organ, out.finding);
        out.organ.push_back(organ);
        for (std::size_t j = 0; j < i; ++j) {
            if (scene.scene.organ[i].runs_into == scene.scene.organ[j].name ||
                scene.scene.organ[j].runs_into == scene.scene.organ[i].name)
                continue;
            const Overlap overlap = overlap_of(solids[i], solids[j]);
            const double edge_m =
                std::max(mean_edge_m(body.surface), mean_edge_m(scene.organ[j]->surface));
            if (overlap.depth_m <=
                std::clamp(kOverlapShare * edge_m, kLeastOverlap_m, kMostOverlap_m))
                continue;
            out.finding.push_back(
                {"overlap", tables[i].mention("name"),
                 fmt::format("organs apart at rest; it overlaps \"{}\", deepest {:.1f} mm at {}",
                             scene.scene.organ[j].name, 1e3 * overlap.depth_m,
                             mm(overlap.place_m))});
        }
    }
}

void check_tools(const LoadedScene& scene, std::span<const Solid> solids, const TomlTable& root,
                 SceneCheck& out) {
    for (const TomlTable& t : root.tables("tool")) {
        const int index = t.choice("role", {"left", "right", "assist"});
        const SceneTool& tool = scene.scene.tool[static_cast<std::size_t>(index)];
        out.tool.push_back({tool.role, glm::distance(tool.start_tip_m, tool.trocar.fulcrum_m)});
        const auto find = [&](const char* kind, const std::string& accepted) {
            out.finding.push_back({kind, t.mention("start_tip_mm"), accepted});
        };
        bool inside = false;
        for (std::size_t b = 0; b < solids.size() && !inside; ++b) {
            const double near_m =
                tissue::nearest_point(solids[b].skin, tool.start_tip_m).distance_m;
            inside = depth_in_m(solids[b], tool.start_tip_m) > 0.0 || near_m < tool.tip_radius_m;
            if (inside)
                find("start_inside", fmt::format("a place free of every organ; the tip starts in "
                                                 "or on \"{}\"",
                                                 scene.scene.organ[b].name));
        }
        const Obstacle in_way = shaft_obstacle(solids, tool.trocar, tool.start_tip_m, -1);
        if (!inside && in_way.body >= 0) {
            find("shaft_blocked",
                 fmt::format("a place that the fulcrum sees; the shaft would pass through \"{}\" "
                             "at {}",
                             scene.scene.organ[in_way.body].name, mm(in_way.place_m)));
        }
    }
}

// The endoscope is where nothing is, at the start.
void check_scope(const LoadedScene& scene, std::span<const Solid> solids, const TomlTable& root,
                 SceneCheck& out) {
    if (!scene.scene.scope)
        return;
    const SceneScope& scope = *scene.scene.scope;
    const haptics::Trocar& trocar = scope.optics.trocar;
    const glm::dvec3& eye_m = scope.start.tip_m;
    out.tool.push_back({tasks::Role::scope, glm::distance(eye_m, trocar.fulcrum_m)});
    const Obstacle in_way = shaft_obstacle(solids, trocar, eye_m, -1);
    if (in_way.body >= 0) {
        out.finding.push_back(
            {"scope_blocked", root.table("scope").mention("fulcrum_mm"),
             fmt::format("a port from which the endoscope comes to its start in "
                         "a straight line; its shaft would pass through \"{}\" "
                         "at {}",
                         scene.scene.organ[in_way.body].name, mm(in_way.place_m))});
    }
}

struct ExerciseText {
    std::string file, text;
};

// All exercises that can be read; the others are mistakes.
std::vector<ExerciseText> read_exercises(const ScenePlace& place, const std::string& wanted,
                                         Mistakes& mistakes) {
    std::vector<ExerciseText> out;
    const auto names = wanted.empty() ? exercise_names(place) : std::vector<std::string>{wanted};
    for (const std::string& name : names) {
        const std::filesystem::path path = find_exercise(place, name);
        ExerciseText exercise{path.string(), read_text(path)};
        try {
            tasks::parse_exercise(exercise.text, exercise.file);
            out.push_back(std::move(exercise));
        } catch (const tasks::BadInput& mistake) {
            mistakes.push_back(mistake);
        }
    }
    return out;
}

} // namespace

SceneCheck check_scene(const std::string& wanted, const std::string& exercise) {
    const ScenePlace place = find_scene(wanted);
    SceneCheck out;
    out.file = place.file.string();
    const std::string text = read_text(place.file);
    Scene scene = parse_scene(text, out.file, &out.mistakes);
    out.id = scene.id;
    const auto exercises = read_exercises(place, exercise, out.mistakes);
    if (scene.organ.empty())
        return out; // the text itself is no good
    const LoadedScene loaded = load_organs(std::move(scene), place, &out.mistakes);
    if (!out.mistakes.empty())
        return out;
    out.hash = loaded.hash;
    const TomlTable root = TomlTable::parse(text, out.file);
    const std::vector<Solid> solids = make_solids(loaded);
    check_organs(loaded, solids, root.tables("organ"), out);
    check_tools(loaded, solids, root, out);
    check_scope(loaded, solids, root, out);
    const std::vector<Body> bodies = make_bodies(loaded, TissueConfig{}.step_s);
    for (const ExerciseText& e : exercises) {
        out.exercise.push_back(check_exercise(loaded, bodies, solids, e.text, e.file));
        for (const Finding& finding : out.exercise.back().finding)
            out.finding.push_back(finding);
    }
    return out;
}

} // namespace sim
