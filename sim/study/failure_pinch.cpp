// sim/study/failure_pinch.cpp
// F18, a flap between two instruments: a sheet of 3 mm that floats is driven by one ball at 100
// mm/s against another at rest, and held between them. Its vertices come 50 times a second and a
// period late, so both balls see a sheet that is up to 8 mm from where it should be. They must stay
// on their sides, and at rest press with equal forces.
#include "sim/study/failure_bench.h"

#include <algorithm>
#include <cmath>

namespace sim::failure {
namespace {

constexpr double kThick_m = 3e-3, kRadius_m = 1e-3, kStiff_npm = 500.0, kSheet_npm = 2000.0;
constexpr double kSpeed_mps = 0.2, kFrom_m = 5e-3, kOther_m = -0.01, kSqueeze_m = 5e-3;
constexpr int kAnswerTicks = 20, kTicks = 1000;

/// The sheet in equilibrium: carried by what pushes it alone, between two springs squeezed.
struct Sheet {
    double top_m = 0.0, thickness_m = kThick_m;
    double held_n = 0.0; // by both balls, the same

    /// `upper_m`, `lower_m`: the lowest point of the ball above, the highest of the one below.
    void settle(double upper_m, double lower_m) {
        const double overlap_m = kThick_m - (upper_m - lower_m);
        held_n = std::max(0.0, overlap_m / (2.0 / kStiff_npm + 1.0 / kSheet_npm));
        thickness_m = kThick_m - held_n / kSheet_npm;
        top_m = held_n > 0.0 ? upper_m + held_n / kStiff_npm
                             : std::max(std::min(top_m, upper_m), lower_m + kThick_m);
    }
};

struct Pinched {
    int crossed = 0;          // ticks in which a ball is not pushed back to its side, pressed
    double balance = 0.0;     // of the forces at rest, over what they should be
    double force_error = 0.0; // of the larger one
};

Pinched pinch(const ContactMethod& method) {
    Scene upper;
    upper.box({-0.02, -0.02, -kThick_m}, {0.02, 0.02, 0.0});
    upper.ready();
    upper.input.radius_m = ball_m(method, kRadius_m);
    upper.input.stiffness_npm = kStiff_npm;
    Scene lower = upper;
    const std::vector<dvec3> rest = upper.vertex;
    const double radius_m = upper.input.radius_m;
    const double last_m = kOther_m + kThick_m - kSqueeze_m + 2.0 * radius_m;

    Sheet sheet, seen; // as it is, and as the last answer says
    Pinched out;
    for (int i = 0; i < kTicks; ++i) {
        const double upper_m = std::max(last_m, kFrom_m - kSpeed_mps * kTick_s * i);
        if (i % kAnswerTicks == 0) {
            std::vector<dvec3> moved = rest;
            for (dvec3& v : moved)
                v.z = v.z < -0.5 * kThick_m ? sheet.top_m - sheet.thickness_m : sheet.top_m;
            upper.move_to(moved);
            lower.move_to(moved);
            seen = sheet;
            sheet.settle(upper_m - radius_m, kOther_m + radius_m);
        }
        const double push_n = upper.tick(method, {1e-3, 5e-4, upper_m}).force_n.z;
        const double lift_n = lower.tick(method, {1e-3, 5e-4, kOther_m}).force_n.z;
        const double bottom_m = seen.top_m - seen.thickness_m;
        out.crossed += seen.top_m > upper_m - radius_m + 1e-9 && push_n <= 0.0;
        out.crossed += bottom_m < kOther_m + radius_m - 1e-9 && lift_n >= 0.0;
        out.balance = std::abs(push_n + lift_n) / std::max(seen.held_n, 1e-9);
        out.force_error = std::max(std::abs(push_n / std::max(seen.held_n, 1e-9) - 1.0),
                                   std::abs(lift_n / std::max(seen.held_n, 1e-9) + 1.0));
    }
    return out;
}

} // namespace

void pinched_sheet(const ContactMethod& method, std::uint64_t, Rows& rows) {
    const bool wrong =
        method.name == "penalty" || method.name == "god-object" || method.name == "virtual-proxy";
    const Pinched p = pinch(method);
    rows.at_most("F18", method.name, "ticks on the wrong side", p.crossed, 0, wrong);
    // a penalty that has gone through on both sides pulls both balls on, equally
    rows.at_most("F18", method.name, "at rest: sum of the two forces, share", p.balance, 0.02,
                 wrong && method.name != "penalty");
    rows.at_most("F18", method.name, "at rest: error of a force, share", p.force_error, 0.02,
                 wrong);
}

} // namespace sim::failure
