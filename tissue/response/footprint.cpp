// tissue/response/footprint.cpp
// Footprint rows of the skin, vertex by vertex. Called by bake and tests, any thread.
#include "tissue/response/footprint.h"

#include "tissue/mesh/quadratic_mesh.h"
#include "tissue/response/footprint_kernel.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <stdexcept>
#include <string>

namespace tissue {
namespace {

using glm::dvec3;

constexpr double kSmallestWeight = 1e-12;
constexpr double kGrowth = 0.3; // of the nodal size per unit of distance

double mean_edge_m(const TetMesh& mesh, const Tet& tet) {
    double sum = 0.0;
    for (int a = 0; a < 4; ++a) {
        for (int b = a + 1; b < 4; ++b)
            sum += glm::distance(mesh.rest_m[tet[a]], mesh.rest_m[tet[b]]);
    }
    return sum / 6.0;
}

double tet_volume_m3(const TetMesh& mesh, const Tet& t) {
    const dvec3 a = mesh.rest_m[t[0]];
    return glm::dot(mesh.rest_m[t[1]] - a,
                    glm::cross(mesh.rest_m[t[2]] - a, mesh.rest_m[t[3]] - a)) /
           6.0;
}

void check_inputs(const TetMesh& mesh, std::span<const std::uint8_t> anchored,
                  const FootprintOptions& options, const ContactSurface& surface) {
    if (!anchored.empty() && anchored.size() != mesh.rest_m.size())
        throw std::invalid_argument(std::to_string(anchored.size()) + " anchor flags for " +
                                    std::to_string(mesh.rest_m.size()) + " nodes");
    if (options.order != 1 && options.order != 2)
        throw std::invalid_argument("footprint: order = " + std::to_string(options.order) +
                                    ": must be 1 or 2");
    if (!(options.size_factor > 0.0) || !(options.even_factor > 0.0) ||
        !(options.tip_radius_max_m > 0.0))
        throw std::invalid_argument(
            "footprint: size_factor = " + std::to_string(options.size_factor) +
            ", even_factor = " + std::to_string(options.even_factor) + ", tip_radius_max_m = " +
            std::to_string(options.tip_radius_max_m) + ": each must be greater than 0");
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        for (const std::uint32_t v : surface.triangles[t]) {
            if (v >= surface.rest_m.size())
                throw std::invalid_argument("skin triangle " + std::to_string(t) +
                                            " names vertex " + std::to_string(v) + " of " +
                                            std::to_string(surface.rest_m.size()));
        }
    }
}

// How much tissue lies below, if what lies below is held.
double backed_thickness_m(const BoundaryTree& tree, std::span<const std::uint8_t> anchored,
                          const BoundaryPoint& top, const dvec3& normal) {
    if (anchored.empty())
        return kUnbacked_m;
    const double far = 2.0 * glm::length(tree.box[0].high - tree.box[0].low);
    for (const BoundaryPoint& hit :
         line_hits(tree, position_m(tree, top), -normal, 1e-6 * far, far)) {
        if (glm::dot(tree.normal[hit.triangle], normal) >= 0.0)
            continue;
        int held = 0;
        for (const std::uint32_t node : tree.triangle[hit.triangle])
            held += anchored[node] ? 1 : 0;
        return held >= 2 ? hit.distance_m : kUnbacked_m;
    }
    return kUnbacked_m;
}

bool closed(const ContactSurface& surface) {
    return std::all_of(surface.neighbours.begin(), surface.neighbours.end(),
                       [](const auto& across) { return std::ranges::min(across) >= 0; });
}

double size_at(const BoundaryTree& tree, const BoundaryPoint& at, std::span<const double> size) {
    const auto [a, b, c] = tree.triangle[at.triangle];
    return glm::dot(at.weight, dvec3{size[a], size[b], size[c]});
}

// Whose shapes stand on the boundary: its triangles as the tree numbers them.
struct Shapes {
    std::vector<dvec3> node_m;
    std::vector<Triangle6> quadratic; // empty: linear
};

Shapes make_shapes(const TetMesh& mesh, int order) {
    if (order == 1)
        return {mesh.rest_m, {}};
    QuadraticMesh quadratic = quadratic_mesh(mesh);
    std::vector<Triangle6> triangles = boundary_triangles(quadratic);
    return {std::move(quadratic.rest_m), std::move(triangles)};
}

void append_row(const BoundaryTree& tree, const Shapes& shapes,
                std::span<const KernelSample> samples, const dvec3& at_m, ContactSurface& surface) {
    std::map<std::uint32_t, double> weight;
    for (const KernelSample& sample : samples) {
        const std::uint32_t t = sample.at.triangle;
        if (shapes.quadratic.empty()) {
            for (int k = 0; k < 3; ++k)
                weight[tree.triangle[t][k]] += sample.share * sample.at.weight[k];
        } else {
            const std::array<double, 6> value = triangle_shapes(sample.at.weight);
            for (int k = 0; k < 6; ++k)
                weight[shapes.quadratic[t][k]] += sample.share * value[k];
        }
    }
    std::erase_if(weight,
                  [](const auto& entry) { return std::abs(entry.second) < kSmallestWeight; });
    double sum = 0.0;
    for (const auto& [node, w] : weight)
        sum += w;
    dvec3 carried{0.0};
    for (const auto& [node, w] : weight) {
        surface.row_node.push_back(node);
        surface.row_weight.push_back(w / sum);
        carried += w / sum * shapes.node_m[node];
    }
    surface.row_start.push_back(static_cast<std::uint32_t>(surface.row_node.size()));
    surface.offset_m.push_back(at_m - carried);
}

// Volume-weighted mean edge at every node, and with coarse tets below a fine skin counted.
struct NodalSize {
    std::vector<double> own_m, grown_m;
};

NodalSize nodal_sizes(const TetMesh& mesh) {
    const std::size_t nodes = mesh.rest_m.size();
    std::vector<double> sum(nodes, 0.0), volume(nodes, 0.0);
    for (const Tet& tet : mesh.tets) {
        const double v = tet_volume_m3(mesh, tet);
        const double edge = mean_edge_m(mesh, tet);
        for (const std::uint32_t node : tet) {
            sum[node] += v * edge;
            volume[node] += v;
        }
    }
    NodalSize size{std::vector<double>(nodes, 0.0), {}};
    for (std::size_t i = 0; i < nodes; ++i)
        size.own_m[i] = volume[i] > 0.0 ? sum[i] / volume[i] : 0.0;

    // h_i = max_j (h_j - 0.3 |x_i - x_j|)
    size.grown_m = size.own_m;
    for (std::size_t i = 0; i < nodes; ++i) {
        for (std::size_t j = 0; j < nodes; ++j)
            size.grown_m[i] =
                std::max(size.grown_m[i],
                         size.own_m[j] - kGrowth * glm::distance(mesh.rest_m[i], mesh.rest_m[j]));
    }
    return size;
}

// c where the size is `grown_m`, `own_m` without the coarse tets around. Where they count, the mesh
// is graded.
double factor_at(const FootprintOptions& options, double own_m, double grown_m) {
    return options.order == 1
               ? options.size_factor
               : std::min(options.size_factor, options.even_factor * grown_m / own_m);
}

} // namespace

