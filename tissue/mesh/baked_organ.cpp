// The file format of a baked organ, version 5. All little endian, doubles as IEEE 754 bits:
//   magic "TROCORGN", u32 version, then the fields of BakedOrgan in the order of write_fields(),
//   each list as u64 count and its items, then u64 FNV-1a of everything before it.
// Version 4 has no leaning mesh terms, which are then none, version 3 no line of a rod, version 2
// no order, which is 1. One list of fields serves both
// directions and all versions, so that they cannot drift apart.
#include "tissue/mesh/baked_organ.h"

#include "tissue/mesh/quadratic_mesh.h"

#include <bit>
#include <cmath>
#include <concepts>
#include <cstring>
#include <stdexcept>

namespace tissue {
namespace {

constexpr std::string_view kMagic = "TROCORGN";
constexpr std::uint32_t kVersion = 5, kOldestVersion = 2, kOrderSince = 3, kLineSince = 4,
                        kLeanSince = 5;
constexpr std::size_t kHashSize = 8;
constexpr std::size_t kBedSampleSize = 4 + 5 * 8;

[[noreturn]] void fail(const std::string& what, std::size_t byte) {
    throw std::invalid_argument("baked organ, byte " + std::to_string(byte) + ": " + what);
}

std::uint64_t fnv1a(std::span<const std::byte> bytes) {
    std::uint64_t hash = 0xCBF29CE484222325ULL;
    for (const std::byte b : bytes) {
        hash = (hash ^ static_cast<std::uint64_t>(b)) * 0x100000001B3ULL;
    }
    return hash;
}

class Writer {
  public:
    std::vector<std::byte> bytes;

    template <std::unsigned_integral T> void integer(T value) {
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            bytes.push_back(static_cast<std::byte>(value >> (8 * i) & 0xFF));
        }
    }
    void item(std::uint8_t v) { integer(v); }
    void item(std::uint32_t v) { integer(v); }
    void item(std::uint64_t v) { integer(v); }
    void item(std::int32_t v) { integer(std::bit_cast<std::uint32_t>(v)); }
    void item(double v) { integer(std::bit_cast<std::uint64_t>(v)); }
    void item(bool v) { integer(static_cast<std::uint8_t>(v ? 1 : 0)); }
    void item(const glm::dvec3& v) { item(v.x), item(v.y), item(v.z); }
    template <class T, std::size_t N> void item(const std::array<T, N>& a) {
        for (const auto& v : a) {
            item(v);
        }
    }
    void item(const BedSample& b) { item(b.tet), item(b.weight), item(b.stiffness_m); }
    template <class T> void list(const std::vector<T>& v) {
        integer(static_cast<std::uint64_t>(v.size()));
        for (const auto& one : v) {
            item(one);
        }
    }
    void list(const std::string& s) {
        integer(static_cast<std::uint64_t>(s.size()));
        for (const char c : s) {
            integer(static_cast<std::uint8_t>(c));
        }
    }
};

class Reader {
  public:
    Reader(std::span<const std::byte> bytes, std::size_t at) : bytes_(bytes), at_(at) {}

    [[nodiscard]] std::size_t at() const { return at_; }

    template <std::unsigned_integral T> T integer() {
        need(sizeof(T));
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            value |= static_cast<std::uint64_t>(bytes_[at_ + i]) << (8 * i);
        }
        at_ += sizeof(T);
        return static_cast<T>(value);
    }
    void item(std::uint8_t& v) { v = integer<std::uint8_t>(); }
    void item(std::uint32_t& v) { v = integer<std::uint32_t>(); }
    void item(std::uint64_t& v) { v = integer<std::uint64_t>(); }
    void item(std::int32_t& v) { v = std::bit_cast<std::int32_t>(integer<std::uint32_t>()); }
    void item(double& v) {
        const std::size_t start = at_;
        v = std::bit_cast<double>(integer<std::uint64_t>());
        if (!std::isfinite(v)) {
            fail("not a finite number", start);
        }
    }
    void item(bool& v) {
        const auto byte = integer<std::uint8_t>();
        if (byte > 1) {
            fail("neither 0 nor 1", at_ - 1);
        }
        v = byte == 1;
    }
    void item(glm::dvec3& v) { item(v.x), item(v.y), item(v.z); }
    template <class T, std::size_t N> void item(std::array<T, N>& a) {
        for (auto& v : a) {
            item(v);
        }
    }
    void item(BedSample& b) { item(b.tet), item(b.weight), item(b.stiffness_m); }
    template <class T> void list(std::vector<T>& v) {
        v.resize(count(std::same_as<T, BedSample> ? kBedSampleSize : sizeof(T)));
        for (auto& one : v) {
            item(one);
        }
    }
    void list(std::string& s) {
        s.resize(count(1));
        for (char& c : s) {
            c = static_cast<char>(integer<std::uint8_t>());
        }
    }

