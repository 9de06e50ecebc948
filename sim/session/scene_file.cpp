// sim/session/scene_file.cpp
// The text of a scene: organs and their anchors, tools, view. Called when a scene is loaded.
#include "sim/session/scene.h"
#include "tasks/exercise/toml_reader.h"
#include "tissue/material/prony.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace sim {
namespace {

using tasks::Range;
using tasks::TomlTable;

constexpr Range kPlace_mm{-1000.0, 1000.0};
constexpr const char* kInside = "a path inside the scene's directory, without \"..\"";

// Runs one section of the file; with a list of mistakes, one does not hide the next.
template <class Section> void section(Mistakes* mistakes, Section read) {
    if (!mistakes) {
        read();
        return;
    }
    try {
        read();
    } catch (const tasks::BadInput& mistake) {
        const bool said = std::any_of(mistakes->begin(), mistakes->end(), [&](const auto& other) {
            return std::string_view(other.what()) == mistake.what();
        });
        if (!said)
            mistakes->push_back(mistake);
    }
}

void parse_anchors(const TomlTable& organ, SceneOrgan& out, Mistakes* mistakes) {
    for (const TomlTable& t : organ.tables("anchor")) {
        section(mistakes, [&] {
            out.anchor.emplace_back(); // also of a table that is no good: the next keep their place
            const Anchor anchor = parse_anchor(t);
            const auto* region = std::get_if<AnchorRegion>(&anchor);
            if (region && !stays_inside(region->file))
                t.refuse("region", kInside);
            out.anchor.back() = anchor;
        });
    }
}

// Without the key an organ named after what it is looks like it.
view::Look parse_look(const TomlTable& t, const std::string& name) {
    if (!t.has("look"))
        return view::look_named(name);
    return static_cast<view::Look>(
        t.choice("look", {view::kLookWords.begin(), view::kLookWords.end()}));
}

// Shares of the shear modulus at once, young_kpa's, and times: tissue/material/prony.h.
std::vector<tissue::PronyTerm> parse_prony(const TomlTable& t) {
    std::vector<tissue::PronyTerm> terms;
    if (!t.has("prony"))
        return terms;
    double sum = 0.0;
    for (const auto& [share, time_s] :
         t.pairs("prony", "[share, time_s]", tissue::kPronyMost, {0.001, 0.999}, {1e-4, 1e5})) {
        terms.push_back({share, time_s});
        sum += share;
    }
    if (!(sum < 1.0))
        t.refuse("prony", "shares of the shear modulus that sum to less than 1");
    return terms;
}

SceneOrgan parse_organ(const TomlTable& t) {
    t.accept_only({"name", "file", "young_kpa", "poisson", "density_kgpm3", "damping_mass_1ps",
                   "damping_stiffness_ms", "friction", "prony", "anchor", "hold_length_mm", "look",
                   "runs_into"});
    const tissue::Material usual;
    SceneOrgan organ;
    organ.name = t.text("name");
    organ.file = t.text("file");
    if (!stays_inside(organ.file))
        t.refuse("file", kInside);
    tissue::Material& m = organ.material;
    m.young_pa = 1e3 * t.number("young_kpa", {0.1, 1e6}, 1e-3 * usual.young_pa);
    m.poisson = t.number("poisson", {0.0, 0.499}, usual.poisson);
    m.density_kgpm3 = t.number("density_kgpm3", {100.0, 1e4}, usual.density_kgpm3);
    m.damping_mass_1ps = t.number("damping_mass_1ps", {0.0, 1e3}, usual.damping_mass_1ps);
    m.damping_stiffness_s =
        1e-3 * t.number("damping_stiffness_ms", {0.0, 1e3}, 1e3 * usual.damping_stiffness_s);
    m.friction = t.number("friction", {0.0, 2.0}, usual.friction);
    m.prony = parse_prony(t);
    organ.hold_length_m = 1e-3 * t.number("hold_length_mm", {0.1, 1000.0}, 10.0);
    organ.look = parse_look(t, organ.name);
    organ.runs_into = t.text("runs_into", "");
    return organ;
}

tasks::Role role_of(const TomlTable& t) {
    return static_cast<tasks::Role>(t.choice("role", {"left", "right", "assist"}));
}

SceneTool parse_tool(const TomlTable& t) {
    t.accept_only({"role", "fulcrum_mm", "start_tip_mm", "shaft_mm", "tip_radius_mm", "jaw_grip_n",
                   "jaw_friction"});
    SceneTool tool;
    tool.role = role_of(t);
    tool.trocar.fulcrum_m = t.place_mm("fulcrum_mm", kPlace_mm);
    tool.start_tip_m = t.place_mm("start_tip_mm", kPlace_mm);
    tool.trocar.shaft_m = 1e-3 * t.number("shaft_mm", {100.0, 600.0}, 330.0);
    tool.tip_radius_m = 1e-3 * t.number("tip_radius_mm", {0.5, 10.0}, 3.0);
    tool.jaws.grip_n = t.number("jaw_grip_n", {0.0, 20.0}, tool.jaws.grip_n);
    tool.jaws.friction = t.number("jaw_friction", {0.0, 2.0}, tool.jaws.friction);
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

// The endoscope, held so that it looks at the view's place from the view's distance; an oblique
// optic cannot do so from just anywhere, so the eye is where that is possible nearest to eye_mm.
void parse_scope(const TomlTable& t, const TomlTable& view, Scene& scene) {
    t.accept_only({"fulcrum_mm", "shaft_mm", "optic_deg"});
    haptics::Endoscope optics;
    optics.trocar.fulcrum_m = t.place_mm("fulcrum_mm", kPlace_mm);
    optics.trocar.shaft_m = 1e-3 * t.number("shaft_mm", {100.0, 600.0}, 330.0);
    optics.optic_rad = glm::radians(t.number("optic_deg", {0.0, 75.0}, 30.0));
    optics.up = glm::normalize(1e3 * view.place_mm("up", {-1.0, 1.0}));
    const double wanted_m = glm::distance(scene.view.eye_m, scene.look_at_m);
    const haptics::EndoscopeAim start =
        haptics::aim_at(optics, scene.look_at_m, wanted_m, scene.view.eye_m, 0.0);
    const double got_m = glm::distance(start.tip_m, scene.look_at_m);
    constexpr double kRounding_m = 1e-6;
    if (std::abs(got_m - wanted_m) > kRounding_m) {
        t.refuse("fulcrum_mm",
                 fmt::format("a place from where the scope reaches {:.0f} mm before look_at_mm, "
                             "which is how far eye_mm is from it; from here it comes to {:.0f} mm",
                             1e3 * wanted_m, 1e3 * got_m));
    }
    scene.scope = SceneScope{optics, start};
    tasks::ScopeTrace at_start;
    at_start.flags = 2;
    scene.view = look_through(make_scope(scene.scope, scene.view), at_start).view;
}

// Names are how anchors and targets speak of organs.
void check_names(const std::vector<TomlTable>& tables, const TomlTable& t, const Scene& scene) {
    const std::string& name = scene.organ.back().name;
    if (std::count_if(scene.organ.begin(), scene.organ.end(),
                      [&](const SceneOrgan& o) { return o.name == name; }) > 1) {
        t.refuse("name", "a name that no other organ has");
    }
    std::string others;
    for (const TomlTable& o : tables) {
        const std::string other = o.has("name") ? o.text("name") : "";
        if (!other.empty() && other != name)
            others += (others.empty() ? "\"" : ", \"") + other + "\"";
    }
    const auto check_other = [&](const TomlTable& table, const char* key) {
        if (table.has(key) && others.find("\"" + table.text(key) + "\"") == std::string::npos)
            table.refuse(key, "another organ of the scene" +
                                  (others.empty() ? "; there is none" : ": " + others));
    };
    check_other(t, "runs_into");
    for (const TomlTable& a : t.tables("anchor"))
        check_other(a, "touching");
}

void parse_tools(const TomlTable& root, Scene& scene, Mistakes* mistakes) {
    constexpr std::array<const char*, kTools> kRoles{"left", "right", "assist"};
    std::array<bool, kTools> given{};
    for (const TomlTable& t : root.tables("tool")) {
        section(mistakes, [&] {
            const auto index = static_cast<std::size_t>(role_of(t));
            if (given[index])
                t.refuse("role", "each of left, right, assist once");
            given[index] = true;
            scene.tool[index] = parse_tool(t);
        });
    }
    for (std::size_t i = 0; i < kRoles.size(); ++i) {
        section(mistakes, [&] {
            if (!given[i])
                root.refuse("tool", fmt::format("a table [[tool]] with role = \"{}\"; the scene "
                                                "has none",
                                                kRoles[i]));
        });
    }
}

} // namespace

Scene parse_scene(std::string_view text, std::string_view file, Mistakes* mistakes) {
    Scene scene;
    scene.text = text;
    section(mistakes, [&] {
        const TomlTable root = TomlTable::parse(text, file);
        section(mistakes, [&] {
            root.accept_only({"id", "title", "between_organs", "organ", "tool", "view", "scope"});
        });
        section(mistakes, [&] { scene.id = root.text("id"); });
        section(mistakes, [&] { scene.title = root.text("title"); });
        section(mistakes, [&] {
            scene.organs_meet = root.has("between_organs") &&
                                root.choice("between_organs", {"nothing", "contact"}) == 1;
        });
        const std::vector<TomlTable> organs = root.tables("organ");
        for (const TomlTable& t : organs) {
            section(mistakes, [&] {
                scene.organ.emplace_back();
                scene.organ.back() = parse_organ(t);
                parse_anchors(t, scene.organ.back(), mistakes);
                check_names(organs, t, scene);
            });
        }
        section(mistakes, [&] {
            if (organs.empty())
                root.refuse("organ", "at least one table written as [[organ]]");
        });
        section(mistakes, [&] { parse_tools(root, scene, mistakes); });
        section(mistakes, [&] {
            const TomlTable view = root.table("view");
            scene.view = parse_view(view);
            scene.look_at_m = view.place_mm("look_at_mm", kPlace_mm);
            if (root.has("scope"))
                parse_scope(root.table("scope"), view, scene);
        });
    });
    return scene;
}

} // namespace sim
