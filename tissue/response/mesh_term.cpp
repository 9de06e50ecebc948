// tissue/response/mesh_term.cpp
// What linear tetrahedra owe under a kernel: the same kernel on linear and quadratic ones.
// Called by bake and tests, any thread; seconds.
#include "tissue/response/mesh_term.h"

#include "tissue/response/footprint_kernel.h"
#include "tissue/response/linear_statics.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace tissue {
namespace {

using glm::dvec3;

constexpr std::size_t kPlaces = 32; // loaded in one solve, three columns each
constexpr double kRounding = 1e-8;  // of W

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

// E W of every place, world axes.
std::vector<SymmetricTensor> kernel_compliances(const TetMesh& mesh, int order, double poisson,
                                                std::span<const std::uint8_t> anchored,
                                                std::span<const BedSample> bed,
                                                const BoundaryTree& tree,
                                                std::span<const Place> places,
                                                void (*progress)(double share)) {
    const LinearStatics statics = make_linear_statics(mesh, order, poisson, anchored, bed);
    SparseFactor factor(statics.pattern);
    if (!factor.factor(statics.stiffness_m))
        throw std::invalid_argument("mesh term: nothing holds the body");

    std::vector<SymmetricTensor> compliance(places.size());
    std::atomic<std::size_t> next{0}, done{0};
    double said = 0.0;
    const auto say = [&] {
        const double share = static_cast<double>(done) / static_cast<double>(places.size());
        if (progress && share > std::exchange(said, share))
            progress(share);
    };
    const auto work = [&](bool says) {
        for (std::size_t first; (first = next.fetch_add(kPlaces)) < places.size();) {
            const std::size_t count = std::min(kPlaces, places.size() - first);
            SparseColumns load;
            for (std::size_t c = 0; c < 3 * count; ++c) {
                dvec3 direction{0.0};
                direction[static_cast<int>(c % 3)] = 1.0;
                add_load(statics, tree, places[first + c / 3], direction, load);
            }
            factor.compliances(load, std::span(compliance).subspan(first, count));
            done += count;
            if (says)
                say();
        }
    };
    // on both processors of the least machine; who solves for a group changes no bit of it
    std::future<void> other = std::async(std::launch::async, work, false);
    work(true);
    other.get();
    say();
    return compliance;
}

double along(const SymmetricTensor& s, const dvec3& d) {
    return s[0] * d.x * d.x + s[1] * d.y * d.y + s[2] * d.z * d.z +
           2.0 * (s[3] * d.y * d.z + s[4] * d.x * d.z + s[5] * d.x * d.y);
}

// Quadratic minus linear is never negative but for rounding.
double excess(double quadratic, double linear, std::size_t vertex) {
    if (!(quadratic - linear >= -kRounding * quadratic))
        throw std::logic_error("mesh term: vertex " + std::to_string(vertex) +
                               " is stiffer in quadratic than in linear tetrahedra");
    return std::max(0.0, quadratic - linear);
}

// dW at one vertex in its three parts.
void set_term(const Place& place, const SymmetricTensor& quadratic, const SymmetricTensor& linear,
              ContactSurface& surface) {
    const std::size_t v = place.vertex;
    const dvec3& n = place.normal;
    const auto across = [&](const SymmetricTensor& s) {
        return 0.5 * (s[0] + s[1] + s[2] - along(s, n));
    };
    const double normal = excess(along(quadratic, n), along(linear, n), v);
    const double tangential = excess(across(quadratic), across(linear), v);
    surface.mesh_term_n_m[v] = normal;
    surface.mesh_term_t_m[v] = tangential;
    const double more = normal - tangential; // of n n^T
    const SymmetricTensor plain{tangential + more * n.x * n.x,
                                tangential + more * n.y * n.y,
                                tangential + more * n.z * n.z,
                                more * n.y * n.z,
                                more * n.x * n.z,
                                more * n.x * n.y};
    for (std::size_t k = 0; k < plain.size(); ++k)
        surface.mesh_lean_m[v][k] = quadratic[k] - linear[k] - plain[k];
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
    for (std::size_t i = 0; i < places.size(); ++i)
        set_term(places[i], quadratic[i], linear[i], surface);
}

} // namespace tissue
