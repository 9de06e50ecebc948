// assets/bake/import/picture.h
// What was imported, for looking at: the skin with what holds it, and the tetrahedra cut open and
// coloured by their smallest dihedral angle. Called by import_main.
#pragma once

#include "assets/bake/import/import.h"

namespace bake {

/// A PNG of 1600 x 800 pixels; the same import gives the same bytes.
std::string picture_png(const Imported& imported);

} // namespace bake
