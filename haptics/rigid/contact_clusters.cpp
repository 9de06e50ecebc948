#include "haptics/rigid/contact_clusters.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace haptics {
namespace {

using glm::dvec3;

// Integrals over a patch; places are seen from where the sum says.
struct Moments {
    double weight = 0.0, square = 0.0; // of d, d^2
    dvec3 place{0.0};                  // of x d
    double area = 0.0;
    dvec3 middle{0.0}; // of x
    glm::dmat3 spread{0.0};
};

// From the middle of the patch; exact, as depth is linear.
Moments moments_of(const ContactPatch& p) noexcept {
    const dvec3 lean = p.spread_m4 * p.slope; // int x d dA
    return {.weight = p.area_m2 * p.depth_m,
            .square = p.area_m2 * p.depth_m * p.depth_m + glm::dot(p.slope, lean),
            .place = lean,
            .area = p.area_m2,
            .spread = p.spread_m4};
}

struct Cluster {
    dvec3 first_m{0.0}; // all places are relative to this
    Moments sum;
    dvec3 normal{0.0};
};

using Clusters = Bounded<Cluster, 16>;

Cluster& cluster_for(Clusters& clusters, const ContactPatch& p,
                     const ClusterParams& params) noexcept {
    Cluster* most_alike = nullptr;
    double most = -2.0;
    for (Cluster& c : clusters) {
        const double alike = glm::dot(glm::normalize(c.normal), p.normal);
        const dvec3 way_m = p.middle_m - c.first_m;
        if (alike >= params.least_cos &&
            glm::dot(way_m, way_m) <= params.radius_m * params.radius_m)
            return c;
        if (alike > most) {
            most = alike;
            most_alike = &c;
        }
    }
    if (clusters.count == clusters.item.size())
        return *most_alike;
    clusters.add({.first_m = p.middle_m, .sum = {}});
    return clusters.item[clusters.count - 1];
}

void join(Cluster& c, const ContactPatch& p, const Moments& m) noexcept {
    const dvec3 shift_m = p.middle_m - c.first_m;
    c.normal += m.weight * p.normal;
    c.sum.weight += m.weight;
    c.sum.square += m.square;
    c.sum.place += m.place + m.weight * shift_m;
    c.sum.area += m.area;
    c.sum.middle += m.area * shift_m;
    c.sum.spread += m.spread + m.area * glm::outerProduct(shift_m, shift_m);
}

RepresentativeContact represent(const Cluster& c) noexcept {
    const dvec3 middle = c.sum.middle / c.sum.area;
    return {.place_m = c.first_m + c.sum.place / c.sum.weight,
            .normal = glm::normalize(c.normal),
            .depth_m = c.sum.square / c.sum.weight,
            .spread_m2 = c.sum.spread / c.sum.area - glm::outerProduct(middle, middle),
            .weight_m3 = c.sum.weight,
            .area_m2 = c.sum.area};
}

// Contacts that push the same way share one stiffness.
void share_stiffness(ContactList& contacts) noexcept {
    std::array<double, 16> share{}, depth_m{};
    for (std::uint32_t i = 0; i < contacts.count; ++i) {
        double weight = 0.0, square = 0.0;
        for (const RepresentativeContact& other : contacts) {
            const double c = std::max(0.0, glm::dot(contacts.item[i].normal, other.normal));
            weight += c * c * c * c * other.weight_m3;
            square += c * c * c * c * other.weight_m3 * other.depth_m;
        }
        share[i] = contacts.item[i].weight_m3 / weight;
        depth_m[i] = square / weight;
    }
    for (std::uint32_t i = 0; i < contacts.count; ++i) {
        contacts.item[i].share = share[i];
        contacts.item[i].depth_m = depth_m[i];
    }
}

} // namespace

void cluster_contacts(std::span<const ContactPatch> patch, const ClusterParams& params,
                      ContactList& out) noexcept {
    Clusters clusters;
    for (const ContactPatch& p : patch) {
        const Moments m = moments_of(p);
        if (m.weight > 0.0)
            join(cluster_for(clusters, p, params), p, m);
    }
    out.count = 0;
    for (const Cluster& c : clusters)
        if (glm::dot(c.normal, c.normal) > 0.0)
            out.add(represent(c));
    share_stiffness(out);
}

Wrench contact_wrench(std::span<const RepresentativeContact> contact, double stiffness_npm,
                      const dvec3& about_m) noexcept {
    Wrench sum;
    for (const RepresentativeContact& c : contact) {
        const dvec3 force_n = stiffness_npm * c.share * c.depth_m * c.normal;
        sum.force_n += force_n;
        sum.torque_nm += glm::cross(c.place_m - about_m, force_n);
    }
    return sum;
}

} // namespace haptics
