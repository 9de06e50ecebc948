// tissue/reference/onto_skin.cpp
#include "tissue/reference/onto_skin.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tissue {
namespace {

using glm::dvec3;

constexpr double kFade = 5.0;     // widths of the fade per length of the longest move in it
constexpr double kSettled = 1e-4; // of the longest move: a sweep's change when inner nodes rest
constexpr int kMostSweeps = 2000;
constexpr double kLeastLeft = 0.2; // of a tet's volume

using Neighbours = std::vector<std::vector<std::uint32_t>>;

Neighbours neighbours_of(const TetMesh& mesh) {
    Neighbours near(mesh.rest_m.size());
    for (const Tet& t : mesh.tets) {
        for (const std::uint32_t a : t) {
            for (const std::uint32_t b : t) {
                if (a != b)
                    near[a].push_back(b);
            }
        }
    }
    for (auto& list : near) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return near;
}

// 1 up to `whole_m`, 0 from `width_m` farther, without a kink.
double share_at(double distance_m, double whole_m, double width_m) noexcept {
    const double t = std::clamp((distance_m - whole_m) / width_m, 0.0, 1.0);
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

std::vector<std::uint8_t> outer_nodes(const TetMesh& mesh) {
    std::vector<std::uint8_t> outer(mesh.rest_m.size(), 0);
    for (const Triangle& t : boundary_triangles(mesh)) {
        for (const std::uint32_t node : t)
            outer[node] = 1;
    }
    return outer;
}

std::vector<dvec3> outer_moves(const SmoothSkin& skin, const dvec3& place_m, double whole_m,
                               const TetMesh& mesh, std::span<const std::uint8_t> outer) {
    std::vector<dvec3> move_m(mesh.rest_m.size());
    double width_m = whole_m;
    for (std::size_t i = 0; i < move_m.size(); ++i) {
        const dvec3& from_m = mesh.rest_m[i];
        move_m[i] = outer[i] ? on_smooth_skin(skin, from_m) - from_m : dvec3{0.0};
        if (glm::distance(from_m, place_m) < 2.0 * whole_m)
            width_m = std::max(width_m, kFade * glm::length(move_m[i]));
    }
    for (std::size_t i = 0; i < move_m.size(); ++i)
        move_m[i] *= share_at(glm::distance(mesh.rest_m[i], place_m), whole_m, width_m);
    return move_m;
}

// Gauss-Seidel over the nodes that are not of the boundary.
void spread_inwards(const Neighbours& near, std::span<const std::uint8_t> outer, double longest_m,
                    std::span<dvec3> move_m) {
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        double change_m = 0.0;
        for (std::size_t i = 0; i < move_m.size(); ++i) {
            if (outer[i] || near[i].empty())
                continue;
            dvec3 mean{0.0};
            for (const std::uint32_t n : near[i])
                mean += move_m[n];
            mean /= static_cast<double>(near[i].size());
            change_m = std::max(change_m, glm::distance(mean, move_m[i]));
            move_m[i] = mean;
        }
        if (change_m <= kSettled * longest_m)
            return;
    }
}

TetMesh moved(TetMesh mesh, std::span<const dvec3> move_m) {
    for (std::size_t i = 0; i < mesh.rest_m.size(); ++i)
        mesh.rest_m[i] += move_m[i];
    return mesh;
}

double volume_of(const TetMesh& mesh, const Tet& t) noexcept {
    const dvec3 x = mesh.rest_m[t[0]];
    return glm::dot(glm::cross(mesh.rest_m[t[1]] - x, mesh.rest_m[t[2]] - x),
                    mesh.rest_m[t[3]] - x) /
           6.0;
}

// Halves the moves around every tet that lost too much: flat ones with all corners on the boundary
// cannot follow it. False: there is none.
bool give_way(const TetMesh& mesh, const TetMesh& laid, std::span<dvec3> move_m) {
    std::vector<std::uint8_t> halve(move_m.size(), 0);
    bool any = false;
    for (const Tet& t : mesh.tets) {
        if (volume_of(laid, t) >= kLeastLeft * volume_of(mesh, t))
            continue;
        any = true;
        for (const std::uint32_t node : t)
            halve[node] = 1;
    }
    for (std::size_t i = 0; i < move_m.size(); ++i)
        move_m[i] *= halve[i] ? 0.5 : 1.0;
    return any;
}

double farthest_off(const SmoothSkin& skin, const dvec3& place_m, double within_m,
                    const TetMesh& mesh, std::span<const std::uint8_t> outer) {
    double off_m = 0.0;
    for (std::size_t i = 0; i < outer.size(); ++i) {
        const dvec3& x = mesh.rest_m[i];
        if (outer[i] && glm::distance(x, place_m) < within_m)
            off_m = std::max(off_m, glm::distance(on_smooth_skin(skin, x), x));
    }
    return off_m;
}

} // namespace

SmoothSkin make_smooth_skin(const ContactSurface& surface) {
    ContactSurface at_rest; // without rows, so it stays where it is
    at_rest.rest_m = surface.rest_m;
    at_rest.triangles = surface.triangles;
    SmoothSkin skin;
    skin.tree = make_surface_tree(surface.rest_m, surface.triangles);
    skin.normal.resize(surface.rest_m.size());
    std::vector<dvec3> place_m(surface.rest_m.size());
    place_surface(at_rest, {}, {}, place_m, skin.normal);
    return skin;
}

dvec3 on_smooth_skin(const SmoothSkin& skin, const dvec3& from_m) {
    const BoundaryPoint at = nearest_point(skin.tree, from_m);
    const dvec3 flat_m = position_m(skin.tree, at);
    dvec3 lift_m{0.0};
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t v = skin.tree.triangle[at.triangle][k];
        const double over_m = glm::dot(skin.tree.node_m[v] - flat_m, skin.normal[v]);
        lift_m += 0.5 * at.weight[k] * over_m * skin.normal[v];
    }
    return flat_m + lift_m;
}

double lay_onto_skin(const SmoothSkin& skin, const dvec3& place_m, double whole_m, TetMesh& mesh) {
    check_mesh(mesh);
    const std::vector<std::uint8_t> outer = outer_nodes(mesh);
    std::vector<dvec3> move_m = outer_moves(skin, place_m, whole_m, mesh, outer);
    double longest_m = 0.0;
    for (const dvec3& m : move_m)
        longest_m = std::max(longest_m, glm::length(m));
    spread_inwards(neighbours_of(mesh), outer, longest_m, move_m);
    TetMesh laid = moved(mesh, move_m);
    while (give_way(mesh, laid, move_m))
        laid = moved(mesh, move_m);
    mesh = std::move(laid);
    return farthest_off(skin, place_m, whole_m, mesh, outer);
}

} // namespace tissue