std::vector<double> nodal_size_m(const TetMesh& mesh) {
    return nodal_sizes(mesh).grown_m;
}

void make_footprints(const TetMesh& mesh, std::span<const std::uint8_t> anchored,
                     const FootprintOptions& options, ContactSurface& surface) {
    check_inputs(mesh, anchored, options, surface);
    const BoundaryTree tree = make_boundary_tree(mesh);
    const Shapes shapes = make_shapes(mesh, options.order);
    const NodalSize size = nodal_sizes(mesh);
    const std::vector<dvec3> normal = vertex_normals(surface.rest_m, surface.triangles);
    const std::size_t vertices = surface.rest_m.size();

    surface.neighbours = triangle_neighbours(surface.triangles);
    const BoundaryTree edges = closed(surface)
                                   ? make_surface_tree(surface.rest_m, surface.triangles)
                                   : tree; // a skin over a part says nothing of the body's edges
    surface.row_start.assign(1, 0);
    surface.row_node.clear();
    surface.row_weight.clear();
    surface.offset_m.clear();
    surface.frame_node.clear();
    surface.footprint_radius_m.clear();
    surface.thickness_m.clear();
    surface.mesh_term_n_m.assign(vertices, 0.0);
    surface.mesh_term_t_m.assign(vertices, 0.0);
    surface.mesh_lean_m.assign(vertices, {});

    for (std::size_t v = 0; v < vertices; ++v) {
        const dvec3& at_m = surface.rest_m[v];
        if (normal[v] == dvec3{0.0})
            throw std::invalid_argument("skin vertex " + std::to_string(v) + " has no area");
        const BoundaryPoint near = nearest_point(tree, at_m);
        const double h = size_at(tree, near, size.grown_m);
        FootprintOptions here = options;
        here.size_factor = factor_at(options, size_at(tree, near, size.own_m), h);
        const double reach = kernel_reach_m(h, here);
        const BoundaryPoint below = point_below(tree, at_m, normal[v], reach);
        const double r = kernel_radius_m(edges, at_m, normal[v], h, here);
        if (options.point_rows)
            append_row(tree, shapes, std::vector<KernelSample>{{below, 1.0}}, at_m, surface);
        else
            append_row(tree, shapes, kernel_samples(tree, at_m, normal[v], r, reach), at_m,
                       surface);
        surface.frame_node.push_back(tree.triangle[below.triangle]);
        surface.footprint_radius_m.push_back(r);
        surface.thickness_m.push_back(backed_thickness_m(tree, anchored, below, normal[v]));
    }
}

} // namespace tissue
