// assets/bake/import/read_surface.h
// Readers of surface files: bytes in, soup out; one format per .cpp. Called by import and by the
// fuzzers. They open no file, and hostile bytes cost them time and memory in proportion to the
// number of bytes, no more: a count in a header is held against the bytes that are there before
// anything is allocated for it.
//
// Why not OpenMesh's readers: they drop triangles that are not manifold without saying so or
// where, believe counts in headers, and report a bad file without line or byte. What is wrong with
// a surface is this program's business, so it must see all of it.
//
// All throw ReadError, naming line or byte. Polygons are cut into triangles.
#pragma once

#include "assets/bake/import/soup.h"

#include <cstddef>
#include <span>

namespace bake {

/// More than any organ needs; more would take gigabytes and minutes.
inline constexpr std::size_t kMaxTriangles = 12'000'000;

/// Binary if the size is exactly what the count in a binary header asks for, else text if it begins
/// with "solid". Normals are not looked at.
Soup read_stl(std::span<const std::byte> bytes);

/// v and f lines (also negative indices, and texture and normal indices, which are ignored); other
/// lines are skipped.
Soup read_obj(std::span<const std::byte> bytes);

/// Text, little and big endian; elements vertex (x, y, z) and face (vertex_indices or
/// vertex_index); other elements and properties are skipped.
Soup read_ply(std::span<const std::byte> bytes);

/// Text with three coordinates, also [C][N][ST]OFF; no binary and no homogeneous OFF.
Soup read_off(std::span<const std::byte> bytes);

/// By the end of the file's name: .stl .obj .ply .off, in any case of letters.
Soup read_surface(std::span<const std::byte> bytes, const std::string& file_name);

/// Appends the triangles of one polygon (ears cut off in its mean plane up to 32 corners, a fan
/// beyond); fewer than three corners give none. Shared by the readers; corners must be in range.
void add_polygon(std::span<const std::uint32_t> corners, Soup& soup);

/// Throws ReadError if the soup has more triangles than kMaxTriangles, or none.
void check_count(const Soup& soup);

} // namespace bake
