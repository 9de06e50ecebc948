// assets/bake/import/import.h
// The bytes of a surface file in, organs and an honest account out. Called by import_main and by
// tests; opens no file. The same bytes and options give the same organs, bit for bit, unless an
// attempt of TetGen runs into its time limit; only seconds differ.
#pragma once

#include "assets/bake/bake.h"
#include "assets/bake/import/bodies.h"
#include "assets/bake/import/notes.h"
#include "assets/bake/import/soup.h"

#include <cstddef>
#include <optional>
#include <span>

namespace bake {

/// Raise when the same file gives another organ than before.
inline constexpr std::uint64_t kImportVersion = 1;

/// Least dihedral angle that a real-time model gets; below it import tries again, then refuses.
inline constexpr double kLeastDihedralDeg = 8.0;

struct ImportOptions {
    std::string file_name; // its end says the format, its stem names the organ
    Unit unit;
    tissue::Material material; // of tissue; not looked at if rigid
    bool rigid = false;
    bool largest = false;       // only the largest body
    double edge_mm = 0.0;       // 0: from the body, for about 500 nodes
    std::vector<FineSpot> fine; // in millimetres, whatever the unit; half the edge within radius
    double time_limit_s = 60.0; // of each attempt of TetGen
    std::function<void(const std::string&)> tell;
};

/// The same skin on coarser tetrahedra, with rows for quadratic shapes (assets/bake/quadratic.h).
struct QuadraticBody {
    tissue::BakedOrgan organ;
    TetQuality quality;
    double edge_m = 0.0, volume_m3 = 0.0, boundary_distance_m = 0.0;
};

struct ImportedBody {
    tissue::BakedOrgan organ;
    std::optional<QuadraticBody> quadratic; // none if rigid, or for the reason that follows
    std::string no_quadratic;
    Surface given;    // what was to be met: closed and repaired
    Surface boundary; // of the tetrahedra; empty if rigid
    TetQuality quality;
    std::vector<TetAttempt> attempts;
    double edge_m = 0.0, skin_m = 0.0;
    double given_m3 = 0.0, volume_m3 = 0.0;
    double skin_distance_m = 0.0, boundary_distance_m = 0.0; // Hausdorff, from `given`
};

struct Imported {
    Notes notes;
    std::string format;
    std::size_t triangles = 0; // in the file
    std::size_t found = 0;     // bodies in the file, specks too; a cavity is none
    std::vector<ImportedBody> bodies;
    std::vector<Phase> phases;
    double seconds = 0.0;
};

/// Throws ReadError or ImportRefused.
Imported import_surface(std::span<const std::byte> bytes, const ImportOptions& options);

/// Name of the organ: the file's stem in lower case, letters, digits, _ and - only; numbered from 1
/// if there are several.
std::string organ_name(const std::string& file_name, std::size_t body, std::size_t bodies);

/// The report as one JSON object; without times it is the same for the same input.
std::string import_json(const Imported& imported, const ImportOptions& options, bool with_times);

/// The same for people.
std::string import_text(const Imported& imported, const ImportOptions& options);

} // namespace bake
