#include "sim/check/exercise_check.h"

#include "tasks/exercise/exercise.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

namespace sim {
namespace {

using glm::dvec3;
using tasks::TomlTable;

std::string mm(const dvec3& p) {
    return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", 1e3 * p.x, 1e3 * p.y, 1e3 * p.z);
}

class Checker {
  public:
    Checker(const LoadedScene& scene, std::span<const Body> bodies, std::span<const Solid> solids,
            const tasks::Exercise& exercise, const TomlTable& root)
        : scene_(scene), bodies_(bodies), solids_(solids), exercise_(exercise), root_(root),
          tables_(root.tables(tasks::table_of_targets(exercise.kind))), feel_(bodies.size()) {}

    ExerciseCheck run() {
        ExerciseCheck out;
        out.id = exercise_.id;
        out.kind = exercise_.kind;
        if (exercise_.lift)
            check_lift(root_.table("lift"));
        for (std::size_t t = 0; t < exercise_.target.size(); ++t)
            out.target.push_back(check(t, out));
        out.finding = std::move(finding_);
        return out;
    }

  private:
    struct Place {
        std::size_t body = 0;
        haptics::SurfacePoint at;
        dvec3 place_m{0.0}, normal{0.0};
    };

    void find(const char* kind, const TomlTable& table, const char* key, std::string accepted) {
        finding_.push_back({kind, table.mention(key), std::move(accepted)});
    }
    const std::string& name(int body) const { return scene_.scene.organ[body].name; }

    TargetCheck check(std::size_t t, const ExerciseCheck& before) {
        const tasks::ExerciseTarget& target = exercise_.target[t];
        TargetCheck out;
        out.id = target.id;
        out.role = target.role;
        const auto snapped = snap_target(scene_, bodies_, {target.at_m, target.organ});
        if (!snapped) {
            find_no_skin(target, tables_[t]);
            return out;
        }
        Place place{static_cast<std::size_t>(snapped->body), snapped->at, {}, {}};
        place.place_m = place_on(bodies_[place.body], place.at);
        place.normal = normal_on(bodies_[place.body], place.at);
        out.organ = name(snapped->body);
        out.place_m = place.place_m;
        out.snap_m = glm::distance(target.at_m, place.place_m);
        check_neighbours(out, before, tables_[t]);
        check_reach(place, out, tables_[t]);
        if (exercise_.kind == tasks::ExerciseKind::find_tubes) {
            check_hiding(place, tables_[t]);
        } else {
            check_sight(place, tables_[t]);
            check_band(place, out, tables_[t]);
        }
        return out;
    }

    // What is taken hold of: on a soft organ that something holds, within reach there and where it
    // is brought to.
    void check_lift(const TomlTable& table) {
        const tasks::Lift& lift = *exercise_.lift;
        const auto snapped = snap_target(scene_, bodies_, {lift.at_m, lift.organ});
        if (!snapped) {
            find_no_skin({"lift", lift.role, lift.at_m, lift.organ}, table);
            return;
        }
        lifted_ = snapped->body;
        const Body& body = bodies_[static_cast<std::size_t>(lifted_)];
        if (!body.soft || !is_held(*body.organ, body.material)) {
            find("not_soft", table, "at_mm",
                 fmt::format("a place on a soft organ that something holds; \"{}\" is not",
                             name(lifted_)));
        }
        TargetCheck there;
        there.role = lift.role;
        check_insertion(lift.to_m, there, table, "to_mm");
        const dvec3 normal = normal_on(body, snapped->at);
        check_reach(
            {static_cast<std::size_t>(lifted_), snapped->at, place_on(body, snapped->at), normal},
            there, table);
    }

    // A tube has to be hidden at rest, and seen once what hides it is out of the way, from where
    // an endoscope that looks at it makes its mark large enough.
    void check_hiding(const Place& place, const TomlTable& table) {
        const Scene& scene = scene_.scene;
        if (!scene.scope) {
            if (std::exchange(no_scope_said_, true))
                return;
            find("no_scope", root_, "kind",
                 fmt::format("a kind for a fixed picture; for this one scene \"{}\" needs a table "
                             "[scope]",
                             scene.id));
            return;
        }
        const double distance_m =
            exercise_.mark_radius_m /
            (exercise_.least_share * std::tan(0.5 * scene.view.field_of_view_rad));
        const dvec3 eye_m = haptics::aim_at(scene.scope->optics, place.place_m, distance_m,
                                            scene.scope->start.tip_m, 0.0)
                                .tip_m;
        if (glm::distance(eye_m, place.place_m) > distance_m * (1.0 + 1e-6)) {
            find(
                "too_far", table, "at_mm",
                fmt::format("a place that the endoscope comes near enough to: {:.0f} mm for a mark "
                            "of least_share",
                            1e3 * distance_m));
            return;
        }
        const Obstacle hides = sight_obstacle(solids_, eye_m, place.place_m, place.normal, lifted_);
        if (hides.body >= 0) {
            find("hidden", table, "at_mm",
                 fmt::format("a place that the endoscope sees once \"{}\" is lifted; \"{}\" hides "
                             "it at {}",
                             lifted_ < 0 ? "nothing" : name(lifted_), name(hides.body),
                             mm(hides.place_m)));
        } else if (lifted_ >= 0 &&
                   sight_obstacle(solids_, eye_m, place.place_m, place.normal).body < 0) {
            find("not_hidden", table, "at_mm",
                 fmt::format("a place that \"{}\" hides until it is lifted", name(lifted_)));
        }
    }

