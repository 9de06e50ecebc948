// tissue/mesh/refine.cpp
// Cuts longest edges until every tet is small enough for where it lies.
#include "tissue/mesh/refine.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>

namespace tissue {
namespace {

using glm::dvec3;
using Edge = std::array<std::uint32_t, 2>; // lower node first

Edge edge_of(std::uint32_t a, std::uint32_t b) noexcept {
    return {std::min(a, b), std::max(a, b)};
}

struct Cutter {
    TetMesh& mesh;
    std::vector<std::uint8_t>& anchored;
    std::map<Edge, std::vector<std::uint32_t>> tets_of; // of every edge
    std::vector<std::vector<BedSample>> bed;            // of every tet
};

// Length first; ties by number, so that "longest" means the same to all tets around an edge.
std::tuple<double, Edge> rank(const TetMesh& mesh, const Edge& e) noexcept {
    const dvec3 way = mesh.rest_m[e[1]] - mesh.rest_m[e[0]];
    return {glm::dot(way, way), e};
}

Edge longest_edge(const TetMesh& mesh, const Tet& t) noexcept {
    Edge best = edge_of(t[0], t[1]);
    for (int a = 0; a < 4; ++a) {
        for (int b = a + 1; b < 4; ++b) {
            if (const Edge e = edge_of(t[a], t[b]); rank(mesh, best) < rank(mesh, e))
                best = e;
        }
    }
    return best;
}

void enter(Cutter& c, std::uint32_t tet) {
    const Tet& t = c.mesh.tets[tet];
    for (int a = 0; a < 4; ++a) {
        for (int b = a + 1; b < 4; ++b)
            c.tets_of[edge_of(t[a], t[b])].push_back(tet);
    }
}

void leave(Cutter& c, std::uint32_t tet) {
    const Tet& t = c.mesh.tets[tet];
    for (int a = 0; a < 4; ++a) {
        for (int b = a + 1; b < 4; ++b)
            std::erase(c.tets_of[edge_of(t[a], t[b])], tet);
    }
}

// A sample's weights w_a, w_b at the ends of the cut edge: the half of the heavier end has it, with
// the lighter one's weight doubled on the middle.
BedSample in_half(const BedSample& s, std::size_t kept, std::size_t cut, std::uint32_t tet) {
    BedSample half = s;
    half.tet = tet;
    half.weight[kept] = s.weight[kept] - s.weight[cut];
    half.weight[cut] = 2.0 * s.weight[cut];
    return half;
}

void cut_tet(Cutter& c, std::uint32_t tet, const Edge& edge, std::uint32_t middle) {
    leave(c, tet);
    const Tet whole = c.mesh.tets[tet];
    const auto corner = [&](std::uint32_t node) {
        return static_cast<std::size_t>(std::find(whole.begin(), whole.end(), node) -
                                        whole.begin());
    };
    const std::size_t a = corner(edge[0]), b = corner(edge[1]);
    const auto other = static_cast<std::uint32_t>(c.mesh.tets.size());
    Tet first = whole, second = whole; // with a and with b
    first[b] = second[a] = middle;
    c.mesh.tets[tet] = first;
    c.mesh.tets.push_back(second);
    std::vector<BedSample> samples = std::move(c.bed[tet]), near_a, near_b;
    for (const BedSample& s : samples) {
        if (s.weight[a] >= s.weight[b])
            near_a.push_back(in_half(s, a, b, tet));
        else
            near_b.push_back(in_half(s, b, a, other));
    }
    c.bed[tet] = std::move(near_a);
    c.bed.push_back(std::move(near_b));
    enter(c, tet);
    enter(c, other);
}

// The longest edge of all tets around a path of ever longer edges from `tet`.
Edge terminal_edge(const Cutter& c, std::uint32_t tet) {
    Edge edge = longest_edge(c.mesh, c.mesh.tets[tet]);
    for (;;) {
        Edge longest = edge;
        for (const std::uint32_t around : c.tets_of.at(edge)) {
            const Edge e = longest_edge(c.mesh, c.mesh.tets[around]);
            if (rank(c.mesh, longest) < rank(c.mesh, e))
                longest = e;
        }
        if (longest == edge)
            return edge;
        edge = longest;
    }
}

void cut_edge(Cutter& c, const Edge& edge) {
    const auto middle = static_cast<std::uint32_t>(c.mesh.rest_m.size());
    c.mesh.rest_m.push_back(0.5 * (c.mesh.rest_m[edge[0]] + c.mesh.rest_m[edge[1]]));
    c.anchored.push_back(c.anchored[edge[0]] & c.anchored[edge[1]]);
    const std::vector<std::uint32_t> around = c.tets_of.at(edge);
    for (const std::uint32_t tet : around)
        cut_tet(c, tet, edge, middle);
    c.tets_of.erase(edge);
}

bool too_large(const TetMesh& mesh, const Tet& t, const dvec3& place_m, const RefineSize& size) {
    const double length2 = glm::dot(size.down_m, size.down_m);
    const auto distance_to = [&](const dvec3& x) {
        const dvec3 way = x - place_m;
        const double share =
            length2 > 0.0 ? std::clamp(glm::dot(way, size.down_m) / length2, 0.0, 1.0) : 0.0;
        return glm::length(way - share * size.down_m);
    };
    // a large tet may hold the place far from its corners
    dvec3 centre{0.0};
    for (const std::uint32_t node : t)
        centre += 0.25 * mesh.rest_m[node];
    double distance_m = distance_to(centre);
    for (const std::uint32_t node : t)
        distance_m = std::min(distance_m, distance_to(mesh.rest_m[node]));
    const double edge_m = std::sqrt(std::get<0>(rank(mesh, longest_edge(mesh, t))));
    return edge_m > size.edge_m + size.growth * std::max(0.0, distance_m - size.core_m);
}

void check(const TetMesh& mesh, std::span<const std::uint8_t> anchored,
           std::span<const BedSample> bed, const RefineSize& size) {
    check_mesh(mesh);
    if (!anchored.empty() && anchored.size() != mesh.rest_m.size()) {
        throw std::invalid_argument("refine: anchored flags for " +
                                    std::to_string(anchored.size()) + " nodes: the mesh has " +
                                    std::to_string(mesh.rest_m.size()));
    }
    if (!(size.edge_m > 0.0) || !(size.growth > 0.0)) {
        throw std::invalid_argument("refine: edge_m = " + std::to_string(size.edge_m) +
                                    ", growth = " + std::to_string(size.growth) +
                                    ": must be greater than 0");
    }
    for (const BedSample& s : bed) {
        if (s.tet >= mesh.tets.size()) {
            throw std::invalid_argument("refine: a sample of the bed names tet " +
                                        std::to_string(s.tet) + " of " +
                                        std::to_string(mesh.tets.size()));
        }
    }
}

} // namespace

RefinedMesh refined(const TetMesh& mesh, std::span<const std::uint8_t> anchored,
                    std::span<const BedSample> bed, const dvec3& place_m, const RefineSize& size,
                    std::size_t most_tets) {
    check(mesh, anchored, bed, size);
    RefinedMesh out{mesh, {anchored.begin(), anchored.end()}, {}};
    out.anchored.resize(mesh.rest_m.size(), 0);
    Cutter cutter{
        out.mesh, out.anchored, {}, std::vector<std::vector<BedSample>>(mesh.tets.size())};
    for (const BedSample& s : bed)
        cutter.bed[s.tet].push_back(s);
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t)
        enter(cutter, t);

