// tissue/mesh/baked_organ.h
// What assets/bake writes and a scene loads: one organ, ready to simulate. Bytes in, bytes out;
// files are opened by sim/ and by bake.
#pragma once

#include "tissue/material/elastic.h"
#include "tissue/mesh/contact_surface.h"
#include "tissue/mesh/elastic_bed.h"
#include "tissue/rod/rod_line.h"

#include <cstddef>
#include <string>

namespace tissue {

/// With order 2 the rows of the surface name nodes of quadratic_mesh(mesh), its frames corners; a
/// node on an edge is anchored where both ends are, as linear_statics.h has it; no mesh terms.
struct BakedOrgan {
    std::string name;
    bool rigid = false;                 // scenery: a surface without tetrahedra
    int order = 1;                      // of the shapes the rows are for; 2: see below
    TetMesh mesh;                       // empty if rigid, or a rod
    std::vector<std::uint8_t> anchored; // per node of `mesh`, 1 = fixed in place
    std::vector<BedSample> bed;         // what holds it elastically, by tet
    RodLine line;                       // of a tube that is a rod; else empty
    ContactSurface surface;             // rigid, or a rod: rows and terms empty
    Material material;                  // default; a scene may name another
    double tip_radius_max_m = 3e-3;     // kernels were made for tips up to this
    std::uint64_t recipe_hash = 0;      // of the recipe and the baking code's version
};

/// A tube that is a rod, and not tetrahedra.
inline bool is_rod(const BakedOrgan& organ) noexcept {
    return !organ.line.node_m.empty();
}

/// Little endian, versioned, with a checksum at the end; the same organ gives the same bytes. Reads
/// files of the two versions before, too: they have no rods, the older is all of order 1.
std::vector<std::byte> write_organ(const BakedOrgan& organ);

/// Throws std::invalid_argument saying what is wrong and at which byte: truncated, wrong magic,
/// other version, checksum, index out of range, non-finite number. Safe on hostile bytes.
BakedOrgan read_organ(std::span<const std::byte> bytes);

} // namespace tissue
