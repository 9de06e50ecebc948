// tissue/mesh/elastic_bed.cpp
// Samples the region that holds an organ. Bake and load time.
#include "tissue/mesh/elastic_bed.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dvec3;
using Weights = std::array<double, 4>;

constexpr int kCuts = 4; // per edge: a tet across the rim is seen as kCuts^3 equal parts

double tet_volume_m3(const TetMesh& mesh, const Tet& t) {
    const dvec3 a = mesh.rest_m[t[0]];
    return glm::dot(mesh.rest_m[t[1]] - a,
                    glm::cross(mesh.rest_m[t[2]] - a, mesh.rest_m[t[3]] - a)) /
           6.0;
}

dvec3 place_m(const TetMesh& mesh, const Tet& tet, const Weights& w) {
    return w[0] * mesh.rest_m[tet[0]] + w[1] * mesh.rest_m[tet[1]] + w[2] * mesh.rest_m[tet[2]] +
           w[3] * mesh.rest_m[tet[3]];
}

// Centroids of the parts: a tet cut into n^3 tets of equal volume falls into upright ones, the
// reverse ones, and octahedra of four parts around their middle.
std::vector<Weights> part_centres(int n) {
    std::vector<Weights> centres;
    const auto add = [&](int i, int j, int k, double shift) {
        const Weights w{(i + shift) / n, (j + shift) / n, (k + shift) / n, 0.0};
        centres.push_back({w[0], w[1], w[2], 1.0 - w[0] - w[1] - w[2]});
    };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; i + j < n; ++j) {
            for (int k = 0; i + j + k < n; ++k) {
                add(i, j, k, 0.25);
                for (int part = 0; part < 4 && i + j + k < n - 1; ++part)
                    add(i, j, k, 0.5);
                if (i + j + k < n - 2)
                    add(i, j, k, 0.75);
            }
        }
    }
    return centres;
}

// Four points of degree 2: exact for products of linear shapes.
constexpr double kFar = 0.58541019662496845, kNear = 0.13819660112501052;
constexpr std::array<Weights, 4> kWhole{{{kFar, kNear, kNear, kNear},
                                         {kNear, kFar, kNear, kNear},
                                         {kNear, kNear, kFar, kNear},
                                         {kNear, kNear, kNear, kFar}}};

} // namespace

std::vector<BedSample> make_bed(const TetMesh& mesh,
                                const std::function<bool(const dvec3&)>& inside, double length_m) {
    if (!(length_m > 0.0) || !std::isfinite(length_m))
        throw std::invalid_argument("bed: length_m = " + std::to_string(length_m) +
                                    ": must be greater than 0");
    const std::vector<Weights> parts = part_centres(kCuts);
    std::vector<BedSample> bed;
    std::vector<std::uint8_t> in(parts.size());
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
        const Tet& tet = mesh.tets[t];
        const double whole_m = tet_volume_m3(mesh, tet) / (length_m * length_m);
        bool corners = true;
        for (const std::uint32_t node : tet)
            corners = corners && inside(mesh.rest_m[node]);
        std::transform(parts.begin(), parts.end(), in.begin(), [&](const Weights& w) {
            return static_cast<std::uint8_t>(inside(place_m(mesh, tet, w)));
        });
        if (corners && std::find(in.begin(), in.end(), 0) == in.end()) {
            for (const Weights& w : kWhole)
                bed.push_back({t, w, whole_m / 4.0});
            continue;
        }
        for (std::size_t p = 0; p < parts.size(); ++p) {
            if (in[p])
                bed.push_back({t, parts[p], whole_m / static_cast<double>(parts.size())});
        }
    }
    return bed;
}

std::vector<BedSample> weak_bed(const TetMesh& mesh) {
    dvec3 low{1e300}, high{-1e300};
    for (const dvec3& x : mesh.rest_m) {
        low = glm::min(low, x);
        high = glm::max(high, x);
    }
    return make_bed(
        mesh, [](const dvec3&) { return true; }, 2.0 * glm::distance(low, high));
}

} // namespace tissue
