// tests/haptics/sampled_face.h
// A square face on the plane z = 0, sampled by n x n patches, and the sampled-data wall.
#pragma once

#include "haptics/rigid/contact_clusters.h"
#include "tests/haptics/convex_pieces.h"

#include <complex>
#include <vector>

/// The face's middle is `depth_m` below the plane, the face turned by `turned` about it.
inline std::vector<haptics::ContactPatch> sampled_face(int n, double side_m, double depth_m,
                                                       const glm::dmat3& turned) {
    std::vector<haptics::ContactPatch> patch;
    const double cell_m = side_m / n;
    const glm::dvec3 up{0, 0, 1}, face = turned * up;
    const glm::dvec3 slope = glm::dot(face, up) * face - up; // of -z, in the face
    for (int i = 0; i < n * n; ++i) {
        std::array<glm::dvec3, 4> corner_m;
        for (int c = 0; c < 4; ++c) {
            const int right = c == 1 || c == 2, up_there = c > 1;
            const glm::dvec3 at_m{(i % n + right) * cell_m - 0.5 * side_m,
                                  (i / n + up_there) * cell_m - 0.5 * side_m, 0.0};
            corner_m[c] = turned * at_m - glm::dvec3{0, 0, depth_m};
        }
        patch.push_back(haptics::part_in_contact(corner_m, up, -corner_m[0].z, slope));
    }
    return patch;
}

inline haptics::Wrench face_wrench(int n, double side_m, double depth_m, const glm::dmat3& turned,
                                   double stiffness_npm, double cluster_m = 5e-3) {
    haptics::ContactList contacts;
    haptics::cluster_contacts(sampled_face(n, side_m, depth_m, turned), {.radius_m = cluster_m},
                              contacts);
    return haptics::contact_wrench(contacts, stiffness_npm, {0, 0, -depth_m});
}

/// Largest eigenvalue of m x'' + b x' = -K x_k, the force held for a tick (zero-order hold).
inline double sampled_wall_radius(double mass_kg, double damping_nspm, double stiffness_npm,
                                  double tick_s) {
    const double rate = damping_nspm / mass_kg, decay = std::exp(-rate * tick_s);
    const double moves = (1.0 - decay) / rate; // x per v
    const double force_x = (tick_s - moves) / damping_nspm, force_v = (1.0 - decay) / damping_nspm;
    const double trace = 1.0 - stiffness_npm * force_x + decay;
    const double det = (1.0 - stiffness_npm * force_x) * decay + stiffness_npm * force_v * moves;
    const std::complex<double> root = std::sqrt(std::complex<double>(trace * trace - 4.0 * det));
    return std::max(std::abs(trace + root), std::abs(trace - root)) / 2.0;
}
