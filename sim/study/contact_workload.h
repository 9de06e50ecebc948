// sim/study/contact_workload.h
// The work that contact is measured on: an organ and a thin two-sided sheet at any number of
// triangles, a tip's path over them at 1 kHz, and their breathing at 60 Hz. Shared by trocar's
// bench and by the peers' programs, so that all do the same work. Nothing here asks a collision
// method anything: on which side of the skin a place is follows from how the mesh was made, which
// is what makes it a judge. Pure and seeded: the same arguments give the same bits. Not for 1 kHz.
// Metres, seconds, world frame.
#pragma once

#include "haptics/collision/mesh_view.h"
#include "sim/study/contact_shape.h"
#include "sim/study/geodesic.h"

#include <optional>
#include <string>

namespace sim {

inline constexpr int kTickHz = 1000;
inline constexpr int kMeshHz = 60;        // how often the mesh moves
inline constexpr double kFineNoise = 0.1; // of the mean edge length, at each vertex, up and down

struct ContactWorkload {
    std::string name; // "organ:10k"
    std::uint64_t seed = 0;
    int cells = 0; // along an edge of the icosahedron, or of the sheet
    Ripples ripples;
    std::optional<Geodesic> organ; // none: the sheet
    std::vector<glm::dvec3> rest_m;
    std::vector<haptics::Corners> triangle; // closed, counter-clockwise from outside
};

/// "organ:COUNT" or "sheet:COUNT", COUNT such as 980, 10k, 1M: as near to that many triangles as
/// 20 n^2 (organ) or 4 n^2 + 8 n (sheet) gets. Throws std::invalid_argument saying what is
/// accepted.
ContactWorkload make_contact_workload(const std::string& name, std::uint64_t seed);
/// Whether a name is meant for make_contact_workload.
bool is_contact_workload(const std::string& name);

// --- breathing

enum class Wave { radial, travelling }; // all in step; or a wave of 60 mm along x
/// "radial", "travelling"; throws std::invalid_argument.
Wave wave_of(const std::string& name);

/// Sines of 1 Hz: the organ's vertices along their directions from the centre, the sheet's along
/// its mean normal, z.
struct Breathing {
    double amplitude_m = 0.0;
    Wave wave = Wave::radial;
};

/// The mesh in one tick; made once, then led from tick to tick.
struct MovingSkin {
    std::vector<glm::dvec3> now_m,
        before_m;       // before_m: at the frame before, if it is not the first
    bool moved = false; // in this tick
    /// To ask in this tick; `before_m` only in the tick in which the mesh moved.
    haptics::MeshView view(const ContactWorkload& work) const noexcept;
};

/// Where the mesh is in a tick: that of the last of the 60 frames per second. `moved` when the tick
/// is the first of a frame and the mesh breathes. Ticks in order, from 0.
void follow(const ContactWorkload& work, const Breathing& breathing, int tick, MovingSkin& skin);

// --- where a place is

/// 1: outside of the organ, above the sheet; 0: within; -1: below the sheet (never of an organ).
/// Judged against the mesh itself: the organ's where the ray from the centre through the place
/// meets it, the sheet's where the vertical through the place does (beside the sheet: at its rim).
/// Exact up to rounding: breathing moves vertices along those rays and verticals only.
int side_of(const ContactWorkload& work, std::span<const glm::dvec3> vertex_m,
            const glm::dvec3& place_m) noexcept;

// --- the path

/// Where the device commands the centre of a ball, one place per tick: a Lissajous figure over the
/// resting smooth skin, up to 100 mm/s fast, from 1 mm off to 4 mm deep with a trembling of 0.2 mm
/// at 8 Hz in it, and within 0.15 s of every even second, the first included, a hop of 20 mm away:
/// it begins free. Depth 0: the ball just touches. Throws std::invalid_argument unless radius >= 0
/// and 0 < seconds <= 3600.
std::vector<glm::dvec3> contact_path(const ContactWorkload& work, double seconds,
                                     std::uint64_t seed, double radius_m);

} // namespace sim