    void find_no_skin(const tasks::ExerciseTarget& target, const TomlTable& table) {
        std::string names;
        double nearest_m = std::numeric_limits<double>::max();
        std::string nearest;
        for (std::size_t b = 0; b < bodies_.size(); ++b) {
            const std::string& organ = scene_.scene.organ[b].name;
            names += (names.empty() ? "\"" : ", \"") + organ + "\"";
            if (!target.organ.empty() && organ != target.organ)
                continue;
            const double distance_m = nearest_on(bodies_[b], target.at_m).distance_m;
            if (distance_m < nearest_m) {
                nearest_m = distance_m;
                nearest = organ;
            }
        }
        if (nearest.empty()) {
            find("unknown_organ", table, "organ", "an organ of the scene: " + names);
            return;
        }
        find("no_skin", table, "at_mm",
             fmt::format("a place within {:.0f} mm of the skin of {}; it is {:.1f} mm from \"{}\"",
                         1e3 * kSnap_m, target.organ.empty() ? "an organ" : "that organ",
                         1e3 * nearest_m, nearest));
    }

    void check_neighbours(const TargetCheck& target, const ExerciseCheck& before,
                          const TomlTable& table) {
        for (const TargetCheck& other : before.target) {
            if (other.organ.empty() || other.role != target.role ||
                exercise_.kind != tasks::ExerciseKind::touch_points)
                continue;
            const double distance_m = glm::distance(other.place_m, target.place_m);
            if (distance_m < 2.0 * exercise_.radius_m) {
                find("targets_too_near", table, "at_mm",
                     fmt::format("a place two radii or more from target \"{}\" of the same role; "
                                 "on the skin they are {:.1f} mm apart",
                                 other.id, 1e3 * distance_m));
            }
        }
    }

    bool check_insertion(const dvec3& tip_m, TargetCheck& out, const TomlTable& table,
                         const char* key) {
        const haptics::Trocar& trocar =
            scene_.scene.tool[static_cast<std::size_t>(out.role)].trocar;
        out.insertion_m = glm::distance(tip_m, trocar.fulcrum_m);
        const double least_m = trocar.min_insertion_m;
        const double most_m = trocar.shaft_m - trocar.min_outside_m;
        if (out.insertion_m >= least_m && out.insertion_m <= most_m)
            return true;
        find("out_of_reach", table, key,
             fmt::format("a place that the {} tool reaches, {:.0f} to {:.0f} mm from its fulcrum; "
                         "here its tip would be {:.0f} mm from it",
                         tasks::role_name(out.role), 1e3 * least_m, 1e3 * most_m,
                         1e3 * out.insertion_m));
        return false;
    }

    void check_reach(const Place& place, TargetCheck& out, const TomlTable& table) {
        const SceneTool& tool = scene_.scene.tool[static_cast<std::size_t>(out.role)];
        const dvec3 tip_m = place.place_m + tool.tip_radius_m * place.normal;
        if (!check_insertion(tip_m, out, table, "at_mm"))
            return;
        const std::string role(tasks::role_name(out.role));
        const Obstacle in_way =
            shaft_obstacle(solids_, tool.trocar, tip_m, static_cast<int>(place.body), lifted_);
        if (in_way.body >= 0) {
            find(
                "shaft_blocked", table, "at_mm",
                fmt::format("a place that the {} tool reaches from its fulcrum in a straight line; "
                            "its shaft would pass through \"{}\" at {}",
                            role, name(in_way.body), mm(in_way.place_m)));
        }
    }

