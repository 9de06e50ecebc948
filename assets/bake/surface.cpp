#include "assets/bake/surface.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>

namespace bake {
namespace {

constexpr double kFlat = 1e-4; // smallest height over longest edge

double height_over_edge(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    return longest > 0.0 ? glm::length(glm::cross(b - a, c - a)) / (longest * longest) : 0.0;
}

OpenMesh::FaceHandle try_add(HalfEdgeMesh& mesh, const tissue::Triangle& t) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
        return OpenMesh::FaceHandle();
    }
    const OpenMesh::VertexHandle a(static_cast<int>(t[0])), b(static_cast<int>(t[1])),
        c(static_cast<int>(t[2]));
    // add_face prints to the terminal when an edge is taken; ask before
    for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
        const auto edge = mesh.find_halfedge(from, to);
        if ((edge.is_valid() && !mesh.is_boundary(edge)) || !mesh.is_boundary(from)) {
            return OpenMesh::FaceHandle();
        }
    }
    return mesh.add_face(a, b, c);
}

HalfEdgeMesh with_points(const Surface& surface) {
    HalfEdgeMesh mesh;
    for (const auto& p : surface.point_m) {
        mesh.add_vertex(to_openmesh(p));
    }
    return mesh;
}

int count_shells(const HalfEdgeMesh& mesh) {
    std::vector<char> seen(mesh.n_faces(), 0);
    int shells = 0;
    for (const auto first : mesh.faces()) {
        if (seen[first.idx()]) {
            continue;
        }
        ++shells;
        std::vector<OpenMesh::FaceHandle> open{first};
        seen[first.idx()] = 1;
        while (!open.empty()) {
            const auto face = open.back();
            open.pop_back();
            for (const auto next : mesh.ff_range(face)) {
                if (!seen[next.idx()]) {
                    seen[next.idx()] = 1;
                    open.push_back(next);
                }
            }
        }
    }
    return shells;
}

} // namespace

std::vector<std::string> describe(const SurfaceProblems& p) {
    std::vector<std::string> lines;
    const auto say = [&](int count, const char* what) {
        if (count > 0) {
            lines.push_back(fmt::format("{} {}", count, what));
        }
    };
    say(p.refused_triangles, "triangles are not manifold or not oriented like their neighbours");
    say(p.open_edges, "edges have a triangle on one side only");
    say(p.pinched_vertices, "vertices join two fans of triangles");
    say(p.flat_triangles, "triangles have no area");
    if (p.shells != 1) {
        lines.push_back(fmt::format("{} separate pieces, one expected", p.shells));
    }
    if (p.inside_out) {
        lines.emplace_back("the triangles face inwards");
    }
    return lines;
}

SurfaceProblems check_surface(const Surface& surface) {
    SurfaceProblems problems;
    HalfEdgeMesh mesh = with_points(surface);
    for (const auto& t : surface.triangles) {
        if (!try_add(mesh, t).is_valid()) {
            ++problems.refused_triangles;
        } else if (height_over_edge(surface.point_m[t[0]], surface.point_m[t[1]],
                                    surface.point_m[t[2]]) < kFlat) {
            ++problems.flat_triangles;
        }
    }
    for (const auto edge : mesh.edges()) {
        problems.open_edges += mesh.is_boundary(edge) ? 1 : 0;
    }
    for (const auto vertex : mesh.vertices()) {
        problems.pinched_vertices += mesh.is_manifold(vertex) ? 0 : 1;
    }
    problems.shells = count_shells(mesh);
    problems.inside_out = problems.open_edges == 0 && volume_m3(surface) < 0.0;
    return problems;
}

HalfEdgeMesh make_half_edges(const Surface& surface) {
    HalfEdgeMesh mesh = with_points(surface);
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
        if (!try_add(mesh, surface.triangles[i]).is_valid()) {
            throw std::invalid_argument(
                fmt::format("triangle {} is not manifold or not oriented like its neighbours", i));
        }
    }
    return mesh;
}

Surface make_surface(const HalfEdgeMesh& mesh) {
    Surface surface;
    for (const auto vertex : mesh.vertices()) {
        surface.point_m.push_back(to_glm(mesh.point(vertex)));
    }
    for (const auto face : mesh.faces()) {
        tissue::Triangle t{};
        std::size_t k = 0;
        for (const auto vertex : mesh.fv_range(face)) {
            t[k++] = static_cast<std::uint32_t>(vertex.idx());
        }
        surface.triangles.push_back(t);
    }
    return surface;
}

double area_m2(const Surface& s) {
    double twice = 0.0;
    for (const auto& t : s.triangles) {
        twice += glm::length(
            glm::cross(s.point_m[t[1]] - s.point_m[t[0]], s.point_m[t[2]] - s.point_m[t[0]]));
    }
    return 0.5 * twice;
}

double mean_edge_m(const Surface& surface) {
    const double each_m2 = area_m2(surface) / static_cast<double>(surface.triangles.size());
    return std::sqrt(each_m2 * 4.0 / std::sqrt(3.0));
}

double volume_m3(const Surface& s) {
    double six = 0.0; // Gauss: the tetrahedra from the origin to each triangle
    for (const auto& t : s.triangles) {
        six += glm::dot(s.point_m[t[0]], glm::cross(s.point_m[t[1]], s.point_m[t[2]]));
    }
    return six / 6.0;
}

std::vector<glm::dvec3> vertex_normals(const Surface& s) {
    std::vector<glm::dvec3> normal(s.point_m.size(), glm::dvec3{0.0});
    for (const auto& t : s.triangles) {
        const glm::dvec3 n =
            glm::cross(s.point_m[t[1]] - s.point_m[t[0]], s.point_m[t[2]] - s.point_m[t[0]]);
        for (const auto v : t) {
            normal[v] += n;
        }
    }
    for (auto& n : normal) {
        const double length = glm::length(n);
        n = length > 0.0 ? n / length : glm::dvec3{0.0, 0.0, 1.0};
    }
    return normal;
}

} // namespace bake