    // a cut shrinks the tet at hand, appends others and may bring an earlier one nearer the place
    for (std::size_t before = 0; before != out.mesh.tets.size();) {
        before = out.mesh.tets.size();
        for (std::uint32_t t = 0; t < out.mesh.tets.size(); ++t) {
            while (too_large(out.mesh, out.mesh.tets[t], place_m, size))
                cut_edge(cutter, terminal_edge(cutter, t));
            if (out.mesh.tets.size() > most_tets) {
                throw std::invalid_argument("refine: more than " + std::to_string(most_tets) +
                                            " tets: want a larger edge_m or growth");
            }
        }
    }
    for (const auto& samples : cutter.bed)
        out.bed.insert(out.bed.end(), samples.begin(), samples.end());
    return out;
}

double least_shape_quality(const TetMesh& mesh) {
    double least = 1.0;
    for (const Tet& t : mesh.tets) {
        double squares_m2 = 0.0;
        for (int a = 0; a < 4; ++a) {
            for (int b = a + 1; b < 4; ++b) {
                const dvec3 way = mesh.rest_m[t[b]] - mesh.rest_m[t[a]];
                squares_m2 += glm::dot(way, way);
            }
        }
        const dvec3 x = mesh.rest_m[t[0]];
        const double volume_m3 = glm::dot(glm::cross(mesh.rest_m[t[1]] - x, mesh.rest_m[t[2]] - x),
                                          mesh.rest_m[t[3]] - x) /
                                 6.0;
        least = std::min(least, 12.0 * std::cbrt(9.0 * volume_m3 * volume_m3) / squares_m2);
    }
    return least;
}

} // namespace tissue
