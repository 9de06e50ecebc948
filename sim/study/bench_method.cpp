#include "sim/study/bench_method.h"

#include "haptics/contact/god_object.h"
#include "haptics/contact/penalty.h"
#include "haptics/contact/safe_proxy.h"
#include "haptics/contact/vertex_normals.h"
#include "haptics/contact/virtual_proxy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>

namespace sim {
namespace {

using haptics::CollisionIndex;
using haptics::MeshView;
using haptics::ProxyInput;
using haptics::ProxyState;

using Step = void (*)(const CollisionIndex&, const MeshView&, const ProxyInput&,
                      ProxyState&) noexcept;

constexpr std::string_view kShaded = "virtual-proxy-shaded";

/// Refits make the normals too, so that their time is told with the refit's.
void shade(BenchMethod& method, Step step, std::shared_ptr<CollisionIndex> index,
           const MeshView& mesh) {
    const auto normal = std::make_shared<std::vector<glm::dvec3>>(mesh.vertex_m.size());
    haptics::angle_weighted_normals(mesh, *normal);
    method.refit = [index, normal](const MeshView& now) {
        haptics::refit(*index, now);
        haptics::angle_weighted_normals(now, *normal);
    };
    method.step = [index, step, normal](const MeshView& now, const ProxyInput& input,
                                        ProxyState& state) {
        ProxyInput shaded = input;
        shaded.vertex_normal = *normal;
        step(*index, now, shaded, state);
    };
}

Step step_of(const std::string& contact) {
    if (contact == "none")
        return nullptr;
    if (contact == "penalty")
        return haptics::step_penalty;
    if (contact == "god-object")
        return haptics::step_god_object;
    if (contact == "virtual-proxy" || contact == kShaded)
        return haptics::step_virtual_proxy;
    if (contact == "ours")
        return haptics::step_safe_proxy;
    throw std::invalid_argument(
        fmt::format("contact method '{}': accepted: {}", contact, fmt::join(kContactNames, ", ")));
}

} // namespace

BenchMethod make_bench_method(const std::string& method, const std::string& contact,
                              const MeshView& mesh) {
    const Step step = step_of(contact);
    const auto index = std::make_shared<CollisionIndex>(haptics::make_index(method, mesh));
    BenchMethod out;
    out.refit = [index](const MeshView& now) { haptics::refit(*index, now); };
    out.closest = [index](const MeshView& now, const glm::dvec3& place_m, double reach_m) {
        return haptics::closest_within(*index, now, place_m, reach_m);
    };
    if (const auto* tree = std::get_if<haptics::WideTree>(index.get()))
        out.closest = [index, tree, ring = std::make_shared<haptics::WideRing>()](
                          const MeshView& now, const glm::dvec3& place_m, double reach_m) {
            return haptics::closest_within(*tree, now, *ring, place_m, reach_m);
        };
    if (step != nullptr)
        out.step = [index, step](const MeshView& now, const ProxyInput& input, ProxyState& state) {
            step(*index, now, input, state);
        };
    if (contact == kShaded)
        shade(out, step, index, mesh);
    out.point = contact == "god-object";
    return out;
}

} // namespace sim