  private:
    void need(std::size_t size) const {
        if (bytes_.size() - at_ < size) {
            fail("the file ends here, " + std::to_string(size) + " bytes expected", at_);
        }
    }
    /// A count that the bytes left can hold, so that a lie cannot ask for all memory.
    std::size_t count(std::size_t item_size) {
        const std::size_t start = at_;
        const auto n = integer<std::uint64_t>();
        if (n > (bytes_.size() - at_) / item_size) {
            fail("a list of " + std::to_string(n) + " items does not fit into the file", start);
        }
        return static_cast<std::size_t>(n);
    }

    std::span<const std::byte> bytes_;
    std::size_t at_;
};

/// `start` (may be null) receives where each list begins, for messages.
struct ListStarts {
    std::size_t order = 0, anchored = 0, bed = 0, tets = 0, triangles = 0, neighbours = 0,
                row_start = 0, row_node = 0, frame_node = 0, sizes = 0, line = 0;
};

/// The fields as they follow in the file. `Organ` is const for a Writer.
template <class Stream, class Organ>
ListStarts fields(Stream& s, Organ& o, std::uint32_t version = kVersion) {
    ListStarts at;
    const auto here = [&] {
        if constexpr (std::same_as<Stream, Reader>) {
            return s.at();
        } else {
            return s.bytes.size();
        }
    };
    s.list(o.name);
    s.item(o.rigid);
    at.order = here();
    if (version >= kOrderSince) {
        s.item(o.order);
    }
    s.item(o.tip_radius_max_m);
    s.item(o.recipe_hash);
    s.item(o.material.young_pa);
    s.item(o.material.poisson);
    s.item(o.material.density_kgpm3);
    s.item(o.material.damping_mass_1ps);
    s.item(o.material.damping_stiffness_s);
    s.item(o.material.friction);
    s.list(o.material.source);
    s.list(o.mesh.rest_m);
    at.tets = here();
    s.list(o.mesh.tets);
    at.anchored = here();
    s.list(o.anchored);
    at.bed = here();
    s.list(o.bed);
    s.list(o.surface.rest_m);
    at.triangles = here();
    s.list(o.surface.triangles);
    at.neighbours = here();
    s.list(o.surface.neighbours);
    at.row_start = here();
    s.list(o.surface.row_start);
    at.row_node = here();
    s.list(o.surface.row_node);
    s.list(o.surface.row_weight);
    s.list(o.surface.offset_m);
    at.frame_node = here();
    s.list(o.surface.frame_node);
    at.sizes = here();
    s.list(o.surface.footprint_radius_m);
    s.list(o.surface.thickness_m);
    s.list(o.surface.mesh_term_n_m);
    s.list(o.surface.mesh_term_t_m);
    if (version >= kLeanSince) {
        s.list(o.surface.mesh_lean_m);
    } else if constexpr (std::same_as<Stream, Reader>) {
        o.surface.mesh_lean_m.assign(o.surface.mesh_term_t_m.size(), {});
    }
    at.line = here();
    if (version >= kLineSince) {
        s.list(o.line.node_m);
        s.list(o.line.radius_m);
        s.list(o.line.held);
        s.list(o.line.hold_m);
        s.item(o.line.bed_pa);
    }
    return at;
}

template <class Lists, class Limit>
void check_indices(const Lists& lists, Limit low, Limit high, const char* what, std::size_t start) {
    std::size_t byte = start + 8; // after the count
    for (const auto& list : lists) {
        for (const auto index : list) {
            if (index < low || index >= high) {
                fail(std::string(what) + " " + std::to_string(index) + " is out of range", byte);
            }
            byte += sizeof(index);
        }
    }
}

void check_size(std::size_t size, std::size_t expected, const char* what, std::size_t byte) {
    if (size != expected) {
        fail(std::string(what) + ": " + std::to_string(size) + " items, " +
                 std::to_string(expected) + " expected",
             byte);
    }
}

void check_rows(const ContactSurface& s, std::uint32_t nodes, const ListStarts& at) {
    for (std::size_t v = 0; v < s.row_start.size(); ++v) {
        const bool good = v == 0 ? s.row_start[v] == 0 : s.row_start[v] >= s.row_start[v - 1];
        if (!good || s.row_start[v] > s.row_node.size()) {
            fail("rows out of order", at.row_start + 8 + 4 * v);
        }
    }
    if (!s.row_start.empty()) {
        check_size(s.row_node.size(), s.row_start.back(), "nodes of the rows", at.row_node);
    }
    check_indices(std::span(&s.row_node, 1), 0U, nodes, "node of a row", at.row_node);
}

void check_line(const BakedOrgan& o, const ListStarts& at) {
    const RodLine& line = o.line;
    if (!is_rod(o) && line.radius_m.empty() && line.held.empty() && line.hold_m.empty()) {
        return;
    }
    if (o.rigid || o.order != 1 || !o.mesh.tets.empty() || !o.bed.empty()) {
        fail("the line of a rod in a body that is rigid, quadratic or of tetrahedra", at.line);
    }
    check_size(line.radius_m.size(), line.node_m.size(), "radii of the line", at.line);
    check_size(line.held.size(), line.node_m.size(), "held nodes of the line", at.line);
    check_size(line.hold_m.size(), line.node_m.size(), "springs of the line", at.line);
    check_indices(std::span(&line.held, 1), std::uint8_t{0}, std::uint8_t{2},
                  "held node of the line", at.line);
    try { // radii, springs, and a way that can be stepped
        make_rod(line, o.material, glm::dvec3{0.0});
    } catch (const std::invalid_argument& e) {
        fail(std::string("the line of a rod: ") + e.what(), at.line);
    }
}

