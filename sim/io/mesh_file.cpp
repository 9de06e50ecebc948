#include "sim/io/mesh_file.h"

#include "assets/bake/import/read_surface.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>
#include <tuple>

namespace sim {

double unit_m_of(const std::string& unit) {
    if (unit == "mm")
        return 1e-3;
    if (unit == "cm")
        return 1e-2;
    if (unit == "m")
        return 1.0;
    throw std::invalid_argument(fmt::format("unit '{}': accepted: mm, cm, m", unit));
}

TriangleMesh read_mesh(std::span<const std::byte> bytes, const std::string& file_name,
                       double unit_m) {
    bake::Soup soup;
    try {
        soup = bake::read_surface(bytes, file_name);
    } catch (const bake::ReadError& e) {
        throw std::runtime_error(fmt::format("{}: {}", file_name, e.what()));
    }
    const auto key = [&](std::uint32_t p) {
        const glm::dvec3& q = soup.point[p];
        return std::tuple(q.x, q.y, q.z);
    };
    std::vector<std::uint32_t> order(soup.point.size()), vertex_of(soup.point.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](auto a, auto b) { return std::pair(key(a), a) < std::pair(key(b), b); });
    // the first of equal points stands for all; vertices stay in the order of the file
    for (std::size_t i = 0; i < order.size(); ++i)
        vertex_of[order[i]] =
            i > 0 && key(order[i]) == key(order[i - 1]) ? vertex_of[order[i - 1]] : order[i];
    TriangleMesh out;
    std::vector<std::uint32_t> number(soup.point.size());
    for (std::uint32_t p = 0; p < soup.point.size(); ++p)
        if (vertex_of[p] == p) {
            number[p] = static_cast<std::uint32_t>(out.vertex_m.size());
            out.vertex_m.push_back(unit_m * soup.point[p]);
        }
    for (const auto& t : soup.triangles)
        out.triangle.push_back(
            {number[vertex_of[t[0]]], number[vertex_of[t[1]]], number[vertex_of[t[2]]]});
    return out;
}

} // namespace sim
