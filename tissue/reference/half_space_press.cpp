// Contact of the round tip in the plane, Newton, and steps of depth.
#include "tissue/reference/half_space_press.h"

#include "tissue/reference/axisymmetric.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace tissue {
namespace {

using glm::dmat2;
using glm::dvec2;
using Moved = std::vector<dvec2>;

struct SkinPoint {
    std::array<int, 3> node{};
    std::array<double, 3> shape{};
    double area = 0.0; // 2 pi r dr at rest
    double pressure = 0.0, limit = 0.0;
    bool bound = false;
    dvec2 bound_at{0.0}; // from the tip's centre
};

struct Contact {
    std::vector<SkinPoint> point;
    double centre_z = 0.0, penalty = 0.0;
};

struct Gap {
    double value;
    dvec2 normal;
    bool beside; // the shaft
};

struct Traction {
    double pressure = 0.0;
    dvec2 normal{0.0}, friction{0.0}, way{0.0};
};

Gap gap_at(const Contact& c, const dvec2& x) {
    const double above = x.y - c.centre_z;
    if (above > 0.0)
        return {x.x - 1.0, {1.0, 0.0}, true};
    const double distance = std::hypot(x.x, above);
    return {distance - 1.0, distance > 0.0 ? dvec2(x.x, above) / distance : dvec2(0, -1), false};
}

dvec2 place_of(const AxisymmetricMesh& mesh, const SkinPoint& p, const Moved& moved) {
    dvec2 x{0.0};
    for (int a = 0; a < 3; ++a)
        x += p.shape[a] * (mesh.rest[p.node[a]] + moved[p.node[a]]);
    return x;
}

dvec2 tangent_of(const Contact& c, const SkinPoint& p) {
    const dvec2 n = gap_at(c, p.bound_at + dvec2(0.0, c.centre_z)).normal;
    return {-n.y, n.x};
}

Traction traction_at(const Contact& c, const SkinPoint& p, const dvec2& x) {
    const Gap gap = gap_at(c, x);
    Traction t{std::max(0.0, p.pressure - c.penalty * gap.value), gap.normal};
    if (!p.bound)
        return t;
    const dvec2 along = tangent_of(c, p);
    t.way = glm::dot(along, x - dvec2(0.0, c.centre_z) - p.bound_at) * along;
    const double s = glm::length(t.way);
    if (s > 0.0)
        t.friction = -std::min(c.penalty * s, p.limit) / s * t.way;
    return t;
}

double contact_energy(const AxisymmetricMesh& mesh, const Contact& c, const Moved& moved) {
    double sum = 0.0;
    for (const SkinPoint& p : c.point) {
        const Traction t = traction_at(c, p, place_of(mesh, p, moved));
        sum += 0.5 * p.area / c.penalty * (t.pressure * t.pressure - p.pressure * p.pressure);
        if (!p.bound)
            continue;
        const double s = glm::length(t.way), k = c.penalty, m = p.limit;
        sum += p.area * (k * s <= m ? 0.5 * k * s * s : m * (s - 0.5 * m / k));
    }
    return sum;
}

void add_contact(AxisymmetricSystem& system, const Contact& c, const Moved& moved, bool projected) {
    for (const SkinPoint& p : c.point) {
        const dvec2 x = place_of(system.mesh, p, moved);
        const Traction t = traction_at(c, p, x);
        if (t.pressure <= 0.0 && !p.bound)
            continue;
        const dvec2 slope = -t.pressure * t.normal - t.friction;
        dmat2 tangent(0.0);
        if (t.pressure > 0.0) {
            const Gap gap = gap_at(c, x);
            tangent += c.penalty * glm::outerProduct(gap.normal, gap.normal);
            if (!projected && !gap.beside) {
                tangent -= t.pressure / (1.0 + gap.value) *
                           (dmat2(1.0) - glm::outerProduct(gap.normal, gap.normal));
            }
        }
        if (p.bound && c.penalty * glm::length(t.way) <= p.limit) {
            const dvec2 along = tangent_of(c, p);
            tangent += c.penalty * glm::outerProduct(along, along);
        }
        for (int a = 0; a < 3; ++a) {
            for (int i = 0; i < 2; ++i) {
                const std::int32_t row = system.mesh.unknown[2 * p.node[a] + i];
                if (row < 0)
                    continue;
                system.slope[row] += p.area * p.shape[a] * slope[i];
                for (int b = 0; b < 3; ++b) {
                    for (int j = 0; j < 2; ++j) {
                        const std::int32_t column = system.mesh.unknown[2 * p.node[b] + j];
                        if (column < 0 || column > row)
                            continue;
                        system.stiffness[entry_of(system.pattern, row, column)] +=
                            p.area * p.shape[a] * p.shape[b] * tangent[j][i];
                    }
                }
            }
        }
    }
}

void learn(const AxisymmetricMesh& mesh, const Moved& moved, double friction, Contact& c) {
    for (SkinPoint& p : c.point) {
        const dvec2 x = place_of(mesh, p, moved);
        const Traction t = traction_at(c, p, x);
        if (p.bound)
            p.bound_at += t.way + t.friction / c.penalty; // what friction does not hold has slipped
        else
            p.bound_at = x - dvec2(0.0, c.centre_z);
        p.bound = t.pressure > 0.0 && friction > 0.0;
        p.pressure = t.pressure;
        p.limit = p.bound ? friction * t.pressure : 0.0;
    }
}

Contact skin_of(const AxisymmetricMesh& mesh, double reach, double penalty) {
    constexpr std::array<double, 3> at{-0.77459666924148338, 0.0, 0.77459666924148338};
    constexpr std::array<double, 3> weight{5.0 / 9, 8.0 / 9, 5.0 / 9};
    Contact c{.point = {}, .penalty = penalty};
    for (int i = 0; i < mesh.columns && mesh.rest[2 * i].x < reach; ++i) {
        const double low = mesh.rest[2 * i].x, half = 0.5 * (mesh.rest[2 * i + 2].x - low);
        for (int k = 0; k < 3; ++k) {
            const double s = at[k];
            c.point.push_back(
                {.node = {2 * i, 2 * i + 1, 2 * i + 2},
                 .shape = {0.5 * s * (s - 1), 1 - s * s, 0.5 * s * (s + 1)},
                 .area = 2 * std::numbers::pi * (low + half * (1 + s)) * half * weight[k]});
        }
    }
    return c;
}

double norm(std::span<const double> v) {
    double sum = 0.0;
    for (const double x : v)
        sum += x * x;
    return std::sqrt(sum);
}

// The least of energy and contact from `moved`. False: not found, `moved` is then of no meaning.
bool find_least(AxisymmetricSystem& system, SparseFactor& factor, const Contact& c, Moved& moved,
                int& iterations) {
    constexpr int kMost = 40;
    constexpr double kTolerance = 1e-7;
    double energy = axisymmetric_energy(system, moved) + contact_energy(system.mesh, c, moved);
    double scale = 0.0;
    bool careful = false;
    for (int pass = 0; pass < kMost; ++pass) {
        linearize(system, moved, careful);
        scale = std::max({scale, norm(system.slope), 1e-6});
        add_contact(system, c, moved, careful);
        if (norm(system.slope) <= kTolerance * scale)
            return true;
        ++iterations;
        std::vector<double> way = system.slope;
        if (!factor.factor(system.stiffness)) {
            if (careful)
                return false;
            careful = true;
            continue;
        }
        factor.solve(way, 1);
        double fall = 0.0;
        for (std::size_t i = 0; i < way.size(); ++i)
            fall += way[i] * system.slope[i];
        double part = 1.0;
        bool found = false;
        for (; part > 1e-4 && !found; part *= 0.5) {
            Moved next = moved;
            for (std::size_t i = 0; i < system.mesh.unknown.size(); ++i) {
                if (const std::int32_t at = system.mesh.unknown[i]; at >= 0)
                    next[i / 2][static_cast<int>(i % 2)] -= part * way[at];
            }
            const double tried =
                axisymmetric_energy(system, next) + contact_energy(system.mesh, c, next);
            // differences of energies below rounding say nothing: such a step is taken
            if (tried <= energy - 1e-4 * part * fall ||
                (std::abs(tried - energy) <= 1e-13 * std::abs(energy) && part == 1.0)) {
                moved = std::move(next);
                energy = tried;
                found = true;
            }
        }
        if (!found && careful)
            return false;
        careful = !found || (careful && part < 0.25);
    }
    return false;
}

HalfSpacePoint measured(const AxisymmetricMesh& mesh, const Contact& c, const Moved& moved) {
    HalfSpacePoint out;
    for (const SkinPoint& p : c.point) {
        const dvec2 x = place_of(mesh, p, moved);
        const Traction t = traction_at(c, p, x);
        out.force -= p.area * (t.pressure * t.normal.y + t.friction.y);
        if (t.pressure <= 0.0)
            continue;
        out.contact_radius = std::max(out.contact_radius, x.x);
        out.penetration = std::max(out.penetration, -gap_at(c, x).value);
    }
    return out;
}

void check(const HalfSpacePress& p) {
    double last = 0.0;
    for (const double d : p.depth) {
        if (!(d > last)) {
            throw std::invalid_argument("half-space press: depth = " + std::to_string(d) +
                                        " after " + std::to_string(last) + ": must ascend");
        }
        last = d;
    }
    if (p.depth.empty() || !(p.friction >= 0.0) || !(p.step > 0.0))
        throw std::invalid_argument("half-space press: want depths, friction >= 0 and step > 0");
}

} // namespace