/// Everything that code reading the organ indexes with or relies on.
void check_organ(const BakedOrgan& o, const ListStarts& at) {
    const auto nodes = static_cast<std::uint32_t>(o.mesh.rest_m.size());
    const ContactSurface& s = o.surface;
    if (o.order != 1 && (o.order != 2 || o.rigid)) {
        fail("order " + std::to_string(o.order) + " of " + (o.rigid ? "a rigid" : "a soft") +
                 " body; known are 1, and 2 of soft ones",
             at.order);
    }
    const auto vertices = static_cast<std::uint32_t>(s.rest_m.size());
    check_indices(o.mesh.tets, 0U, nodes, "node of a tetrahedron", at.tets);
    check_size(o.anchored.size(), nodes, "anchored", at.anchored);
    check_indices(std::span(&o.anchored, 1), std::uint8_t{0}, std::uint8_t{2}, "anchored",
                  at.anchored);
    for (std::size_t i = 0; i < o.bed.size(); ++i) {
        if (o.bed[i].tet >= o.mesh.tets.size() || !(o.bed[i].stiffness_m >= 0.0))
            fail("tetrahedron of the bed " + std::to_string(o.bed[i].tet) +
                     " is out of range, or its stiffness negative",
                 at.bed + 8 + i * kBedSampleSize);
    }
    check_indices(s.triangles, 0U, vertices, "vertex of a triangle", at.triangles);
    check_size(s.neighbours.size(), s.triangles.size(), "neighbours", at.neighbours);
    check_indices(s.neighbours, -1, static_cast<std::int32_t>(s.triangles.size()),
                  "neighbouring triangle", at.neighbours);

    check_line(o, at);
    const bool plain = o.rigid || is_rod(o); // a skin without rows
    const std::size_t rows = plain ? 0 : vertices;
    if (plain) {
        check_size(nodes, 0, o.rigid ? "nodes of a rigid body" : "nodes of a rod", at.tets);
    }
    check_size(s.row_start.size(), plain ? 0 : rows + 1, "starts of the rows", at.row_start);
    check_size(s.row_weight.size(), s.row_node.size(), "weights of the rows", at.row_node);
    check_size(s.offset_m.size(), rows, "offsets", at.row_node);
    check_size(s.frame_node.size(), rows, "frames", at.frame_node);
    check_size(s.footprint_radius_m.size(), rows, "footprint radii", at.sizes);
    check_size(s.thickness_m.size(), rows, "thicknesses", at.sizes);
    check_size(s.mesh_term_n_m.size(), rows, "normal mesh terms", at.sizes);
    check_size(s.mesh_term_t_m.size(), rows, "tangential mesh terms", at.sizes);
    check_size(s.mesh_lean_m.size(), rows, "leaning mesh terms", at.sizes);
    check_indices(s.frame_node, 0U, nodes, "node of a frame", at.frame_node);
    check_rows(s, o.order == 1 ? nodes : static_cast<std::uint32_t>(quadratic_node_count(o.mesh)),
               at);
}

} // namespace

std::vector<std::byte> write_organ(const BakedOrgan& organ) {
    Writer writer;
    for (const char c : kMagic) {
        writer.integer(static_cast<std::uint8_t>(c));
    }
    writer.integer(kVersion);
    fields(writer, organ);
    writer.integer(fnv1a(writer.bytes));
    return std::move(writer.bytes);
}

BakedOrgan read_organ(std::span<const std::byte> bytes) {
    Reader head(bytes, 0);
    for (const char c : kMagic) {
        if (head.integer<std::uint8_t>() != static_cast<std::uint8_t>(c)) {
            fail("not a baked organ", head.at() - 1);
        }
    }
    const auto version = head.integer<std::uint32_t>();
    if (version < kOldestVersion || version > kVersion) {
        fail("version " + std::to_string(version) + ", this build reads versions " +
                 std::to_string(kOldestVersion) + " to " + std::to_string(kVersion),
             kMagic.size());
    }
    if (bytes.size() - head.at() < kHashSize) {
        fail("the file ends here, a checksum expected", bytes.size());
    }
    const std::size_t end = bytes.size() - kHashSize;
    if (Reader(bytes, end).integer<std::uint64_t>() != fnv1a(bytes.first(end))) {
        fail("wrong checksum: the file is damaged or cut short", end);
    }

    Reader body(bytes.first(end), head.at());
    BakedOrgan organ;
    const ListStarts at = fields(body, organ, version);
    if (body.at() != end) {
        fail("more bytes than the organ has", body.at());
    }
    check_organ(organ, at);
    return organ;
}

} // namespace tissue
