// tests/haptics/mass_spring.h
// A slab on a spring and a damper, pressed from above by spheres through a series compliance:
// the closed-form implicit Euler step, for any dt, and the local model that describes it.
//   m v'/dt + c v' + k z' = m v/dt - sum P,  z' = z + dt v',  depth_i = floor P_i
#pragma once

#include "tests/haptics/hand_made_models.h"

#include <algorithm>
#include <cmath>

struct MassSpring {
    double mass_kg = 0.02;
    double stiffness_npm = 300.0;
    double damping_nspm = 0.9;
    double series_mpn = 1.0 / 800.0;
    double tip_radius_m = 3e-3;
    double z_m = 0.0; // of the slab's surface; rest at 0
    double v_mps = 0.0;

    /// Advances by dt under one tip at this height; returns the force on it.
    double step(double dt_s, double tip_m) {
        const double inertia = mass_kg / (dt_s * dt_s) + damping_nspm / dt_s;
        const double a = inertia + stiffness_npm;
        const double free_m = (inertia * z_m + mass_kg * v_mps / dt_s) / a;
        const double reach_m = tip_radius_m - (tip_m - free_m);
        const double force = std::max(0.0, reach_m / (1.0 / a + series_mpn));
        const double next_m = free_m - force / a;
        v_mps = (next_m - z_m) / dt_s;
        z_m = next_m;
        return force;
    }

    /// As the tissue loop would publish the present state, with the tip at x, y over the middle.
    void publish(haptics::LocalModels& out, std::int64_t step_number, std::int64_t sample_tick,
                 double force_n) const {
        const double root = std::sqrt(mass_kg);
        out.step = step_number;
        out.sample_tick = sample_tick;
        out.modes = 1;
        out.lambda[0] = stiffness_npm / mass_kg;
        out.damping[0] = damping_nspm / mass_kg;
        out.residual[0] = stiffness_npm * z_m / root;
        out.rate[0] = root * v_mps;
        haptics::ToolPatch& patch = out.tool[0];
        make_flat_patch(patch, {0, 0, z_m}, 0.04, 8);
        patch.modes = 1;
        patch.floor_mpn = series_mpn;
        set_uniform_mode(patch, 0, {0, 0, 1.0 / root});
        patch.force_n = {0, 0, force_n};
        patch.memory.touching = force_n > 0.0;
        patch.memory.x = force_n;
    }
};
