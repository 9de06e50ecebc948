// tests/haptics/sneddon_table.h
// The sphere on a half-space in closed form (Sneddon 1965), and a table made from it.
//   contact radius a_c = a tanh s:  depth = a s tanh s,
//   P = E* a^2 [(1 + tanh^2 s) s - tanh s],  E* = E / (1 - nu^2)
#pragma once

#include "haptics/contact/contact_law.h"

#include <cmath>

struct SneddonSphere {
    double radius_m = 3e-3;
    double plane_modulus_pa = 8e3 / (1.0 - 0.45 * 0.45);

    double depth_m(double s) const { return radius_m * s * std::tanh(s); }
    double force_n(double s) const {
        return plane_modulus_pa * radius_m * radius_m * force_shape(s);
    }
    // (1 + tanh^2 s) s - tanh s, by its series where the difference would cancel
    static double force_shape(double s) {
        const double t = std::tanh(s);
        if (s < 0.02)
            return t * t * s + s * s * s / 3.0 - 2.0 / 15.0 * std::pow(s, 5);
        return (1.0 + t * t) * s - t;
    }
    // s at which shape(s) = value, both growing from 0
    template <typename Shape> static double invert(Shape shape, double value) {
        double low = 0.0;
        double high = 100.0;
        for (int i = 0; i < 200; ++i) {
            const double mid = 0.5 * (low + high);
            (shape(mid) < value ? low : high) = mid;
        }
        return 0.5 * (low + high);
    }
    double force_at_depth_n(double wanted_m) const {
        return force_n(invert([this](double s) { return depth_m(s); }, wanted_m));
    }
};

/// Level k stands for tissue that is 1 + k/2 times as stiff as the half-space: made up, but a
/// law of its own at each level, known in closed form.
inline double stiffening(double radius_over_thickness) {
    return 1.0 + 0.5 * radius_over_thickness;
}

inline haptics::IndenterTable sneddon_table(const SneddonSphere& sphere, double x_step = 0.0125) {
    haptics::IndenterTable t;
    t.force_scale_n = sphere.plane_modulus_pa * sphere.radius_m * sphere.radius_m;
    t.x_step = x_step;
    t.tangential_m2pn = 1.55 / (4.0 * 2.76e3); // (2 - nu) / (8 G) times 2
    for (int level = 0; level < haptics::IndenterTable::kLevels; ++level) {
        t.radius_over_thickness[level] = level;
        for (int i = 0; i < haptics::IndenterTable::kEntries; ++i) {
            const double x = i * x_step;
            const double s = SneddonSphere::invert(SneddonSphere::force_shape, x * x * x);
            const double depth_m = sphere.depth_m(s) / stiffening(level);
            t.depth_over_x_m[level][i] = i == 0 ? 0.0 : depth_m / x;
            t.contact_radius_m[level][i] = sphere.radius_m * std::tanh(s);
        }
        // far in, as far as the table goes
        const int last = haptics::IndenterTable::kEntries - 1;
        const double x = last * x_step;
        const double rise =
            (t.depth_over_x_m[level][last] - t.depth_over_x_m[level][last - 1]) / x_step;
        t.punch_mpn[level] =
            (t.depth_over_x_m[level][last] + x * rise) / (3.0 * t.force_scale_n * x * x);
    }
    return t;
}
