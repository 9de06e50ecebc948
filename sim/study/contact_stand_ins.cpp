#include "sim/study/contact_stand_ins.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

namespace sim {
namespace {

using glm::dvec3;
constexpr double kTwoPi = 2.0 * std::numbers::pi;

struct Random {
    std::mt19937_64 engine;
    double between(double low, double high) { // the same from any library
        return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
    }
};

// nu x nv cells of a surface over [0, 1]^2.
template <class At> void add_surface(StandIn& mesh, int nu, int nv, const At& at) {
    const auto first = static_cast<std::uint32_t>(mesh.vertex_m.size());
    for (int j = 0; j <= nv; ++j)
        for (int i = 0; i <= nu; ++i)
            mesh.vertex_m.push_back(at(double(i) / nu, double(j) / nv));
    for (std::uint32_t j = 0; j < std::uint32_t(nv); ++j)
        for (std::uint32_t i = 0; i < std::uint32_t(nu); ++i) {
            const std::uint32_t a = first + j * (nu + 1) + i, b = a + nu + 1;
            mesh.triangle.push_back({a, a + 1, b});
            mesh.triangle.push_back({a + 1, b + 1, b});
        }
}

void add_box(StandIn& mesh, const dvec3& low, const dvec3& size) {
    const auto first = static_cast<std::uint32_t>(mesh.vertex_m.size());
    for (int k = 0; k < 8; ++k)
        mesh.vertex_m.push_back(low + size * dvec3{k & 1, k >> 1 & 1, k >> 2});
    constexpr std::uint32_t kFace[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                           {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    for (const auto& f : kFace) {
        mesh.triangle.push_back({first + f[0], first + f[1], first + f[2]});
        mesh.triangle.push_back({first + f[0], first + f[2], first + f[3]});
    }
}

// Sides one cell long, ends as fans from a corner of the rim: what CAD makes of a cylinder.
void add_tube(StandIn& mesh, const dvec3& at, int axis, double radius_m, double length_m,
              std::uint32_t sides) {
    const auto first = static_cast<std::uint32_t>(mesh.vertex_m.size());
    for (const double along : {0.0, length_m})
        for (std::uint32_t i = 0; i < sides; ++i) {
            dvec3 p = at;
            p[axis] += along;
            p[(axis + 1) % 3] += radius_m * std::cos(kTwoPi * i / sides);
            p[(axis + 2) % 3] += radius_m * std::sin(kTwoPi * i / sides);
            mesh.vertex_m.push_back(p);
        }
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t a = first + i, b = first + (i + 1) % sides;
        mesh.triangle.push_back({a, b, a + sides});
        mesh.triangle.push_back({b, b + sides, a + sides});
        if (i + 2 < sides) {
            mesh.triangle.push_back({first, a + 1, a + 2});
            mesh.triangle.push_back({first + sides, a + 1 + sides, a + 2 + sides});
        }
    }
}

} // namespace

StandIn nano_surface(std::uint64_t seed) {
    StandIn mesh{
        .name = "height-field", .of = "nano-surface, 12 k", .vertex_m = {}, .triangle = {}};
    Random random{std::mt19937_64(seed)};
    struct Bump {
        double x, y, width, height;
    };
    std::vector<Bump> bump;
    for (int i = 0; i < 60; ++i)
        bump.push_back({random.between(0, 1), random.between(0, 1), random.between(0.02, 0.06),
                        random.between(0.2, 1.0)});
    add_surface(mesh, 80, 75, [&](double u, double v) {
        double height = 0.3 * std::sin(9.0 * u) * std::cos(7.0 * v);
        for (const Bump& b : bump) {
            const double r2 = ((u - b.x) * (u - b.x) + (v - b.y) * (v - b.y)) / (b.width * b.width);
            height += b.height * std::exp(-r2);
        }
        return dvec3{0.1 * u, 0.1 * v, 0.008 * height};
    });
    return mesh;
}

StandIn assembly(std::uint64_t seed) {
    StandIn mesh{.name = "assembly", .of = "Ford Bronco, 18 k", .vertex_m = {}, .triangle = {}};
    Random random{std::mt19937_64(seed)};
    const dvec3 size{0.24, 0.1, 0.08};
    add_surface(mesh, 60, 30, [&](double u, double v) { // the body
        const double turn = std::numbers::pi * v;
        return size * dvec3{u, 0.5 - 0.5 * std::cos(turn),
                            std::sin(turn) * (0.6 + 0.4 * std::sin(6.0 * u))};
    });
    while (mesh.triangle.size() < 18000) {
        const dvec3 at =
            size * dvec3{random.between(0, 1), random.between(0, 1), random.between(0, 0.9)};
        const double part_m = 0.02 * std::pow(random.between(0.1, 1.0), 2.0);
        const int axis = static_cast<int>(random.engine() % 3);
        if (random.engine() % 3 == 0) {
            dvec3 box{part_m, part_m * random.between(0.1, 1.0), part_m * random.between(0.1, 1.0)};
            box[axis] *= 4.0;
            add_box(mesh, at, box);
        } else {
            const auto sides = static_cast<std::uint32_t>(8 << random.engine() % 4);
            add_tube(mesh, at, axis, 0.3 * part_m, part_m * random.between(0.1, 6.0), sides);
        }
    }
    return mesh;
}

StandIn wing(std::uint64_t seed) {
    StandIn mesh{.name = "wing", .of = "butterfly, 79 k", .vertex_m = {}, .triangle = {}};
    Random random{std::mt19937_64(seed)};
    const double phase = random.between(0.0, kTwoPi);
    for (const double side : {-1.0, 1.0})
        for (const double face : {-0.5, 0.5})
            add_surface(mesh, 125, 79, [&](double u, double v) {
                // from the root (u = 0, 30 mm) along rays; the outline has a notch
                const double ray = (v - 0.45) * 2.6;
                const double length_m =
                    0.1 * (0.55 + 0.45 * std::cos(2.2 * ray)) * (1.0 - 0.05 * std::cos(30.0 * ray));
                const double x = u * length_m * std::cos(ray),
                             y = 0.03 * (v - 0.5) + u * length_m * std::sin(ray);
                const double vein = 1e-3 * std::sin(25.0 * ray + phase) * u;
                const double z = 0.3 * x + 4e-3 * std::sin(60.0 * y + phase) + vein;
                const double thick_m = 4e-4 * std::sqrt(std::max(0.0, 4.0 * u * (1.0 - u))) *
                                       std::sqrt(std::max(0.0, 4.0 * v * (1.0 - v)));
                return dvec3{side * (2e-3 + x), y, z + face * thick_m};
            });
    return mesh;
}

std::vector<StandIn> make_stand_ins(std::uint64_t seed) {
    std::vector<StandIn> out;
    out.push_back(nano_surface(seed));
    out.push_back(assembly(seed));
    out.push_back(wing(seed));
    return out;
}

} // namespace sim
