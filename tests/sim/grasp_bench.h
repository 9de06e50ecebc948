// tests/sim/grasp_bench.h
// One tool over an organ of a scene, stepped by FEM steps under prescribed tips; its jaws close
// and lift. For the tests of grasping.
#pragma once

#include "sim/session/session.h"
#include "tests/sim/scene_fixture.h"

#include <glm/geometric.hpp>

namespace grasp_tests {

inline constexpr double kRadius_m = 3e-3;

inline constexpr glm::dvec3 kCamera_m{0, 0, 0.2};
inline constexpr glm::dvec3 kOverBlock_m{0.04, 0.04, 0.1}; // of scene_fixture.h

/// One tool on an organ's skin, where it is nearest to `near_m`.
struct Bench {
    sim::LoadedScene loaded;
    sim::TissueRig rig;
    std::unique_ptr<sim::TissueAnswer> answer = std::make_unique<sim::TissueAnswer>();
    sim::ToolsNow tools;
    glm::dvec3 place, normal;
    double jaw = 0.0;

    explicit Bench(std::size_t body = 0, const std::string& scene = "basic",
                   const glm::dvec3& near_m = kCamera_m)
        : loaded(sim::load_scene(scene)), rig(sim::make_tissue(loaded, {}, {})) {
        const sim::Body& organ = rig.bodies[body];
        const auto at = sim::nearest_on(organ, near_m).at;
        place = sim::place_on(organ, at);
        normal = sim::normal_on(organ, at);
        for (int i = 0; i < sim::kTools; ++i)
            tools.tip[i] = {{0.0, 0.0, 1.0}, kRadius_m};
    }
    glm::dvec3 tip(double up_m) const { return place + (kRadius_m + up_m) * normal; }
    // one FEM step, 10 ms, with the tip there
    glm::dvec3 step(const glm::dvec3& tip_m) {
        haptics::ToolTip& tool = tools.tip[0];
        tool.centre_m = tip_m;
        tool.grip = haptics::next_grip({}, tool.grip, jaw, tip_m);
        tools.tick += 10;
        sim::tissue_step(rig, tools, *answer);
        return force();
    }
    glm::dvec3 rest(const glm::dvec3& tip_m, int steps) {
        for (int i = 0; i < steps; ++i)
            step(tip_m);
        return force();
    }
    // pressed, closed, then lifted to `up_m` at 20 mm/s
    void lift(double up_m) {
        rest(tip(-2e-3), 60);
        jaw = 1.0;
        for (double up = -2e-3; up < up_m; up += 2e-4)
            step(tip(up));
    }
    glm::dvec3 force() const { return rig.contact[0].force_n; }
    bool grasped() const { return rig.memory[0].grasped; }
    glm::dvec3 material_place() const { return sim::place_on(rig.bodies[0], rig.contact[0].at); }
    // of the organ, kinetic and elastic
    double energy_j() const {
        const auto& soft = std::get<tissue::CorotatedSolid>(rig.bodies[0].soft->solid);
        double e = tissue::elastic_energy_j(soft.model, soft.state);
        for (std::size_t v = 0; v < soft.state.velocity_mps.size(); ++v) {
            const glm::dvec3 u = soft.state.velocity_mps[v];
            e += 0.5 * soft.model.mass_kg[v] * glm::dot(u, u);
        }
        return e;
    }
};

} // namespace grasp_tests
