// haptics/collision/index.h
// Any collision method under one name, so that contact methods and the bench need not know which
// one they work with. Add a method: its header, a line in the list, a name. The questions are
// those of queries.h.
#pragma once

#include "haptics/collision/brute_force.h"
#include "haptics/collision/hash_grid.h"
#include "haptics/collision/hybrid.h"
#include "haptics/collision/obb_tree.h"
#include "haptics/collision/queries.h"
#include "haptics/collision/wide_tree.h"

#include <functional>
#include <span>
#include <string_view>
#include <variant>

namespace haptics {

using CollisionIndex = std::variant<BruteForce, HashGrid, ObbTree, Hybrid, WideTree>;

/// Setup. `name`: one of kCollisionNames; throws std::invalid_argument otherwise, or for a
/// triangle with a vertex that is not there or a vertex that is not finite.
CollisionIndex make_index(std::string_view name, const MeshView& mesh);
inline constexpr std::array<std::string_view, 5> kCollisionNames{"brute-force", "hash-grid",
                                                                 "obb-tree", "hybrid", "ours"};

/// After the vertices have moved. Covers both ends of the interval if the mesh has `before_m`.
void refit(CollisionIndex& index, const MeshView& mesh) noexcept;

SurfaceHit closest_within(const CollisionIndex& index, const MeshView& mesh,
                          const glm::dvec3& place_m, double radius_m) noexcept;
SurfaceHit cast_segment(const CollisionIndex& index, const MeshView& mesh, const glm::dvec3& from_m,
                        const glm::dvec3& to_m) noexcept;
SweepHit sweep_sphere(const CollisionIndex& index, const MeshView& mesh, const glm::dvec3& from_m,
                      const glm::dvec3& to_m, double radius_m) noexcept;
SweepHit sweep_shaft(const CollisionIndex& index, const MeshView& mesh,
                     const MovingSegment& segment, double radius_m) noexcept;
/// Fills `found` with the nearest contacts within the margin, each triangle once, nearest first;
/// returns how many there were, also those for which there was no room (of those, one that a method
/// visits twice counts twice).
std::size_t contacts_within(const CollisionIndex& index, const MeshView& mesh,
                            const glm::dvec3& place_m, double margin_m,
                            std::span<SurfaceHit> found) noexcept;

} // namespace haptics
