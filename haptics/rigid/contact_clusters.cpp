#include "haptics/rigid/contact_clusters.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace haptics {
namespace {

using glm::dvec3;

// Integrals over the part of a patch that is in contact.
struct Moments {
    double weight = 0.0, square = 0.0; // of d, d^2
    dvec3 place{0.0};                  // of x d
    double area = 0.0;
    dvec3 middle{0.0}; // of x
    glm::dmat3 spread{0.0};
};

// Positions are relative to the patch's middle. Depth is taken as spread evenly over
// depth +- h: exact where the patch is wholly in contact, and for a rectangle that goes in along
// one of its axes.
Moments moments_of(const ContactPatch& p) noexcept {
    Moments m;
    const dvec3 lean = p.spread_m4 * p.slope; // int x (d - depth) dA
    const double variance = glm::dot(p.slope, lean);
    const double h = p.area_m2 > 0.0 ? std::sqrt(3.0 * std::max(0.0, variance) / p.area_m2) : 0.0;
    const double most = p.depth_m + h;
    if (!(most > 0.0) || !(p.area_m2 > 0.0))
        return m;
    if (p.whole || p.depth_m >= h) {
        m.weight = p.area_m2 * p.depth_m;
        m.square = p.area_m2 * p.depth_m * p.depth_m + variance;
        m.place = lean;
        m.area = p.area_m2;
        m.spread = p.spread_m4;
        return m;
    }
    m.weight = p.area_m2 * most * most / (4.0 * h);
    m.square = p.area_m2 * most * most * most / (6.0 * h);
    m.place = lean / variance * (m.square - p.depth_m * m.weight);
    m.area = p.area_m2 * most / (2.0 * h);
    m.middle = lean / variance * (m.area * 0.5 * (h - p.depth_m));
    m.spread = p.spread_m4 * (most / (2.0 * h));
    return m;
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
    c.sum.middle += m.middle + m.area * shift_m;
    c.sum.spread += m.spread + glm::outerProduct(m.middle, shift_m) +
                    glm::outerProduct(shift_m, m.middle) +
                    m.area * glm::outerProduct(shift_m, shift_m);
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
