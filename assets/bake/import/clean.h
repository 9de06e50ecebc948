// assets/bake/import/clean.h
// Soup to closed, oriented, manifold pieces, with every repair said; what cannot be made so is left
// for resample, or refused with its place. Called by import.
#pragma once

#include "assets/bake/import/notes.h"
#include "assets/bake/import/soup.h"
#include "assets/bake/surface.h"

namespace bake {

struct Pieces {
    std::vector<Surface> closed; // manifold and consistently oriented, perhaps inside out
    Surface broken;              // all that is still open, together; may be empty
};

/// Throws ImportRefused: not a plausible size, no area, one-sided, a hole too large to fill.
Pieces clean(const Soup& soup, Notes& notes);

} // namespace bake