HalfSpaceReport press_half_space(const HalfSpacePress& p,
                                 const std::function<void(const HalfSpacePoint&)>& progress) {
    check(p);
    Material material;
    material.young_pa = 1.0;
    material.poisson = p.poisson;
    AxisymmetricSystem system =
        make_axisymmetric(disc_mesh(p.cell, p.core, p.growth, p.extent, p.thickness),
                          elasticity(material, Law::neo_hooke));
    SparseFactor factor(system.pattern);
    Contact contact = skin_of(system.mesh, 4.0 + 2.0 * p.depth.back(), p.penalty);
    Moved now(system.mesh.rest.size(), dvec2{0.0}), before = now;
    HalfSpaceReport report;
    const double least = std::ldexp(p.step, -p.step_halvings);
    double step = 0.1 * p.step, last_step = step;
    while (report.point.size() < p.depth.size() && step >= 0.999 * std::min(least, 0.1 * p.step)) {
        const double goal = p.depth[report.point.size()];
        const bool arrives = report.reached + 1.001 * step >= goal;
        const double depth = arrives ? goal : report.reached + step;
        const double taken = depth - report.reached;
        contact.centre_z = 1.0 - depth;
        Moved moved = now;
        for (std::size_t i = 0; i < moved.size(); ++i)
            moved[i] += taken / last_step * (now[i] - before[i]);
        if (!std::isfinite(axisymmetric_energy(system, moved)))
            moved = now;
        if (!find_least(system, factor, contact, moved, report.iterations)) {
            step *= 0.5;
            continue;
        }
        before = std::exchange(now, moved);
        last_step = taken;
        step = std::min(p.step, 1.5 * step);
        report.reached = depth;
        HalfSpacePoint point = measured(system.mesh, contact, now);
        point.depth = depth;
        point.min_det_f = system.min_det_f;
        if (arrives)
            report.point.push_back(point);
        learn(system.mesh, now, p.friction, contact);
        if (progress)
            progress(point);
    }
    return report;
}

} // namespace tissue
