// The shipped recipes of a flap over a pit with tubes: that they fit together, and how the flap
// opens.
#include "assets/bake/bake.h"
#include "assets/bake/centreline.h"
#include "tissue/solver/corotated.h"

#include "tests/bake/recipes_for_tests.h"
#include "tests/bake/shapes_for_tests.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

namespace {

struct Scene {
    std::string ground, flap;
    std::vector<std::string> tubes;
    glm::dvec3 to_hinge; // from the free edge
};
const std::vector<Scene>& scenes() {
    static const std::vector<Scene> list{
        {"ground", "flap", {"artery", "duct", "vein"}, {0, 1, 0}},
        {"ground_b", "flap_b", {"tube_b1", "tube_b2"}, {-1, 0, 0}}};
    return list;
}

bake::Recipe recipe(const std::string& name) {
    return bake::parse_recipe(bake_tests::organ_text(name), name + ".toml");
}
template <typename Shape> Shape shape(const std::string& name) {
    return std::get<Shape>(recipe(name).shape);
}

double smallest_gap_mm(const bake::TubeShape& a, const bake::TubeShape& b) {
    double least = 1e9;
    for (const auto& s : bake::stations(a.point_mm, 300)) {
        for (const auto& t : bake::stations(b.point_mm, 300)) {
            least = std::min(least, glm::length(s.place_mm - t.place_mm));
        }
    }
    return least - std::max(a.radius_mm, a.radius_end_mm) - std::max(b.radius_mm, b.radius_end_mm);
}

// How far a place lies below the ground around it, at least.
double depth_mm(const bake::GroundShape& ground, const glm::dvec3& p) {
    double least = 1e9;
    for (double x = -12.0; x <= 12.0; x += 1.0) {
        for (double y = -12.0; y <= 12.0; y += 1.0) {
            const glm::dvec2 at{p.x + x, p.y + y};
            const glm::dvec3 on{at, bake::ground_height_mm(ground, at)};
            least = std::min(least, glm::length(on - p));
        }
    }
    return bake::ground_height_mm(ground, glm::dvec2{p}) > p.z ? least : -least;
}

// The middle of the flap's free edge brought up and back around the hinge, to 60 mm above its place
// and 45 mm towards the hinge, as jaws would that hold the nodes within 6 mm of it.
struct Opened {
    tissue::BakedOrgan organ;
    std::vector<glm::dvec3> position_m;
    std::vector<double> pull_n;  // on the way
    std::size_t skin_vertex = 0; // in the middle of the jaws
    bool converged = true;
};
Opened open_flap(const Scene& scene) {
    const auto r = recipe(scene.flap);
    Opened opened{.organ = bake::bake(r, {}).organ, .position_m = {}, .pull_n = {}};
    const auto& rest_m = opened.organ.mesh.rest_m;
    const auto& sheet = std::get<bake::SheetShape>(r.shape);
    const double arm_mm = sheet.size_mm.y, out_mm = arm_mm - 45.0;
    const glm::dvec3 middle_m = 1e-3 * (sheet.centre_mm - 0.5 * arm_mm * scene.to_hinge);
    std::vector<std::uint8_t> held;
    for (const auto& x : rest_m) {
        held.push_back(glm::length(x - middle_m) < 6e-3 ? 1 : 0);
    }
    const auto model = tissue::make_corotated(opened.organ.mesh, opened.organ.material, held,
                                              glm::dvec3{0.0}, opened.organ.bed);
    auto state = tissue::rest_state(model);
    std::vector<glm::dvec3> force_n(held.size());
    constexpr int kSteps = 10;
    for (int k = 1; k <= kSteps; ++k) {
        const double share = static_cast<double>(k) / kSteps;
        const double angle = share * std::atan2(60.0, out_mm);
        const double at_mm = arm_mm + share * (std::hypot(60.0, out_mm) - arm_mm);
        const glm::dvec3 by_mm = scene.to_hinge * (arm_mm - at_mm * std::cos(angle)) +
                                 glm::dvec3{0, 0, at_mm * std::sin(angle)};
        for (std::size_t i = 0; i < held.size(); ++i) {
            state.position_m[i] = held[i] ? rest_m[i] + 1e-3 * by_mm : state.position_m[i];
        }
        opened.converged &= tissue::solve_static(model, {}, 1e-8, 60, state).converged;
        tissue::elastic_forces(model, state, force_n);
        glm::dvec3 sum_n{0.0};
        for (std::size_t i = 0; i < held.size(); ++i) {
            sum_n += held[i] ? force_n[i] : glm::dvec3{0.0};
        }
        opened.pull_n.push_back(glm::length(sum_n));
    }
    opened.position_m = state.position_m;
    const auto& skin_m = opened.organ.surface.rest_m;
    const auto nearer = [&](const glm::dvec3& a, const glm::dvec3& b) {
        return glm::length(a - middle_m) < glm::length(b - middle_m);
    };
    opened.skin_vertex = static_cast<std::size_t>(
        std::min_element(skin_m.begin(), skin_m.end(), nearer) - skin_m.begin());
    return opened;
}

} // namespace

