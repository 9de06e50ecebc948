// haptics/rigid/contact_patch.h
// A flat piece of contact with its area: what two overlapping pieces, or the points of a shell,
// hand to contact_clusters. 1 kHz.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>

namespace haptics {

/// Depth is linear over a patch: a point x of it is depth + slope . (x - middle) deep, along the
/// normal. The patch itself may lie askew to the normal. It may reach out of contact, where depth
/// is negative.
struct ContactPatch {
    glm::dvec3 middle_m{0.0};         // centroid, world
    glm::dvec3 normal{0.0, 0.0, 1.0}; // unit, the way the second body is pushed
    double depth_m = 0.0;             // at the middle
    double area_m2 = 0.0;
    glm::dvec3 slope{0.0};     // gradient of depth in the patch, m/m
    glm::dmat3 spread_m4{0.0}; // integral of (x - middle)(x - middle)^T over the area
};

/// The part of a convex polygon that is in contact, exact: its corners in order, the depth at the
/// first and the gradient of depth over it. Area 0 if there is none. At most 256 corners, the rest
/// are left out. Real-time safe.
ContactPatch part_in_contact(std::span<const glm::dvec3> corner_m, const glm::dvec3& normal,
                             double first_depth_m, const glm::dvec3& slope) noexcept;

/// What fits; the rest is counted, not stored.
template <class T, std::uint32_t N> struct Bounded {
    std::array<T, N> item;
    std::uint32_t count = 0, dropped = 0;

    void add(const T& value) noexcept {
        if (count < N)
            item[count++] = value;
        else
            ++dropped;
    }
    const T* begin() const noexcept { return item.data(); }
    const T* end() const noexcept { return item.data() + count; }
    T* begin() noexcept { return item.data(); }
    T* end() noexcept { return item.data() + count; }
};

using PatchList = Bounded<ContactPatch, 512>;

} // namespace haptics
