// tissue/response/mesh_term.cpp
// What linear tetrahedra owe under a kernel: the same kernel on linear and quadratic ones.
// Called by bake and tests, any thread; seconds.
#include "tissue/response/mesh_term.h"

#include "tissue/response/footprint_kernel.h"
#include "tissue/response/linear_statics.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dvec3;

constexpr int kColumns = 32;      // right-hand sides per solve
constexpr double kSmooth = 0.8;   // cos 37 deg from the mean normal: beyond, the node is on an edge
constexpr double kSameSide = 0.5; // cos 60 deg between triangles
constexpr double kSameNormal = 0.98;
constexpr double kRounding = 1e-8; // of W

// A kernel at a node of the boundary; a node on a sharp edge has one for each side.
struct Place {
    std::uint32_t node;
    dvec3 normal;
    double radius_m = 0.0;
    std::vector<KernelSample> samples;
    double normal_term = 0.0, tangential_term = 0.0; // E dW
};

struct Places {
    std::vector<Place> place;
    std::vector<std::array<std::uint32_t, 3>> corner; // per boundary triangle, into place
};

Places find_places(const BoundaryTree& tree) {
    std::vector<std::vector<std::uint32_t>> around(tree.node_m.size());
    std::vector<double> area(tree.triangle.size());
    for (std::uint32_t t = 0; t < tree.triangle.size(); ++t) {
        const auto [a, b, c] = tree.triangle[t];
        area[t] = glm::length(
            glm::cross(tree.node_m[b] - tree.node_m[a], tree.node_m[c] - tree.node_m[a]));
        for (const std::uint32_t node : tree.triangle[t])
            around[node].push_back(t);
    }
    const std::vector<dvec3> mean = vertex_normals(tree.node_m, tree.triangle);
    Places places;
    places.corner.resize(tree.triangle.size());
    for (std::uint32_t node = 0; node < around.size(); ++node) {
        const std::size_t first = places.place.size();
        const bool smooth = std::all_of(around[node].begin(), around[node].end(), [&](auto t) {
            return glm::dot(tree.normal[t], mean[node]) > kSmooth;
        });
        for (const std::uint32_t t : around[node]) {
            dvec3 normal = mean[node];
            if (!smooth) { // of the triangles that face as this one does
                normal = dvec3{0.0};
                for (const std::uint32_t u : around[node]) {
                    if (glm::dot(tree.normal[t], tree.normal[u]) > kSameSide)
                        normal += area[u] * tree.normal[u];
                }
                normal = glm::normalize(normal);
            }
            std::size_t found = first;
            while (found < places.place.size() &&
                   glm::dot(places.place[found].normal, normal) < kSameNormal)
                ++found;
            if (found == places.place.size())
                places.place.push_back({node, normal, 0.0, {}, 0.0, 0.0});
            const Triangle& triangle = tree.triangle[t];
            const auto k = std::find(triangle.begin(), triangle.end(), node) - triangle.begin();
            places.corner[t][k] = static_cast<std::uint32_t>(found);
        }
    }
    return places;
}

std::vector<BoundaryPoint> points_below(const BoundaryTree& tree, const ContactSurface& surface) {
    const std::vector<dvec3> normal = vertex_normals(surface.rest_m, surface.triangles);
    std::vector<BoundaryPoint> below;
    for (std::size_t v = 0; v < surface.rest_m.size(); ++v)
        below.push_back(
            point_below(tree, surface.rest_m[v], normal[v], surface.footprint_radius_m[v]));
    return below;
}

// A skin need not cover the whole body.
void drop_unused(std::span<const BoundaryPoint> below, Places& places) {
    std::vector<std::int64_t> moved(places.place.size(), -1);
    for (const BoundaryPoint& at : below) {
        for (const std::uint32_t place : places.corner[at.triangle])
            moved[place] = 0;
    }
    std::vector<Place> kept;
    for (std::size_t i = 0; i < moved.size(); ++i) {
        if (moved[i] < 0)
            continue;
        moved[i] = static_cast<std::int64_t>(kept.size());
        kept.push_back(std::move(places.place[i]));
    }
    for (auto& corner : places.corner) {
        for (std::uint32_t& place : corner)
            place = static_cast<std::uint32_t>(std::max<std::int64_t>(0, moved[place]));
    }
    places.place = std::move(kept);
}

// Column = kernel of `place` in `direction`.
void add_load(const LinearStatics& statics, const BoundaryTree& tree, const Place& place,
              const dvec3& direction, std::span<double> column) {
    for (const KernelSample& sample : place.samples) {
        const SurfaceShape shape =
            surface_shape(statics, tree.triangle[sample.at.triangle], sample.at.weight);
        for (int k = 0; k < shape.count; ++k) {
            const std::int32_t dof = statics.dof[shape.node[k]];
            for (int axis = 0; dof >= 0 && axis < 3; ++axis)
                column[dof + axis] += sample.share * shape.value[k] * direction[axis];
        }
    }
}

