// assets/bake/bake.h
// Recipe in, baked organ and report out. Called by bake's main and by tests; opens no file. The
// same recipe gives the same organ, bit for bit; only the seconds of the report differ.
#pragma once

#include "assets/bake/quality.h"
#include "assets/bake/recipe.h"
#include "assets/bake/tetrahedralise.h"
#include "tissue/mesh/baked_organ.h"

#include <functional>

namespace bake {

/// What was asked cannot be made; the message says why. Not a mistake in the recipe's text.
struct Refused : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Raise when the same recipe gives another organ than before.
inline constexpr std::uint64_t kBakeVersion = 3;

struct Phase {
    std::string name;
    double seconds = 0.0;
};

struct BakeReport {
    double edge_mm = 0.0; // asked of the tetrahedra; that of recipes with cells says nothing
    TetQuality quality;
    std::vector<TetAttempt> attempts;
    double skin_volume_m3 = 0.0; // 0: the skin is open
    double mesh_volume_m3 = 0.0;
    double skin_to_mesh_m = 0.0, mesh_to_skin_m = 0.0; // sampled Hausdorff distances
    std::vector<Phase> phases;
};

struct Baked {
    tissue::BakedOrgan organ;
    Surface boundary; // of the tetrahedra; empty for a rigid body
    BakeReport report;
};

struct BakeOptions {
    int order = 1;              // of the tetrahedra's shapes; 2: on those of quadratic_recipe()
    double time_limit_s = 60.0; // of each attempt of TetGen
    std::function<void(const std::string&)> tell; // progress, one line each; may be empty
    void (*mesh_term_progress)(double share) = nullptr;
};

/// Throws RecipeError (nothing anchored) or Refused. Skins of both orders are the same.
Baked bake(const Recipe& recipe, const BakeOptions& options);

/// The report as one JSON object.
std::string report_json(const Recipe& recipe, const Baked& baked);

/// Skin and boundary as two objects of one OBJ file, in metres.
std::string obj_text(const Baked& baked);

} // namespace bake