TEST_CASE("find-tubes: every tube bakes to a held rod of the skin's volume") {
    for (const Scene& scene : scenes()) {
        for (const std::string& name : scene.tubes) {
            CAPTURE(name);
            const auto baked = bake::bake(recipe(name), {});
            const auto& line = baked.organ.line;
            CHECK(tissue::is_rod(baked.organ));
            CHECK(baked.organ.mesh.rest_m.empty());
            CHECK(std::abs(baked.report.mesh_volume_m3 / baked.report.skin_volume_m3 - 1.0) < 0.02);
            CHECK(line.node_m.size() <= 30);
            // springs at both ends, none in the open
            CHECK(line.hold_m.front() > 0.0);
            CHECK(line.hold_m.back() > 0.0);
            CHECK(line.hold_m[line.hold_m.size() / 2] == 0.0);
            // shear, which a rod has not, is 38.7 (r/L)^2 of the bending between clamps
            const auto tube = shape<bake::TubeShape>(name);
            const double slender = bake::line_length_mm(tube.point_mm) / tube.radius_mm;
            CHECK(38.7 / (slender * slender) < 0.08);
            CHECK_NOTHROW(tissue::read_organ(tissue::write_organ(baked.organ)));
        }
    }
}

TEST_CASE("find-tubes: every recipe bakes to good tetrahedra of the skin's volume") {
    for (const Scene& scene : scenes()) {
        const std::vector<std::string> soft{scene.flap};
        for (const std::string& name : soft) {
            CAPTURE(name);
            const auto baked = bake::bake(recipe(name), {});
            CHECK(baked.report.quality.worst_dihedral_deg >= 15.0);
            CHECK(std::abs(baked.report.mesh_volume_m3 / baked.report.skin_volume_m3 - 1.0) < 0.02);
            CHECK(baked.report.skin_to_mesh_m < 0.6e-3);
            CHECK(baked.report.mesh_to_skin_m < 0.6e-3);
            CHECK(baked.organ.mesh.rest_m.size() <= 300);
            CHECK_FALSE(baked.organ.bed.empty());
            CHECK_NOTHROW(tissue::read_organ(tissue::write_organ(baked.organ)));
            const auto& s = baked.organ.surface;
            for (std::size_t v = 0; v < s.rest_m.size(); ++v) {
                CHECK(s.mesh_term_n_m[v] >= 0.0);
                CHECK(std::isfinite(s.mesh_term_n_m[v] + s.mesh_term_t_m[v]));
            }
        }
        const auto ground = bake::bake(recipe(scene.ground), {});
        CHECK(ground.organ.rigid);
        CHECK_NOTHROW(tissue::read_organ(tissue::write_organ(ground.organ)));
    }
}

TEST_CASE("find-tubes: the flap lies 1 mm above flat ground and covers the pit") {
    for (const Scene& scene : scenes()) {
        CAPTURE(scene.flap);
        const auto ground = shape<bake::GroundShape>(scene.ground);
        const auto skin = bake::sheet_surface(shape<bake::SheetShape>(scene.flap), 0.003);
        glm::dvec2 low{1e9}, high{-1e9};
        for (const auto& p_m : skin.point_m) {
            const glm::dvec3 p = 1e3 * p_m;
            CHECK(p.z - bake::ground_height_mm(ground, glm::dvec2{p}) >= 0.8);
            low = glm::min(low, glm::dvec2{p});
            high = glm::max(high, glm::dvec2{p});
        }
        const auto& pit = ground.pits.at(0);
        const glm::dvec2 overlap =
            glm::min(high - pit.centre_mm, pit.centre_mm - low) - pit.radius_mm;
        CHECK(std::min(overlap.x, overlap.y) >= 8.5);
        CHECK(std::max(overlap.x, overlap.y) <= 10.5);
        // the rounded corners uncover nothing: seen from above, every place of the rim is inside
        // the outline, that is, below some triangle of the skin
        for (int i = 0; i < 90; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / 90;
            const glm::dvec2 q =
                1e-3 *
                (pit.centre_mm + pit.radius_mm * glm::dvec2{std::cos(angle), std::sin(angle)});
            const bool covered =
                std::any_of(skin.triangles.begin(), skin.triangles.end(), [&](const auto& t) {
                    const glm::dvec2 a{skin.point_m[t[0]]}, b{skin.point_m[t[1]]},
                        c{skin.point_m[t[2]]};
                    const auto left = [&](const glm::dvec2& u, const glm::dvec2& v) {
                        return (v.x - u.x) * (q.y - u.y) - (v.y - u.y) * (q.x - u.x) >= 0.0;
                    };
                    return left(a, b) && left(b, c) && left(c, a);
                });
            CHECK(covered);
        }
    }
}

