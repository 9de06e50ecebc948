// tissue/response/mesh_term.cpp
// What linear tetrahedra owe under a kernel: the same kernel on linear and quadratic ones.
// Called by bake and tests, any thread; seconds.
#include "tissue/response/mesh_term.h"

#include "tissue/response/footprint_kernel.h"
#include "tissue/response/linear_statics.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dvec3;

constexpr int kColumns = 96;       // right-hand sides per solve
constexpr double kRounding = 1e-8; // of W

// The kernel at one skin vertex.
struct Place {
    std::size_t vertex;
    dvec3 normal;
    std::vector<KernelSample> samples;
};

double size_at(const BoundaryTree& tree, std::span<const double> size, const dvec3& at_m) {
    const BoundaryPoint near = nearest_point(tree, at_m);
    const auto [a, b, c] = tree.triangle[near.triangle];
    return glm::dot(near.weight, dvec3{size[a], size[b], size[c]});
}

// Along a curve that stays in one part of the body as long as it can (Morton 1966): loads that are
// solved for together then pass through the same blocks of the factor.
void put_side_by_side(std::span<const dvec3> at_m, std::vector<Place>& places) {
    dvec3 low_m{std::numeric_limits<double>::max()}, high_m{-low_m};
    for (const dvec3& x : at_m) {
        low_m = glm::min(low_m, x);
        high_m = glm::max(high_m, x);
    }
    constexpr int kBits = 10;
    const dvec3 size_m = high_m - low_m;
    const double cell_m = std::max({size_m.x, size_m.y, size_m.z}) / ((1 << kBits) - 1);
    std::vector<std::uint32_t> along(at_m.size(), 0);
    for (std::size_t v = 0; v < at_m.size() && cell_m > 0.0; ++v) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto cell = static_cast<std::uint32_t>((at_m[v] - low_m)[axis] / cell_m);
            for (int bit = 0; bit < kBits; ++bit)
                along[v] |= (cell >> bit & 1u) << (3 * bit + axis);
        }
    }
    std::stable_sort(places.begin(), places.end(), [&](const Place& a, const Place& b) {
        return along[a.vertex] < along[b.vertex];
    });
}

std::vector<Place> find_places(const TetMesh& mesh, const BoundaryTree& tree,
                               const ContactSurface& surface, const FootprintOptions& options) {
    const std::vector<double> size = nodal_size_m(mesh);
    const std::vector<dvec3> normal = vertex_normals(surface.rest_m, surface.triangles);
    std::vector<Place> places;
    for (std::size_t v = 0; v < surface.rest_m.size(); ++v) {
        const dvec3& at_m = surface.rest_m[v];
        const double reach_m = kernel_reach_m(size_at(tree, size, at_m), options);
        places.push_back(
            {v, normal[v],
             kernel_samples(tree, at_m, normal[v], surface.footprint_radius_m[v], reach_m)});
    }
    put_side_by_side(surface.rest_m, places);
    return places;
}

// One column more: the kernel of `place` in `direction`.
void add_load(const LinearStatics& statics, const BoundaryTree& tree, const Place& place,
              const dvec3& direction, SparseColumns& columns) {
    for (const KernelSample& sample : place.samples) {
        const SurfaceShape shape =
            surface_shape(statics, tree.triangle[sample.at.triangle], sample.at.weight);
        for (int k = 0; k < shape.count; ++k) {
            const std::int32_t dof = statics.dof[shape.node[k]];
            for (int axis = 0; dof >= 0 && axis < 3; ++axis)
                columns.add(dof + axis, sample.share * shape.value[k] * direction[axis]);
        }
    }
    columns.end_column();
}

// E W of every place in normal (3 i) and two tangents (3 i + 1, 3 i + 2).
std::vector<double> kernel_compliances(const TetMesh& mesh, int order, double poisson,
                                       std::span<const std::uint8_t> anchored,
                                       std::span<const BedSample> bed, const BoundaryTree& tree,
                                       std::span<const Place> places,
                                       void (*progress)(double share)) {
    const LinearStatics statics = make_linear_statics(mesh, order, poisson, anchored, bed);
    SparseFactor factor(statics.pattern);
    if (!factor.factor(statics.stiffness_m))
        throw std::invalid_argument("mesh term: nothing holds the body");

    const std::size_t total = 3 * places.size();
    std::vector<double> compliance(total);
    for (std::size_t first = 0; first < total; first += kColumns) {
        const std::size_t columns = std::min<std::size_t>(kColumns, total - first);
        SparseColumns load;
        for (std::size_t c = 0; c < columns; ++c) {
            const Place& place = places[(first + c) / 3];
            const glm::dmat3 frame = tangent_frame(place.normal); // t1, t2, n
            add_load(statics, tree, place, frame[static_cast<int>((first + c + 2) % 3)], load);
        }
        factor.compliances(load, std::span(compliance).subspan(first, columns));
        if (progress)
            progress(static_cast<double>(first + columns) / static_cast<double>(total));
    }
    return compliance;
}

// Quadratic minus linear is never negative but for rounding.
double excess(double quadratic, double linear, std::size_t vertex) {
    if (!(quadratic - linear >= -kRounding * quadratic))
        throw std::logic_error("mesh term: vertex " + std::to_string(vertex) +
                               " is stiffer in quadratic than in linear tetrahedra");
    return std::max(0.0, quadratic - linear);
}

void check_inputs(const TetMesh& mesh, std::span<const std::uint8_t> anchored,
                  std::span<const BedSample> bed, const FootprintOptions& options,
                  const ContactSurface& surface) {
    if (options.order != 1)
        throw std::invalid_argument("mesh term: order = " + std::to_string(options.order) +
                                    ": only linear shapes owe one, of order 1");
    if (anchored.size() != mesh.rest_m.size())
        throw std::invalid_argument("mesh term: " + std::to_string(anchored.size()) +
                                    " anchor flags for " + std::to_string(mesh.rest_m.size()) +
                                    " nodes");
    if (surface.footprint_radius_m.size() != surface.rest_m.size())
        throw std::invalid_argument("mesh term: the surface has no footprints yet");
    if (!bed.empty())
        return; // springs over a volume hold it
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
                     std::span<const BedSample> bed, void (*progress)(double share)) {
    check_inputs(mesh, anchored, bed, options, surface);
    const BoundaryTree tree = make_boundary_tree(mesh);
    const std::vector<Place> places = find_places(mesh, tree, surface, options);
    const auto linear = kernel_compliances(mesh, 1, poisson, anchored, bed, tree, places, nullptr);
    const auto quadratic =
        kernel_compliances(mesh, 2, poisson, anchored, bed, tree, places, progress);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const std::size_t v = places[i].vertex;
        const auto term = [&](int k) { return excess(quadratic[3 * i + k], linear[3 * i + k], v); };
        surface.mesh_term_n_m[v] = term(0);
        surface.mesh_term_t_m[v] = 0.5 * (term(1) + term(2));
    }
}

} // namespace tissue
