// sim/view/demo_world.h
// A made-up world of the size of the real one: for view_demo and for the tests of the window.
#pragma once

#include "sim/view/frame.h"
#include "sim/view/screens.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace view {

struct DemoSurface {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<glm::vec3> rest_m, position_m, normal;
};

/// A lumpy ellipsoid of about rows x around vertices, 180 x 120 x 65 mm.
inline DemoSurface demo_organ(int rows, int around) {
    DemoSurface s;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i < around; ++i) {
            const double b = std::numbers::pi * (j + 0.01) / (rows + 0.02);
            const double a = 2.0 * std::numbers::pi * i / around;
            const glm::dvec3 u(std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a));
            const double lump = 1.0 + 0.05 * std::sin(5.0 * u.x + 1.0) * std::cos(4.0 * u.y);
            s.rest_m.emplace_back(lump * glm::dvec3(0.09 * u.x, 0.06 * u.y, 0.0325 * u.z));
            s.normal.emplace_back(glm::normalize(glm::dvec3(u.x / 0.09, u.y / 0.06, u.z / 0.0325)));
        }
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < around; ++i) {
            const auto at = [&](int row, int k) {
                return static_cast<std::uint32_t>(row * around + k % around);
            };
            s.triangles.push_back({at(j, i), at(j, i + 1), at(j + 1, i)});
            s.triangles.push_back({at(j + 1, i), at(j, i + 1), at(j + 1, i + 1)});
        }
    s.position_m = s.rest_m;
    return s;
}

/// A curved sheet behind the organ.
inline DemoSurface demo_wall(int side) {
    DemoSurface s;
    for (int j = 0; j <= side; ++j)
        for (int i = 0; i <= side; ++i) {
            const double x = 0.40 * i / side - 0.20, y = 0.32 * j / side - 0.16;
            s.rest_m.emplace_back(x, y, -0.06 + 1.2 * (x * x + y * y));
            s.normal.emplace_back(glm::normalize(glm::dvec3(-2.4 * x, -2.4 * y, 1.0)));
        }
    const auto row = static_cast<std::uint32_t>(side + 1);
    for (std::uint32_t j = 0; j + 1 < row; ++j)
        for (std::uint32_t i = 0; i + 1 < row; ++i) {
            const std::uint32_t a = j * row + i;
            s.triangles.push_back({a, a + 1, a + row});
            s.triangles.push_back({a + row, a + 1, a + row + 1});
        }
    s.position_m = s.rest_m;
    return s;
}

inline SurfaceView surface_view(const DemoSurface& s, int id, Look look) {
    return {id, look, s.triangles, s.rest_m, s.position_m, s.normal};
}

/// The front of demo_organ()'s ellipsoid (without its lumps, which are 3 mm at most here).
inline glm::dvec3 demo_front_m(double x, double y) {
    return {x, y, 0.0325 * std::sqrt(std::max(0.0, 1.0 - x * x / 0.0081 - y * y / 0.0036))};
}

inline ToolView demo_tool(Role role, const glm::dvec3& fulcrum_m, const glm::dvec3& tip_m) {
    ToolView tool;
    tool.role = role;
    tool.present = true;
    tool.fulcrum_m = fulcrum_m;
    tool.tip_m = tip_m;
    tool.direction = glm::normalize(tip_m - fulcrum_m);
    return tool;
}

} // namespace view
