#include "sim/session/scene.h"

#include "sim/io/files.h"
#include "tasks/exercise/toml_reader.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <stdexcept>

namespace sim {
namespace {

using tasks::Range;
using tasks::TomlTable;

constexpr Range kPlace_mm{-1000.0, 1000.0};

SceneOrgan parse_organ(const TomlTable& t) {
    t.accept_only({"name", "file", "young_kpa", "poisson", "density_kgpm3", "damping_mass_1ps",
                   "damping_stiffness_ms", "friction"});
    const tissue::Material usual;
    SceneOrgan organ;
    organ.name = t.text("name");
    organ.file = t.text("file");
    tissue::Material& m = organ.material;
    m.young_pa = 1e3 * t.number("young_kpa", {0.1, 1e6}, 1e-3 * usual.young_pa);
    m.poisson = t.number("poisson", {0.0, 0.499}, usual.poisson);
    m.density_kgpm3 = t.number("density_kgpm3", {100.0, 1e4}, usual.density_kgpm3);
    m.damping_mass_1ps = t.number("damping_mass_1ps", {0.0, 1e3}, usual.damping_mass_1ps);
    m.damping_stiffness_s =
        1e-3 * t.number("damping_stiffness_ms", {0.0, 1e3}, 1e3 * usual.damping_stiffness_s);
    m.friction = t.number("friction", {0.0, 2.0}, usual.friction);
    return organ;
}

SceneTool parse_tool(const TomlTable& t) {
    t.accept_only({"role", "fulcrum_mm", "start_tip_mm", "shaft_mm", "tip_radius_mm"});
    SceneTool tool;
    tool.role = static_cast<tasks::Role>(t.choice("role", {"left", "right", "assist"}));
    tool.trocar.fulcrum_m = t.place_mm("fulcrum_mm", kPlace_mm);
    tool.start_tip_m = t.place_mm("start_tip_mm", kPlace_mm);
    tool.trocar.shaft_m = 1e-3 * t.number("shaft_mm", {100.0, 600.0}, 330.0);
    tool.tip_radius_m = 1e-3 * t.number("tip_radius_mm", {0.5, 10.0}, 3.0);
    const double inside = glm::distance(tool.trocar.fulcrum_m, tool.start_tip_m);
    const double least = tool.trocar.min_insertion_m;
    const double most = tool.trocar.shaft_m - tool.trocar.min_outside_m;
    if (inside < least || inside > most) {
        t.refuse("start_tip_mm", fmt::format("a place {:.0f} to {:.0f} mm from the fulcrum",
                                             1e3 * least, 1e3 * most));
    }
    return tool;
}

tasks::View parse_view(const TomlTable& t) {
    t.accept_only({"eye_mm", "look_at_mm", "up", "field_of_view_deg"});
    tasks::View view;
    view.eye_m = t.place_mm("eye_mm", kPlace_mm);
    const glm::dvec3 to = t.place_mm("look_at_mm", kPlace_mm) - view.eye_m;
    if (glm::length(to) < 1e-3)
        t.refuse("look_at_mm", "a place away from eye_mm");
    view.forward = glm::normalize(to);
    const glm::dvec3 up = 1e3 * t.place_mm("up", {-1.0, 1.0});
    const glm::dvec3 right = glm::cross(view.forward, up);
    if (glm::length(right) < 1e-3)
        t.refuse("up", "a direction across the line of sight");
    view.up = glm::normalize(glm::cross(right, view.forward));
    view.field_of_view_rad = glm::radians(t.number("field_of_view_deg", {20.0, 100.0}, 60.0));
    return view;
}

} // namespace

Scene parse_scene(std::string_view text, std::string_view file) {
    const TomlTable root = TomlTable::parse(text, file);
    root.accept_only({"id", "title", "organ", "tool", "view"});
    Scene scene;
    scene.text = text;
    scene.id = root.text("id");
    scene.title = root.text("title");
    for (const TomlTable& t : root.tables("organ"))
        scene.organ.push_back(parse_organ(t));
    if (scene.organ.empty())
        root.refuse("organ", "at least one table written as [[organ]]");
    std::array<bool, kTools> given{};
    for (const TomlTable& t : root.tables("tool")) {
        SceneTool tool = parse_tool(t);
        const auto index = static_cast<std::size_t>(tool.role);
        if (given[index])
            t.refuse("role", "each of left, right, assist once");
        given[index] = true;
        scene.tool[index] = tool;
    }
    for (const bool g : given) {
        if (!g)
            root.refuse("tool", "three tables [[tool]] with roles left, right and assist");
    }
    scene.view = parse_view(root.table("view"));
    return scene;
}

LoadedScene load_organs(Scene scene) {
    LoadedScene loaded{std::move(scene), {}, {}};
    std::string digest(loaded.scene.text);
    for (const SceneOrgan& organ : loaded.scene.organ) {
        const auto path = organ_path(organ.file);
        const std::vector<std::byte> bytes = read_bytes(path);
        digest += sha256_hex(bytes);
        try {
            loaded.organ.push_back(
                std::make_shared<const tissue::BakedOrgan>(tissue::read_organ(bytes)));
        } catch (const std::invalid_argument& e) {
            throw std::invalid_argument(fmt::format("{}: {}", path.string(), e.what()));
        }
    }
    loaded.hash = sha256_hex(std::as_bytes(std::span(digest)));
    return loaded;
}

LoadedScene load_scene(const std::string& scene) {
    const auto path = find_asset("scenes", scene);
    return load_organs(parse_scene(read_text(path), path.string()));
}

TissueRig make_tissue(const LoadedScene& loaded, std::span<const glm::dvec3> target_m,
                      const TissueConfig& config) {
    std::vector<Body> bodies;
    for (std::size_t i = 0; i < loaded.organ.size(); ++i) {
        bodies.push_back(make_body(loaded.organ[i], loaded.scene.organ[i].material,
                                   loaded.scene.tool[0].tip_radius_m, config.step_s));
    }
    TissueRig rig = make_tissue_rig(std::move(bodies), config);
    constexpr double kSnap_m = 10e-3;
    for (std::size_t t = 0; t < target_m.size(); ++t) {
        EmbeddedTarget best;
        double distance = kSnap_m;
        for (std::size_t b = 0; b < rig.bodies.size(); ++b) {
            const Foot foot = nearest_on(rig.bodies[b], target_m[t]);
            if (foot.distance_m >= distance)
                continue;
            distance = foot.distance_m;
            best = {static_cast<int>(b), foot.at};
        }
        if (best.at.triangle == haptics::kNoTriangle) {
            throw std::invalid_argument(fmt::format(
                "target {} at ({:.1f}, {:.1f}, {:.1f}) mm: no skin within {:.0f} mm of it in scene "
                "\"{}\"",
                t + 1, 1e3 * target_m[t].x, 1e3 * target_m[t].y, 1e3 * target_m[t].z, 1e3 * kSnap_m,
                loaded.scene.id));
        }
        rig.targets.push_back(best);
    }
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
    }
    return rig;
}

tasks::Observation observe_trace(const HapticRig& geometry, const tasks::View& view,
                                 const tasks::TickTrace& tick, const TargetPlaces& target_um,
                                 std::span<const tasks::Target> rest_targets) {
    tasks::Observation seen;
    seen.tick = tick.tick;
    seen.view = view;
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
        to.present = (from.flags & 2) != 0;
        for (int axis = 0; axis < 3; ++axis) {
            to.force_n[axis] = from.force_mn[axis] * 1e-3;
            to.contact_m[axis] = from.contact_um[axis] * 1e-6;
        }
    }
    seen.targets = static_cast<int>(rest_targets.size());
    for (int t = 0; t < seen.targets; ++t) {
        seen.target[t].normal = rest_targets[t].normal;
        for (int axis = 0; axis < 3; ++axis) {
            seen.target[t].position_m[axis] = target_um[t][axis] * 1e-6;
        }
    }
    return seen;
}

} // namespace sim
