// assets/bake/recipe.h
// What to bake, as a TOML file says it. Called by bake's main and by tests; text in, struct out.
#pragma once

#include "assets/bake/fine_spot.h"
#include "assets/bake/shape.h"
#include "assets/bake/shape_ground.h"
#include "assets/bake/shape_sheet.h"
#include "assets/bake/shape_tube.h"
#include "tissue/material/elastic.h"

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

namespace bake {

/// Bad input: the message names file, line, key and value, and what would be accepted.
struct RecipeError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What lies in any of these is held in place: see hold_length_mm.
struct AnchorSphere {
    glm::dvec3 centre_mm{0.0};
    double radius_mm = 0.0;
};
struct AnchorBox {
    glm::dvec3 low_mm{0.0}, high_mm{0.0};
};

/// Box [0, size] for tests on a block of known answers.
struct BoxShape {
    glm::dvec3 size_mm{0.0};
    std::optional<std::array<int, 3>> cells; // regular cells instead of TetGen
    bool skin_on_top_only = true;
};

enum class Kind { liver, wall, box, ground, sheet, tube };
/// Scenery: a skin without tetrahedra.
constexpr bool is_rigid(Kind kind) {
    return kind == Kind::wall || kind == Kind::ground;
}
/// Bends as a whole when it is pressed; its mesh terms are local, whatever the recipe says.
constexpr bool is_slender(Kind kind) {
    return kind == Kind::sheet || kind == Kind::tube;
}
using AnyShape = std::variant<LobedShape, VaultShape, BoxShape, GroundShape, SheetShape, TubeShape>;

struct Recipe {
    std::string name;
    Kind kind = Kind::liver;
    double edge_mm = 13.0;       // of the tetrahedra
    double radii_per_edge = 1.8; // edges where the body is strongly curved; no key of its own
    double skin_mm = 4.0;        // of the surface that is touched and drawn
    double tip_radius_max_mm = 3.0;
    double quality_ratio = 1.2;         // TetGen: circumradius over shortest edge
    double quality_dihedral_deg = 15.0; // TetGen: smallest dihedral angle
    AnyShape shape;
    std::vector<AnchorSphere> anchor_spheres;
    std::vector<AnchorBox> anchor_boxes;
    bool rod = false;     // a tube that is one, and not tetrahedra
    double bed_kpa = 0.0; // around all of a rod: what tissue there resists, N/m per m, in kPa
    double hold_length_mm = 0.0; // L of the elastic bed in the anchors; 0: their nodes are fixed
    std::optional<double> quadratic_edge_mm; // of the tetrahedra if their shapes are quadratic
    std::optional<std::array<int, 3>> quadratic_cells; // the same of boxes and sheets with cells
    bool local_terms = false; // mesh terms without what is a swing of the whole body
    std::vector<FineSpot> fine;
    tissue::Material material;
    std::uint64_t text_hash = 0; // FNV-1a of the text
};

/// Throws RecipeError.
Recipe parse_recipe(const std::string& text, const std::string& file_name);

/// Table NAME of a text of materials (organs/materials.toml); throws RecipeError, with the names
/// that are there if NAME is not.
tissue::Material find_material(const std::string& text, const std::string& file_name,
                               const std::string& name);

} // namespace bake
