// assets/bake/anchors.h
// Which part of an organ is held, from the recipe's spheres and boxes. Called by bake.
#pragma once

#include "assets/bake/recipe.h"
#include "tissue/mesh/baked_organ.h"

namespace bake {

/// Fills organ.anchored and organ.bed for organ.mesh. With a hold length the anchors are an
/// elastic bed, so that they do not hang on which nodes happen to lie in them; without, the nodes
/// in them are fixed, which suits blocks whose faces are the anchors.
/// Of a rod, the springs or fixed nodes of its line, and the bed around it.
/// Throws RecipeError if nothing, or too little, is held.
void make_anchors(const Recipe& recipe, tissue::BakedOrgan& organ);

} // namespace bake