TEST_CASE("find-tubes: tubes keep clear of each other, of the flap and of the pit's floor") {
    for (const Scene& scene : scenes()) {
        const auto flap = shape<bake::SheetShape>(scene.flap);
        const auto ground = shape<bake::GroundShape>(scene.ground);
        const double underside_mm = flap.centre_mm.z - 0.5 * flap.size_mm.z;
        for (std::size_t i = 0; i < scene.tubes.size(); ++i) {
            CAPTURE(scene.tubes[i]);
            const auto tube = shape<bake::TubeShape>(scene.tubes[i]);
            for (std::size_t k = i + 1; k < scene.tubes.size(); ++k) {
                CHECK(smallest_gap_mm(tube, shape<bake::TubeShape>(scene.tubes[k])) >= 1.0);
            }
            for (const auto& s : bake::stations(tube.point_mm, 100)) {
                CHECK(s.place_mm.z + tube.radius_mm <= underside_mm - 4.0);
                CHECK(s.place_mm.z - tube.radius_mm >=
                      ground.centre_mm.z - ground.pits[0].depth_mm + 1.0);
            }
        }
    }
}

TEST_CASE("find-tubes: both ends of every tube lie 6 mm deep in the ground and are held there") {
    for (const Scene& scene : scenes()) {
        const auto ground = shape<bake::GroundShape>(scene.ground);
        for (const std::string& name : scene.tubes) {
            CAPTURE(name);
            const auto r = recipe(name);
            const auto tube = std::get<bake::TubeShape>(r.shape);
            const auto list = bake::stations(tube.point_mm, 200);
            for (const auto& end : {list.front(), list.back()}) {
                CHECK(depth_mm(ground, end.place_mm) >= 6.0);
                CHECK(std::any_of(
                    r.anchor_spheres.begin(), r.anchor_spheres.end(),
                    [&](const auto& a) { return glm::length(a.centre_mm - end.place_mm) < 0.1; }));
            }
            // and a third of it is in the open, in the pit
            const auto open = std::count_if(list.begin(), list.end(), [&](const auto& s) {
                return depth_mm(ground, s.place_mm) < -0.9 * tube.radius_mm;
            });
            CHECK(open > 66);
        }
    }
}

TEST_CASE("find-tubes: the flap is held open by 0.1 to 0.6 N") {
    for (const Scene& scene : scenes()) {
        CAPTURE(scene.flap);
        const Opened opened = open_flap(scene);
        CHECK(opened.converged);
        CHECK(opened.pull_n.back() > 0.1);
        CHECK(*std::max_element(opened.pull_n.begin(), opened.pull_n.end()) < 0.6);
    }
}

TEST_CASE("find-tubes: the flap follows the jaws to within a twentieth of their way") {
    for (const Scene& scene : scenes()) {
        CAPTURE(scene.flap);
        const Opened opened = open_flap(scene);
        const auto& skin = opened.organ.surface;
        const double young_pa = opened.organ.material.young_pa;
        // mesh terms are springs between jaws and skin
        for (const double term_m :
             {skin.mesh_term_n_m[opened.skin_vertex], skin.mesh_term_t_m[opened.skin_vertex]}) {
            CHECK(term_m / young_pa * opened.pull_n.back() < std::hypot(60.0, 45.0) * 1e-3 / 20.0);
        }
    }
}

TEST_CASE("find-tubes: a flap that is let go lies at rest within 2 s and keeps out of the pit") {
    for (const Scene& scene : scenes()) {
        CAPTURE(scene.flap);
        const Opened opened = open_flap(scene);
        const auto& organ = opened.organ;
        const auto model = tissue::make_corotated(organ.mesh, organ.material, organ.anchored,
                                                  glm::dvec3{0.0}, organ.bed);
        auto state = tissue::rest_state(model);
        state.position_m = opened.position_m;
        auto system = tissue::make_system(model);
        std::vector<double> du(static_cast<std::size_t>(model.unknowns));
        constexpr double kStep_s = 5e-3;
        double lowest_m = 0.0;
        for (double t_s = 0.0; t_s < 2.0; t_s += kStep_s) {
            tissue::linearize(model, state, kStep_s, system);
            tissue::free_motion(model, state, system, du);
            tissue::advance(model, du, kStep_s, state);
            for (std::size_t i = 0; i < state.position_m.size(); ++i) {
                lowest_m = std::min(lowest_m, state.position_m[i].z - organ.mesh.rest_m[i].z);
            }
        }
        double off_m = 0.0;
        for (std::size_t i = 0; i < state.position_m.size(); ++i) {
            off_m = std::max(off_m, glm::length(state.position_m[i] - organ.mesh.rest_m[i]));
        }
        CHECK(off_m < 0.1e-3);
        CHECK(lowest_m > -4e-3); // the tubes begin 4 mm below it
    }
}
