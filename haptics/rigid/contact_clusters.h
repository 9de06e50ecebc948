// haptics/rigid/contact_clusters.h
// Many contact patches of two bodies become few representative contacts whose stiffness does not
// depend on how many patches there are. step_rigid calls it, and so may any other sampler; 1 kHz.
//
// Clusters and their depth-weighted position, normal and depth as in Kim, Otaduy, Lin, Manocha
// 2003 (Six-degree-of-freedom haptic rendering using incremental and localized computations), with
// integrals over the area in place of sums over samples:
//
//   W = int d dA,  D = int d^2 dA / W,  P = int x d dA / W,  N ~ int n d dA      over d > 0
//
// A patch that enters brings W = 0 and grows, so nothing jumps; a patch split in two brings the
// same integrals. Clusters with like normals N share the stiffness k by their weights,
//
//   F_c = k (W_c / s_c) (q_c / s_c) N_c at P_c,   s_c = sum_j K_cj W_j,  q_c = sum_j K_cj W_j D_j,
//   K_cj = max(0, N_c . N_j)^4,
//
// so a face on a plane has stiffness k and rotational stiffness k <x^2>, cut in however many
// clusters; faces at right angles have k each. Leaning by theta at depth d it pushes back more, by
// 1 + theta^2 <x^2>/d^2 in force and in torque: the deep side weighs more.
#pragma once

#include "haptics/rigid/contact_patch.h"

#include <span>

namespace haptics {

/// World frame. The second body feels stiffness * share * depth along `normal` at `place`, the
/// first the opposite.
struct RepresentativeContact {
    glm::dvec3 place_m{0.0};
    glm::dvec3 normal{0.0, 0.0, 1.0};
    double depth_m = 0.0;      // q_c / s_c
    double share = 0.0;        // W_c / s_c, of the stiffness
    glm::dmat3 spread_m2{0.0}; // covariance of the place over the area in contact
    double weight_m3 = 0.0;    // W_c
    double area_m2 = 0.0;      // in contact
};

using ContactList = Bounded<RepresentativeContact, 16>;

struct ClusterParams {
    double radius_m = 5e-3;  // a patch joins a cluster whose first patch is nearer than this ...
    double least_cos = 0.97; // ... and whose normal is as like
};

/// Patches that are not deep are passed over. Beyond 16 clusters a patch joins the one with the
/// most alike normal. The order of the patches decides who is first in a cluster: the same list
/// gives the same result to the bit. Real-time safe.
void cluster_contacts(std::span<const ContactPatch> patch, const ClusterParams& params,
                      ContactList& out) noexcept;

/// Sum of the contacts' forces on the second body, and of their torques about `about_m`.
struct Wrench {
    glm::dvec3 force_n{0.0};
    glm::dvec3 torque_nm{0.0};
};
Wrench contact_wrench(std::span<const RepresentativeContact> contact, double stiffness_npm,
                      const glm::dvec3& about_m) noexcept;

} // namespace haptics
