// sim/study/bench_method.h
// The collision and contact methods that the contact bench can measure, by name, each behind the
// same three questions. A new one: its name in the list and its branch in make_bench_method.
// Called by contact_bench; single-threaded.
#pragma once

#include "haptics/collision/index.h"
#include "haptics/contact/proxy_method.h"

#include <functional>
#include <memory>
#include <string>

namespace sim {

/// What acts on the ball. "none": the closest-point query alone. "-shaded": with the vertex normals
/// of the mesh, made anew whenever it moves.
inline constexpr std::array<std::string_view, 6> kContactNames{
    "none", "penalty", "god-object", "virtual-proxy", "virtual-proxy-shaded", "ours"};

struct BenchMethod {
    /// To the mesh as it is now.
    std::function<void(const haptics::MeshView&)> refit;
    /// The nearest skin within a reach (m). May remember where it was last.
    std::function<haptics::SurfaceHit(const haptics::MeshView&, const glm::dvec3&, double)> closest;
    /// A whole contact tick; empty for "none".
    std::function<void(const haptics::MeshView&, const haptics::ProxyInput&, haptics::ProxyState&)>
        step;
    bool point = false; // feels the skin where the ball's centre meets it, whatever the radius
};

/// `method`: one of kCollisionNames; `contact`: one of kContactNames. Throws std::invalid_argument
/// saying what is accepted.
BenchMethod make_bench_method(const std::string& method, const std::string& contact,
                              const haptics::MeshView& mesh);

} // namespace sim
