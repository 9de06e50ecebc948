#include "assets/bake/remesh.h"

#include "assets/bake/nearest.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace bake {
namespace {

using Mesh = HalfEdgeMesh;
using Vertex = OpenMesh::VertexHandle;
using Edge = OpenMesh::EdgeHandle;
using HalfEdge = OpenMesh::HalfedgeHandle;

constexpr double kLong = 4.0 / 3.0, kShort = 4.0 / 5.0; // Botsch & Kobbelt's limits
constexpr double kGrowth = 0.5;                         // of the size, per unit of distance

int creases_at(const Mesh& mesh, Vertex v) {
    int count = 0;
    for (const auto e : mesh.ve_range(v)) {
        count += mesh.status(e).feature() ? 1 : 0;
    }
    return count;
}

void mark_creases(Mesh& mesh, double crease_deg) {
    const double limit = crease_deg * std::numbers::pi / 180.0;
    for (const auto e : mesh.edges()) {
        const bool crease =
            mesh.is_boundary(e) ||
            (crease_deg < 180.0 &&
             std::abs(mesh.calc_dihedral_angle(mesh.halfedge_handle(e, 0))) > limit);
        mesh.status(e).set_feature(crease);
    }
}

void mark_tips(Mesh& mesh, double tip_deg) {
    std::vector<double> sum(mesh.n_vertices(), 0.0);
    for (const auto h : mesh.halfedges()) {
        if (!mesh.is_boundary(h)) {
            sum[mesh.to_vertex_handle(h).idx()] += mesh.calc_sector_angle(h);
        }
    }
    for (const auto v : mesh.vertices()) {
        mesh.status(v).set_locked(sum[v.idx()] < tip_deg * std::numbers::pi / 180.0);
    }
}

double edge_over_size(const Mesh& mesh, Edge e, const SizeAt& size) {
    const HalfEdge h = mesh.halfedge_handle(e, 0);
    const glm::dvec3 a = to_glm(mesh.point(mesh.from_vertex_handle(h)));
    const glm::dvec3 b = to_glm(mesh.point(mesh.to_vertex_handle(h)));
    return glm::length(b - a) / size(0.5 * (a + b));
}

void split_long(Mesh& mesh, const SizeAt& size) {
    const std::size_t count = mesh.n_edges(); // new edges wait for the next round
    for (std::size_t i = 0; i < count; ++i) {
        const Edge e(static_cast<int>(i));
        if (edge_over_size(mesh, e, size) <= kLong) {
            continue;
        }
        const HalfEdge h = mesh.halfedge_handle(e, 0);
        const Vertex a = mesh.from_vertex_handle(h), b = mesh.to_vertex_handle(h);
        const bool crease = mesh.status(e).feature();
        const Vertex middle = mesh.add_vertex((mesh.point(a) + mesh.point(b)) * 0.5);
        mesh.split(e, middle);
        for (const auto half : mesh.voh_range(middle)) {
            const Vertex to = mesh.to_vertex_handle(half);
            mesh.status(mesh.edge_handle(half)).set_feature(crease && (to == a || to == b));
        }
    }
}

/// A triangle may turn by at most 60 degrees when one corner moves.
bool turns_over(const Mesh& mesh, HalfEdge collapse) {
    const Vertex from = mesh.from_vertex_handle(collapse), to = mesh.to_vertex_handle(collapse);
    for (const auto f : mesh.vf_range(from)) {
        std::array<glm::dvec3, 3> before{}, after{};
        std::size_t k = 0;
        bool goes = false;
        for (const auto v : mesh.fv_range(f)) {
            goes = goes || v == to;
            before[k] = to_glm(mesh.point(v));
            after[k] = v == from ? to_glm(mesh.point(to)) : before[k];
            ++k;
        }
        if (goes) {
            continue;
        }
        const glm::dvec3 n0 = glm::cross(before[1] - before[0], before[2] - before[0]);
        const glm::dvec3 n1 = glm::cross(after[1] - after[0], after[2] - after[0]);
        if (glm::dot(n0, n1) < 0.5 * glm::length(n0) * glm::length(n1)) {
            return true;
        }
    }
    return false;
}

bool may_collapse(Mesh& mesh, HalfEdge h, const SizeAt& size) {
    const Vertex from = mesh.from_vertex_handle(h), to = mesh.to_vertex_handle(h);
    const int creases = creases_at(mesh, from);
    if (mesh.status(from).locked()) {
        return false;
    }
    if (creases != 0 && (creases != 2 || !mesh.status(mesh.edge_handle(h)).feature())) {
        return false;
    }
    if (!mesh.is_collapse_ok(h)) {
        return false;
    }
    const glm::dvec3 target = to_glm(mesh.point(to));
    for (const auto v : mesh.vv_range(from)) {
        const glm::dvec3 p = to_glm(mesh.point(v));
        if (glm::length(p - target) > kLong * size(0.5 * (p + target))) {
            return false;
        }
    }
    return !turns_over(mesh, h);
}

void collapse_short(Mesh& mesh, const SizeAt& size) {
    for (std::size_t i = 0; i < mesh.n_edges(); ++i) {
        const Edge e(static_cast<int>(i));
        if (mesh.status(e).deleted() || edge_over_size(mesh, e, size) >= kShort) {
            continue;
        }
        for (unsigned int side = 0; side < 2; ++side) {
            const HalfEdge h = mesh.halfedge_handle(e, side);
            if (may_collapse(mesh, h, size)) {
                // the edges that replace a crease are creases
                std::vector<Vertex> crease_ends;
                for (const auto half : mesh.voh_range(mesh.from_vertex_handle(h))) {
                    if (mesh.status(mesh.edge_handle(half)).feature()) {
                        crease_ends.push_back(mesh.to_vertex_handle(half));
                    }
                }
                const Vertex to = mesh.to_vertex_handle(h);
                mesh.collapse(h);
                for (const auto end : crease_ends) {
                    const HalfEdge joined = mesh.find_halfedge(to, end);
                    if (joined.is_valid()) {
                        mesh.status(mesh.edge_handle(joined)).set_feature(true);
                    }
                }
                break;
            }
        }
    }
    mesh.garbage_collection();
}

void flip_to_six(Mesh& mesh) {
    for (const auto e : mesh.edges()) {
        if (mesh.status(e).feature() || !mesh.is_flip_ok(e)) {
            continue;
        }
        const HalfEdge h = mesh.halfedge_handle(e, 0), o = mesh.halfedge_handle(e, 1);
        const std::array<Vertex, 4> v{mesh.from_vertex_handle(h), mesh.to_vertex_handle(h),
                                      mesh.to_vertex_handle(mesh.next_halfedge_handle(h)),
                                      mesh.to_vertex_handle(mesh.next_halfedge_handle(o))};
        // squared distance from the wanted number of neighbours, now and after
        constexpr std::array<int, 4> kChange{-1, -1, 1, 1};
        int now = 0, then = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const int excess =
                static_cast<int>(mesh.valence(v[k])) - (creases_at(mesh, v[k]) > 0 ? 5 : 6);
            now += excess * excess;
            then += (excess + kChange[k]) * (excess + kChange[k]);
        }
        if (then >= now) {
            continue;
        }
        // only where the two triangles are nearly one plane, and stay so
        const glm::dvec3 a = to_glm(mesh.point(v[0])), b = to_glm(mesh.point(v[1])),
                         c = to_glm(mesh.point(v[2])), d = to_glm(mesh.point(v[3]));
        const glm::dvec3 n0 = glm::cross(b - a, c - a), n1 = glm::cross(a - b, d - b);
        const glm::dvec3 m0 = glm::cross(d - c, b - c), m1 = glm::cross(c - d, a - d);
        const bool bent = glm::dot(n0, n1) < 0.7 * glm::length(n0) * glm::length(n1) ||
                          glm::dot(m0, m1) < 0.7 * glm::length(m0) * glm::length(m1) ||
                          glm::dot(n0 + n1, m0) <= 0.0 || glm::dot(n0 + n1, m1) <= 0.0;
        if (!bent) {
            mesh.flip(e);
        }
    }
}

