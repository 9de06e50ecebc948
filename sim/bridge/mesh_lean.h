// sim/bridge/mesh_lean.h
// The part of the mesh term that is a tensor (tissue/response/mesh_term.h): what linear tetrahedra
// owe where an end bends is along the bend, which leans against the skin. It acts between tool and
// skin as the local law does, but couples its directions, so it is added to a tool's own
// compliance, in both loops. Used by the tissue loop.
//   law + lean >= 5 mm/N in every direction of the skin at rest, for every force in the law's
//   table; where the law alone is stiffer than that, nothing leans
#pragma once

#include "sim/bridge/body.h"

#include <glm/mat3x3.hpp>

namespace sim {

/// For the skin at rest, by vertex, m/N; call after the law is there. Empty where nothing leans.
/// Where the law is stiffer in some direction than the mesh term is soft, as much of it as the
/// bound above lets be: the law's slope falls as a tip sinks in, and the tensor's does not.
std::vector<tissue::SymmetricTensor> rest_lean(const Body& body);

/// How a triangle of the skin has turned since rest. Real-time safe, as all below.
glm::dmat3 turn_on(const Body& body, int triangle) noexcept;

/// R S R^T.
tissue::SymmetricTensor turned(const tissue::SymmetricTensor& s, const glm::dmat3& by) noexcept;

/// What leans where `at` lies, m/N, world axes; zero if rigid.
glm::dmat3 lean_on(const Body& body, const haptics::SurfacePoint& at) noexcept;

} // namespace sim