// E W of every place in normal (3 i) and two tangents (3 i + 1, 3 i + 2).
std::vector<double> kernel_compliances(const TetMesh& mesh, int order, double poisson,
                                       std::span<const std::uint8_t> anchored,
                                       const BoundaryTree& tree, std::span<const Place> places,
                                       void (*progress)(double share)) {
    const LinearStatics statics = make_linear_statics(mesh, order, poisson, anchored);
    SparseFactor factor(statics.pattern);
    if (!factor.factor(statics.stiffness_m))
        throw std::invalid_argument("mesh term: the anchored nodes do not hold the body");

    const std::size_t n = statics.unknowns, total = 3 * places.size();
    std::vector<double> compliance(total), load(n * kColumns), answer;
    for (std::size_t first = 0; first < total; first += kColumns) {
        const std::size_t columns = std::min<std::size_t>(kColumns, total - first);
        std::fill(load.begin(), load.end(), 0.0);
        for (std::size_t c = 0; c < columns; ++c) {
            const Place& place = places[(first + c) / 3];
            const glm::dmat3 frame = tangent_frame(place.normal); // t1, t2, n
            add_load(statics, tree, place, frame[static_cast<int>((first + c + 2) % 3)],
                     std::span(load).subspan(c * n, n));
        }
        answer = load;
        factor.solve(std::span(answer).first(columns * n), static_cast<int>(columns));
        for (std::size_t c = 0; c < columns; ++c) {
            for (std::size_t i = c * n; i < (c + 1) * n; ++i)
                compliance[first + c] += load[i] * answer[i];
        }
        if (progress)
            progress(static_cast<double>(first + columns) / static_cast<double>(total));
    }
    return compliance;
}

// Quadratic minus linear is never negative but for rounding.
double excess(double quadratic, double linear, std::uint32_t node) {
    if (!(quadratic - linear >= -kRounding * quadratic))
        throw std::logic_error("mesh term: node " + std::to_string(node) +
                               " is stiffer in quadratic than in linear tetrahedra");
    return std::max(0.0, quadratic - linear);
}

void check_inputs(const TetMesh& mesh, std::span<const std::uint8_t> anchored,
                  const ContactSurface& surface) {
    if (anchored.size() != mesh.rest_m.size())
        throw std::invalid_argument("mesh term: " + std::to_string(anchored.size()) +
                                    " anchor flags for " + std::to_string(mesh.rest_m.size()) +
                                    " nodes");
    if (surface.footprint_radius_m.size() != surface.rest_m.size())
        throw std::invalid_argument("mesh term: the surface has no footprints yet");
    std::vector<dvec3> held;
    for (std::size_t i = 0; i < anchored.size(); ++i) {
        if (anchored[i])
            held.push_back(mesh.rest_m[i]);
    }
    // three nodes that are not on one line hold a body
    bool holds = false;
    for (std::size_t i = 2; i < held.size() && !holds; ++i) {
        const dvec3 a = held[1] - held[0], b = held[i] - held[0];
        holds = glm::length(glm::cross(a, b)) > 1e-9 * glm::length(a) * glm::length(b);
    }
    if (!holds)
        throw std::invalid_argument("mesh term: " + std::to_string(held.size()) +
                                    " anchored nodes do not hold the body, so pressing it has no "
                                    "static answer; anchor three that are not on one line");
}

} // namespace

void make_mesh_terms(const TetMesh& mesh, double poisson, std::span<const std::uint8_t> anchored,
                     const FootprintOptions& options, ContactSurface& surface,
                     void (*progress)(double share)) {
    check_inputs(mesh, anchored, surface);
    const BoundaryTree tree = make_boundary_tree(mesh);
    const std::vector<double> size = nodal_size_m(mesh);
    Places places = find_places(tree);
    const std::vector<BoundaryPoint> below = points_below(tree, surface);
    drop_unused(below, places);
    for (Place& place : places.place) {
        const dvec3& at_m = mesh.rest_m[place.node];
        const double h = size[place.node];
        place.radius_m = kernel_radius_m(tree, at_m, place.normal, h, options);
        place.samples =
            kernel_samples(tree, at_m, place.normal, place.radius_m, kernel_reach_m(h, options));
    }
    const auto linear = kernel_compliances(mesh, 1, poisson, anchored, tree, places.place, nullptr);
    const auto quadratic =
        kernel_compliances(mesh, 2, poisson, anchored, tree, places.place, progress);
    for (std::size_t i = 0; i < places.place.size(); ++i) {
        Place& place = places.place[i];
        place.normal_term = excess(quadratic[3 * i], linear[3 * i], place.node);
        place.tangential_term = 0.5 * (excess(quadratic[3 * i + 1], linear[3 * i + 1], place.node) +
                                       excess(quadratic[3 * i + 2], linear[3 * i + 2], place.node));
    }

    // dW goes as 1/r where r changes, so r dW is what is interpolated
    for (std::size_t v = 0; v < surface.rest_m.size(); ++v) {
        const BoundaryPoint& at = below[v];
        double normal = 0.0, tangential = 0.0;
        for (int k = 0; k < 3; ++k) {
            const Place& place = places.place[places.corner[at.triangle][k]];
            normal += at.weight[k] * place.radius_m * place.normal_term;
            tangential += at.weight[k] * place.radius_m * place.tangential_term;
        }
        surface.mesh_term_n_m[v] = normal / surface.footprint_radius_m[v];
        surface.mesh_term_t_m[v] = tangential / surface.footprint_radius_m[v];
    }
}

} // namespace tissue