    void check_sight(const Place& place, const TomlTable& table) {
        const tasks::View& view = scene_.scene.view;
        if (!tasks::in_view(view, place.place_m)) {
            find("out_of_view", table, "at_mm",
                 fmt::format("a place in the endoscope's picture, {:.0f} degrees high",
                             view.field_of_view_rad * 57.29577951308232));
            return;
        }
        const Obstacle hides = sight_obstacle(solids_, view.eye_m, place.place_m, place.normal);
        if (hides.body >= 0) {
            find("hidden", table, "at_mm",
                 fmt::format("a place that the endoscope sees; \"{}\" hides it at {}",
                             name(hides.body), mm(hides.place_m)));
        }
    }

    RestFeel& feel(std::size_t body) {
        if (!feel_[body])
            feel_[body] = std::make_unique<RestFeel>(bodies_[body]);
        return *feel_[body];
    }

    // The way through the body along the inward normal.
    double thickness_m(const Place& place) const {
        constexpr double kBelowSkin_m = 0.2e-3, kFar_m = 1.0;
        const auto hits = tissue::line_hits(solids_[place.body].skin, place.place_m, -place.normal,
                                            kBelowSkin_m, kFar_m);
        return !solids_[place.body].closed || hits.empty() ? kFar_m : hits.front().distance_m;
    }

    void check_band(const Place& place, TargetCheck& out, const TomlTable& table) {
        const Body& body = bodies_[place.body];
        const SceneTool& tool = scene_.scene.tool[static_cast<std::size_t>(out.role)];
        RestFeel& rest = feel(place.body);
        if (!rest.firm() || !is_held(*body.organ, body.material)) {
            find("not_held", table, "at_mm",
                 fmt::format("a place on an organ that something holds; nothing holds \"{}\", so "
                             "no press meets resistance",
                             out.organ));
            return;
        }
        const TissueRig usual; // for its devices
        const dvec3 tip_m = place.place_m + tool.tip_radius_m * place.normal;
        const haptics::ShaftPose shaft =
            haptics::shaft_pose(tool.trocar, haptics::handle_for_tip(tool.trocar, tip_m));
        const haptics::LocalLaw law = law_on(body, place.at, static_cast<int>(out.role),
                                             coupling_floor_mpn(shaft, usual.device_npm[0]));
        const double mesh_mpn =
            glm::dot(place.normal, rest.mesh_compliance(place.at) * place.normal);
        out.deep_m = std::min(kDeepPress_m, kDeepShare * thickness_m(place));
        out.shallow_n = press_force_n(law, mesh_mpn, kShallowPress_m, tool.tip_radius_m);
        out.deep_n = press_force_n(law, mesh_mpn, out.deep_m, tool.tip_radius_m);
        if (out.deep_n < exercise_.force_min_n) {
            find_band("band_too_high", "force_min_n", exercise_.force_min_n,
                      fmt::format("at most {:.3g}, which target \"{}\" on \"{}\" gives {:.1f} mm "
                                  "deep, or firmer tissue",
                                  out.deep_n, out.id, out.organ, 1e3 * out.deep_m));
        }
        if (out.shallow_n > exercise_.force_max_n) {
            find_band("band_too_low", "force_max_n", exercise_.force_max_n,
                      fmt::format("at least {:.3g}, which target \"{}\" on \"{}\" gives {:.1f} mm "
                                  "deep, or softer tissue",
                                  out.shallow_n, out.id, out.organ, 1e3 * kShallowPress_m));
        }
    }

    // The limits of the band are the exercise's, and may be the built-in ones.
    void find_band(const char* kind, const char* key, double value, std::string accepted) {
        tasks::Mention at = root_.mention(key);
        if (at.value.empty())
            at.value = fmt::format("{} (built in)", value);
        finding_.push_back({kind, std::move(at), std::move(accepted)});
    }

    const LoadedScene& scene_;
    std::span<const Body> bodies_;
    std::span<const Solid> solids_;
    const tasks::Exercise& exercise_;
    const TomlTable& root_;
    std::vector<TomlTable> tables_;
    std::vector<std::unique_ptr<RestFeel>> feel_; // beside bodies_, made when asked
    std::vector<Finding> finding_;
    int lifted_ = -1; // body that is out of the way while tubes are looked for
    bool no_scope_said_ = false;
};

} // namespace

ExerciseCheck check_exercise(const LoadedScene& scene, std::span<const Body> bodies,
                             std::span<const Solid> solids, const std::string& text,
                             const std::string& file) {
    const tasks::Exercise exercise = tasks::parse_exercise(text, file);
    const TomlTable root = TomlTable::parse(text, file);
    ExerciseCheck out = Checker(scene, bodies, solids, exercise, root).run();
    out.file = file;
    return out;
}

} // namespace sim