void relax(Mesh& mesh, const NearestOnSurface& shape) {
    mesh.update_normals();
    std::vector<glm::dvec3> next(mesh.n_vertices());
    for (const auto v : mesh.vertices()) {
        const glm::dvec3 p = to_glm(mesh.point(v));
        const int creases = creases_at(mesh, v);
        glm::dvec3 sum{0.0};
        double weight = 0.0;
        for (const auto half : mesh.voh_range(v)) {
            if (creases == 0 || mesh.status(mesh.edge_handle(half)).feature()) {
                sum += to_glm(mesh.point(mesh.to_vertex_handle(half)));
                weight += 1.0;
            }
        }
        next[v.idx()] = p;
        if (mesh.status(v).locked()) {
            continue;
        }
        if (creases == 0) {
            const glm::dvec3 n = to_glm(mesh.normal(v)), move = sum / weight - p;
            next[v.idx()] = shape(p + (move - n * glm::dot(n, move))).point_m;
        } else if (creases == 2) {
            next[v.idx()] = shape(p + 0.5 * (sum / weight - p)).point_m;
        }
    }
    for (const auto v : mesh.vertices()) {
        mesh.set_point(v, to_openmesh(next[v.idx()]));
    }
}

} // namespace

Surface remesh(const Surface& shape, const SizeAt& size, const RemeshOptions& options) {
    const NearestOnSurface nearest(shape);
    Mesh mesh = make_half_edges(shape);
    mesh.request_face_normals();
    mesh.request_vertex_normals();
    mark_creases(mesh, options.crease_deg);
    mark_tips(mesh, options.tip_deg);
    for (int round = 0; round < options.rounds; ++round) {
        split_long(mesh, size);
        collapse_short(mesh, size);
        flip_to_six(mesh);
        relax(mesh, nearest);
    }
    return make_surface(mesh);
}

