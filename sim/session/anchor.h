// sim/session/anchor.h
// What holds an organ, as a scene says it: boxes, spheres, the neighbourhood of another organ,
// painted balls. Each is a signed distance, and all of them together become an elastic bed at load.
// Called when a scene is loaded and by `trocar scene check`; any thread, not real time.
#pragma once

#include "tasks/exercise/toml_reader.h"
#include "tissue/mesh/baked_organ.h"
#include "tissue/response/boundary_tree.h"

#include <memory>
#include <variant>

namespace sim {

struct AnchorBox {
    glm::dvec3 low_m{0.0}, high_m{0.0};
};
struct AnchorBall {
    glm::dvec3 centre_m{0.0};
    double radius_m = 0.0;
};
/// Tissue nearer than `within_m` to the rest surface of another organ of the scene.
struct AnchorTouching {
    std::string organ;
    double within_m = 0.0;
};
/// Balls from a file beside the scene, one "x y z r" a line, millimetres.
struct AnchorRegion {
    std::string file;
    std::vector<AnchorBall> ball; // filled at load
};
using Anchor = std::variant<AnchorBox, AnchorBall, AnchorTouching, AnchorRegion>;

/// One [[organ.anchor]] table. Throws tasks::BadInput.
Anchor parse_anchor(const tasks::TomlTable& table);

/// A region file of at most kMaxRegionBytes; '#' begins a comment. Safe on any bytes. Throws
/// tasks::BadInput with the line for anything that is not four finite numbers in range, for more
/// than kMaxRegionBalls, for a file without a ball, and for too many bytes.
inline constexpr std::size_t kMaxRegionBytes = std::size_t{1} << 20;
inline constexpr std::size_t kMaxRegionBalls = 4096;
std::vector<AnchorBall> parse_region(std::string_view text, const std::string& file);

/// Distance to what an anchor holds, negative inside, never growing faster than the way gone
/// (1-Lipschitz), which lets a bed be sampled with few questions. `surroundings` is the surface of
/// AnchorTouching's organ and may be null for the other kinds.
using DistanceField = std::function<double(const glm::dvec3&)>;
DistanceField anchor_distance(const Anchor& anchor,
                              std::shared_ptr<const tissue::BoundaryTree> surroundings);

/// The bed of all fields together: tissue::make_bed over their union.
std::vector<tissue::BedSample> bed_of(const tissue::TetMesh& mesh,
                                      std::vector<DistanceField> fields, double length_m);

/// Volume that a bed holds, m^3: its samples carry volume / length^2.
double held_volume_m3(std::span<const tissue::BedSample> bed, double length_m) noexcept;

} // namespace sim
