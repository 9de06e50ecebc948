#include "haptics/contact/contact_law.h"

#include <algorithm>
#include <cmath>

namespace haptics {
namespace {

// Index of the level at or below `ratio` and the weight of the next one.
struct Level {
    int index;
    double weight;
};

Level level_of(const IndenterTable& t, double ratio) noexcept {
    int i = 0;
    while (i + 2 < IndenterTable::kLevels && ratio >= t.radius_over_thickness[i + 1])
        ++i;
    const double low = t.radius_over_thickness[i];
    const double high = t.radius_over_thickness[i + 1];
    return {i, std::clamp((ratio - low) / (high - low), 0.0, 1.0)};
}

// Linear interpolation in x and between two levels; also the slope in x. Beyond the table the
// last value stays.
struct Entry {
    double value, slope;
};

Entry lookup(
    const std::array<std::array<double, IndenterTable::kEntries>, IndenterTable::kLevels>& rows,
    const Level& level, double x, double x_step) noexcept {
    const double at = x > 0.0 ? std::min(x / x_step, IndenterTable::kEntries - 1.0) : 0.0;
    const int i = std::min(static_cast<int>(at), IndenterTable::kEntries - 2);
    const double part = at - i;
    const auto mix = [&](int k) {
        return (1.0 - level.weight) * rows[level.index][k] +
               level.weight * rows[level.index + 1][k];
    };
    const double low = mix(i);
    const double high = mix(i + 1);
    return {low + part * (high - low), (high - low) / x_step};
}

// D up to where the law goes on along a slope over force.
struct Stretch {
    double force_n, depth_m, slope_mpn;
};

Stretch stretch_to(const IndenterTable& t, const Level& level, double x) noexcept {
    const Entry g = lookup(t.depth_over_x_m, level, x, t.x_step);
    return {t.force_scale_n * x * x * x, x * g.value,
            (g.value + x * g.slope) / (3.0 * t.force_scale_n * x * x)};
}

// To the end of the table, or to where D's slope, which falls with force, has come to `least_mpn`.
Stretch valid_stretch(const IndenterTable& t, const Level& level, double least_mpn) noexcept {
    Stretch end = stretch_to(t, level, (IndenterTable::kEntries - 1) * t.x_step);
    if (end.slope_mpn >= least_mpn)
        return end;
    double low = t.x_step, high = (IndenterTable::kEntries - 1) * t.x_step;
    while (high - low > 1e-3 * t.x_step) {
        const double x = 0.5 * (low + high);
        (stretch_to(t, level, x).slope_mpn > least_mpn ? low : high) = x;
    }
    end = stretch_to(t, level, low);
    end.slope_mpn = least_mpn;
    return end;
}

double punch_mpn(const IndenterTable& t, const Level& level) noexcept {
    return (1.0 - level.weight) * t.punch_mpn[level.index] +
           level.weight * t.punch_mpn[level.index + 1];
}

} // namespace

LawPoint law_at(const LocalLaw& law, double x) noexcept {
    if (!law.table) {
        const double slope = std::max(law.normal_mpn, law.floor_mpn);
        return {x, slope * x, 1.0, slope};
    }
    const IndenterTable& t = *law.table;
    const Level level = level_of(t, law.radius_over_thickness);
    const double force = t.force_scale_n * x * x * x;
    const double dforce = 3.0 * t.force_scale_n * x * x;

    // At small strain D's slope falls to that of a punch: this linear part keeps the slope of the
    // sum at 1/Kc or more as far as that holds, and D ends where it no longer does
    const double linear = std::max(law.normal_mpn, law.floor_mpn - punch_mpn(t, level));
    const Stretch end = valid_stretch(t, level, law.floor_mpn - linear);

    // beyond the table D goes on along its last slope
    if (force > end.force_n)
        return {force, end.depth_m + end.slope_mpn * (force - end.force_n) + linear * force, dforce,
                (end.slope_mpn + linear) * dforce};
    const Entry g = lookup(t.depth_over_x_m, level, x, t.x_step);
    return {force, x * g.value + linear * force, dforce, g.value + x * g.slope + linear * dforce};
}

double tangential_compliance(const LocalLaw& law, double x) noexcept {
    if (!law.table)
        return std::max(law.tangential_mpn, law.floor_mpn);
    const IndenterTable& t = *law.table;
    const Level level = level_of(t, law.radius_over_thickness);
    // no contact yet: the smallest contact radius that the table can tell apart from none
    const double radius = lookup(t.contact_radius_m, level, std::max(x, t.x_step), t.x_step).value;
    return std::max(t.tangential_m2pn / radius + law.tangential_mpn, law.floor_mpn);
}

GraspCompliance grasp_compliance(const LocalLaw& law) noexcept {
    const IndenterTable& t = *law.table;
    const Level level = level_of(t, law.radius_over_thickness);
    const double x = (IndenterTable::kEntries - 1) * t.x_step;
    const double grown_m = lookup(t.contact_radius_m, level, x, t.x_step).value;
    const double held_mpn = punch_mpn(t, level) * grown_m / kHeldRadius_m;
    return {std::max(held_mpn + law.normal_mpn, law.floor_mpn),
            std::max(t.tangential_m2pn / kHeldRadius_m + law.tangential_mpn, law.floor_mpn)};
}

double contact_radius(const LocalLaw& law, double x) noexcept {
    if (!law.table)
        return 0.0;
    const Level level = level_of(*law.table, law.radius_over_thickness);
    return lookup(law.table->contact_radius_m, level, x, law.table->x_step).value;
}

} // namespace haptics
