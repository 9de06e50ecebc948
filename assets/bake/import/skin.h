// assets/bake/import/skin.h
// The skin of an imported organ: even triangles on the surface given. Called by organ_body.
#pragma once

#include "assets/bake/remesh.h"

namespace bake {

/// Edges of about `skin_m`, half that where it is curved, and finer again where the skin keeps away
/// from the surface given: tips and edges wear off in remeshing. Scans that are much finer are
/// coarsened first. Other sizes are tried if triangles come out flat, or if it keeps away by more
/// than `away_m`; the nearest is taken. Throws ImportRefused if all are flat. `shells`: closed
/// pieces that `given` has.
Surface make_skin(const Surface& given, double skin_m, double away_m, std::size_t shells,
                  const RemeshOptions& keep);

} // namespace bake
