// tissue/reference/tip_contact.cpp
// Gap, energy, force and tangent of a tip on six-node faces.
#include "tissue/reference/tip_contact.h"

#include "tissue/reference/reference_element.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tissue {
namespace {

using glm::dmat3;
using glm::dvec3;

// Corners of the face opposite corner k, counter-clockwise from outside, then the local nodes on
// its edges 0-1, 1-2, 2-0 (see kEdge).
constexpr std::array<std::array<std::uint8_t, 6>, 4> kFaceNodes{
    {{1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}, {0, 1, 3, 4, 8, 7}, {0, 2, 1, 6, 5, 4}}};

struct FaceRule {
    std::array<double, 3> at;
    double weight; // of the face's area
};

// Degree 4, positive (Dunavant 1985).
constexpr double kA = 0.44594849091596489, kB = 0.091576213509770743;
constexpr double kWeightA = 0.22338158967801147, kWeightB = 0.10995174365532187;
constexpr std::array<FaceRule, 6> kSixPoints{{{{kA, kA, 1 - 2 * kA}, kWeightA},
                                              {{kA, 1 - 2 * kA, kA}, kWeightA},
                                              {{1 - 2 * kA, kA, kA}, kWeightA},
                                              {{kB, kB, 1 - 2 * kB}, kWeightB},
                                              {{kB, 1 - 2 * kB, kB}, kWeightB},
                                              {{1 - 2 * kB, kB, kB}, kWeightB}}};

std::array<double, 6> face_shapes(const std::array<double, 3>& L) noexcept {
    return {L[0] * (2 * L[0] - 1), L[1] * (2 * L[1] - 1), L[2] * (2 * L[2] - 1),
            4 * L[0] * L[1],       4 * L[1] * L[2],       4 * L[2] * L[0]};
}

void add_face(const QuadraticMesh& mesh, std::uint32_t tet,
              const std::array<std::uint8_t, 6>& local, std::vector<FacePoint>& points) {
    const Tet10& t = mesh.tets[tet];
    const dvec3 a = mesh.rest_m[t[local[0]]];
    const double area_m2 =
        0.5 * glm::length(glm::cross(mesh.rest_m[t[local[1]]] - a, mesh.rest_m[t[local[2]]] - a));
    for (const FaceRule& rule : kSixPoints) {
        points.push_back({.tet = tet,
                          .local = local,
                          .shape = face_shapes(rule.at),
                          .area_m2 = rule.weight * area_m2});
    }
}

// Second derivative of the gap: (I - n n^T [- s s^T beside the shaft]) / distance from the axis.
dmat3 gap_curvature(const Tip& tip, const dvec3& x, const Gap& gap) noexcept {
    dmat3 across = dmat3(1.0) - glm::outerProduct(gap.normal, gap.normal);
    if (glm::dot(x - tip.centre_m, tip.shaft) > 0.0)
        across -= glm::outerProduct(tip.shaft, tip.shaft);
    return across * (1.0 / std::max(gap.value_m + tip.radius_m, 1e-3 * tip.radius_m));
}

// Across the tip's surface where the point was bound.
dmat3 tangent_plane(const TipContact& c, const FacePoint& p) noexcept {
    const dvec3 n = gap_at(c.tip, c.tip.centre_m + p.bound_at_m).normal;
    return dmat3(1.0) - glm::outerProduct(n, n);
}

struct PointTerms {
    dvec3 slope_pa{0.0};
    dmat3 tangent_papm{0.0};
    bool acts = false;
};

PointTerms terms_at(const TipContact& c, const FacePoint& p, const dvec3& x,
                    bool projected) noexcept {
    const double k = c.penalty_papm;
    const Traction t = traction_at(c, p, x);
    PointTerms out;
    if (t.pressure_pa > 0.0) {
        out = {-t.pressure_pa * t.normal, k * glm::outerProduct(t.normal, t.normal), true};
        if (!projected)
            out.tangent_papm -= t.pressure_pa * gap_curvature(c.tip, x, gap_at(c.tip, x));
    }
    if (!p.bound)
        return out;
    out.acts = true;
    out.slope_pa -= t.friction_pa;
    const double s = glm::length(t.way_m);
    dmat3 across = tangent_plane(c, p);
    if (k * s <= p.limit_pa) {
        out.tangent_papm += k * across;
    } else {
        across -= glm::outerProduct(t.way_m, t.way_m) * (1.0 / (s * s));
        out.tangent_papm += p.limit_pa / s * across;
    }
    return out;
}

} // namespace