Surface coarsen(const Surface& shape, double edge_m) {
    constexpr int kRounds = 12; // each takes about half of what is too short
    Mesh mesh = make_half_edges(shape);
    const SizeAt size = [edge_m](const glm::dvec3&) { return edge_m / kShort; };
    for (int round = 0; round < kRounds; ++round) {
        const std::size_t before = mesh.n_faces();
        collapse_short(mesh, size);
        if (mesh.n_faces() > before - before / 50) {
            break;
        }
    }
    return make_surface(mesh);
}

SizeAt curvature_size(const Surface& shape, double edge_m, double radii, double share) {
    // curvature along each edge: change of normal over length
    const auto normal = vertex_normals(shape);
    std::vector<double> size(shape.point_m.size(), edge_m);
    const double least_m = share * edge_m;
    for (const auto& t : shape.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = t[k], b = t[(k + 1) % 3];
            const double length = glm::length(shape.point_m[b] - shape.point_m[a]);
            const double bend = glm::length(normal[b] - normal[a]);
            const double wanted = bend > 0.0 ? radii * length / bend : edge_m;
            for (const auto v : {a, b}) {
                size[v] = std::clamp(wanted, least_m, size[v]);
            }
        }
    }
    return graded_size(shape, std::move(size));
}

SizeAt graded_size(const Surface& shape, std::vector<double> size_m) {
    const auto size = std::make_shared<std::vector<double>>(std::move(size_m));
    // let it grow slowly along the surface, until nothing changes
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& t : shape.triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                const auto a = t[k], b = t[(k + 1) % 3];
                const double most =
                    kGrowth * glm::length(shape.point_m[b] - shape.point_m[a]) + 1e-9;
                for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
                    if ((*size)[to] > (*size)[from] + most) {
                        (*size)[to] = (*size)[from] + most;
                        changed = true;
                    }
                }
            }
        }
    }
    const auto copy = std::make_shared<Surface>(shape);
    const auto nearest = std::make_shared<NearestOnSurface>(*copy);
    return [copy, nearest, size](const glm::dvec3& p) {
        const auto near = (*nearest)(p);
        const auto& t = copy->triangles[near.triangle];
        return near.weight.x * (*size)[t[0]] + near.weight.y * (*size)[t[1]] +
               near.weight.z * (*size)[t[2]];
    };
}

} // namespace bake
