// assets/bake/local_terms.h
// Mesh terms of slender bodies, and of those that hang on little (`mesh_terms = "local"`). Linear
// tetrahedra bend a sheet of one layer five times too stiffly, and the mesh term owes the whole
// difference, metres per newton. But terms act between tool and skin: jaws that lift a flap would
// hold it on a long spring, and the flap would stay where it is. What is no dimple under the kernel
// is left to the body, which is then as stiff as its mesh. Not for every organ: of liver and blocks
// the limit would cut a quarter of all terms, by up to 3.5, and those make two meshes of one liver
// agree. Called by bake.
#pragma once

#include "tissue/mesh/contact_surface.h"

namespace bake {

/// No mesh term above the compliance of a half-space under the same kernel, and what is cut no
/// longer leans. Call after
/// make_mesh_terms.
void keep_terms_local(double poisson, tissue::ContactSurface& surface);

} // namespace bake