std::vector<FacePoint> contact_points(const QuadraticMesh& mesh, const dvec3& place_m,
                                      double reach_m) {
    TetMesh corners{mesh.rest_m, {}};
    for (const Tet10& t : mesh.tets)
        corners.tets.push_back({t[0], t[1], t[2], t[3]});
    std::vector<Triangle> faces = boundary_triangles(corners);
    for (Triangle& f : faces)
        std::sort(f.begin(), f.end());
    std::sort(faces.begin(), faces.end());

    std::vector<FacePoint> points;
    for (std::uint32_t e = 0; e < mesh.tets.size(); ++e) {
        for (const auto& local : kFaceNodes) {
            Triangle key{mesh.tets[e][local[0]], mesh.tets[e][local[1]], mesh.tets[e][local[2]]};
            const bool near = std::any_of(key.begin(), key.end(), [&](std::uint32_t node) {
                return glm::distance(mesh.rest_m[node], place_m) < reach_m;
            });
            std::sort(key.begin(), key.end());
            if (near && std::binary_search(faces.begin(), faces.end(), key))
                add_face(mesh, e, local, points);
        }
    }
    return points;
}

Gap gap_at(const Tip& tip, const dvec3& x_m) noexcept {
    const dvec3 from_centre = x_m - tip.centre_m;
    const double along = std::max(0.0, glm::dot(from_centre, tip.shaft));
    const dvec3 away = from_centre - along * tip.shaft;
    const double distance = glm::length(away);
    return {distance - tip.radius_m, distance > 0.0 ? away / distance : -tip.shaft};
}

dvec3 place_of(const QuadraticMesh& mesh, const FacePoint& point,
               std::span<const dvec3> moved_m) noexcept {
    dvec3 x{0.0};
    for (std::size_t a = 0; a < 6; ++a) {
        const std::uint32_t node = mesh.tets[point.tet][point.local[a]];
        x += point.shape[a] * (mesh.rest_m[node] + moved_m[node]);
    }
    return x;
}

Traction traction_at(const TipContact& c, const FacePoint& p, const dvec3& x_m) noexcept {
    const Gap gap = gap_at(c.tip, x_m);
    Traction out{std::max(0.0, p.pressure_pa - c.penalty_papm * gap.value_m), gap.normal};
    if (!p.bound)
        return out;
    out.way_m = tangent_plane(c, p) * (x_m - c.tip.centre_m - p.bound_at_m);
    const double s = glm::length(out.way_m);
    const double held_pa = std::min(c.penalty_papm * s, p.limit_pa);
    if (s > 0.0)
        out.friction_pa = -held_pa / s * out.way_m;
    return out;
}

void learn_contact(const ReferenceModel& model, std::span<const dvec3> moved_m, double friction,
                   TipContact& contact) noexcept {
    for (FacePoint& p : contact.points) {
        const dvec3 x = place_of(model.mesh, p, moved_m);
        const Traction t = traction_at(contact, p, x);
        // what friction does not hold has slipped
        if (p.bound)
            p.bound_at_m += t.way_m + t.friction_pa / contact.penalty_papm;
        else
            p.bound_at_m = x - contact.tip.centre_m;
        p.bound = t.pressure_pa > 0.0 && friction > 0.0;
        p.pressure_pa = t.pressure_pa;
        p.limit_pa = p.bound ? friction * t.pressure_pa : 0.0;
    }
}

double contact_energy_j(const ReferenceModel& model, const TipContact& contact,
                        std::span<const dvec3> moved_m) noexcept {
    const double k = contact.penalty_papm;
    double sum = 0.0;
    for (const FacePoint& p : contact.points) {
        const Traction t = traction_at(contact, p, place_of(model.mesh, p, moved_m));
        sum +=
            0.5 * p.area_m2 / k * (t.pressure_pa * t.pressure_pa - p.pressure_pa * p.pressure_pa);
        if (!p.bound)
            continue;
        const double s = glm::length(t.way_m), m = p.limit_pa;
        sum += p.area_m2 * (k * s <= m ? 0.5 * k * s * s : m * (s - 0.5 * m / k));
    }
    return sum;
}

void linearize_contact(const ReferenceModel& model, const TipContact& contact,
                       std::span<const dvec3> moved_m, bool projected, std::span<double> slope_n,
                       std::span<double> stiffness) noexcept {
    std::fill(slope_n.begin(), slope_n.end(), 0.0);
    for (const FacePoint& p : contact.points) {
        const PointTerms terms = terms_at(contact, p, place_of(model.mesh, p, moved_m), projected);
        if (!terms.acts)
            continue;
        for (std::size_t i = 0; i < 6; ++i) {
            const std::size_t a = p.local[i];
            for (int k = 0; k < 3; ++k) {
                slope_n[3 * model.mesh.tets[p.tet][a] + k] +=
                    p.area_m2 * p.shape[i] * terms.slope_pa[k];
            }
            for (std::size_t j = 0; j < 6; ++j) {
                const std::size_t b = p.local[j];
                if (b > a)
                    continue;
                add_block(model, p.tet, a, b, a * (a + 1) / 2 + b,
                          p.area_m2 * p.shape[i] * p.shape[j] * terms.tangent_papm, stiffness);
            }
        }
    }
}

} // namespace tissue
