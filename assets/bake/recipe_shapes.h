// assets/bake/recipe_shapes.h
// The keys of a recipe that describe its shape, kind by kind. Called by recipe.cpp only.
#pragma once

#include "assets/bake/recipe.h"
#include "assets/bake/recipe_table.h"

#include <utility>

namespace bake {

/// What `kind` and the shape's own keys say; throws RecipeError.
std::pair<Kind, AnyShape> read_shape(const Table& top);

/// Three whole numbers from 1 to 100 under `key`.
std::array<int, 3> read_cells(const Table& top, const char* key);

} // namespace bake
