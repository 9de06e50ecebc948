#include "haptics/contact/grasp.h"

#include "haptics/contact/coulomb_disc.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace haptics {

void release_grasp(ContactMemory& memory) noexcept {
    const bool pressed = memory.x > 0.0;
    memory = pressed ? ContactMemory{.touching = true,
                                     .friction_n = memory.friction_n,
                                     .lag_m = memory.lag_m,
                                     .x = memory.x}
                     : ContactMemory{};
}

bool begin_grasp(const ContactRow& row, const JawGrip& grip, ContactMemory& memory) noexcept {
    if (!row.law.table || !(grip.hold_n > 0.0))
        return false;
    const glm::dvec3 n = row.normal;
    if (memory.touching) {
        // force and offset go on from what friction and pressure have made of them
        const double soft = grasp_compliance(row.law).tangential_mpn;
        memory.grip_m = row.tip_radius_m * n + memory.lag_m + soft * memory.friction_n;
    } else {
        const glm::dvec3 above_m = grip.closed_at_m - row.surface_free_m;
        const double height_m = glm::dot(n, above_m);
        if (!(height_m <= row.tip_radius_m + kGraspReach_m &&
              glm::length(above_m - height_m * n) <= row.tip_radius_m))
            return false;
        memory = {};
        memory.grip_m = above_m + n * (std::max(height_m, row.tip_radius_m) - height_m);
    }
    memory.touching = memory.grasped = true;
    return true;
}

PullPoint pull_minimum(const glm::dmat3& A, const glm::dvec3& b, double radius) noexcept {
    // 1/|F| is concave in the multiplier: Newton from the left stays left of the root (More &
    // Sorensen 1983)
    double multiplier = 0.0;
    glm::dmat3 inverse = glm::inverse(A);
    glm::dvec3 f = inverse * b;
    for (int i = 0; i < 50 && glm::length(f) > radius * (1.0 + 1e-14); ++i) {
        const double length = glm::length(f);
        multiplier += (length - radius) / radius * glm::dot(f, f) / glm::dot(f, inverse * f);
        inverse = glm::inverse(A + glm::dmat3{multiplier});
        f = inverse * b;
    }
    if (f.z <= 0.0)
        return {f, multiplier};

    // pressed, not pulled: on the face between the two
    const DiscPoint disc = disc_minimum(glm::dmat2{A}, glm::dvec2{b}, radius);
    return {{disc.f, 0.0}, disc.multiplier};
}

} // namespace haptics
