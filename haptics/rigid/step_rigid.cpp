#include "haptics/rigid/step_rigid.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace haptics {
namespace {

struct Bodies {
    const RigidModel& model;
    const RigidState& state;

    const RigidShape& shape(std::uint32_t body) const noexcept {
        const std::size_t fixed = model.scenery.size();
        return body < fixed ? model.scenery[body].shape : model.tool[body - fixed].shape;
    }
    const RigidPose& pose(std::uint32_t body) const noexcept {
        const std::size_t fixed = model.scenery.size();
        return body < fixed ? model.scenery[body].pose : state.tool[body - fixed];
    }
    std::uint32_t tool(std::uint32_t body) const noexcept {
        const auto fixed = static_cast<std::uint32_t>(model.scenery.size());
        return body < fixed ? kNoTool : body - fixed;
    }
};

// What was known of a pair; pairs come in much the same order in every tick.
PairMemory recall(const KnownPairs& known, std::uint32_t& cursor, std::uint32_t a, std::uint32_t b,
                  const PiecePair& piece) noexcept {
    for (std::uint32_t i = 0; i < known.count; ++i) {
        const std::uint32_t at = (cursor + i) % known.count;
        const KnownPair& k = known.item[at];
        if (k.body_a == a && k.body_b == b && k.piece.a == piece.a && k.piece.b == piece.b) {
            cursor = at + 1;
            return k.memory;
        }
    }
    return {};
}

// Contacts of two bodies: near pieces, their penetration, the patches, few contacts.
void meet(const Bodies& bodies, std::uint32_t a, std::uint32_t b, std::uint32_t& cursor,
          RigidScratch& scratch, RigidTick& out) noexcept {
    const RigidShape& shape_a = bodies.shape(a);
    const RigidShape& shape_b = bodies.shape(b);
    const RigidPose b_in_a = relative_pose(bodies.pose(a), bodies.pose(b));
    const RigidParams& params = bodies.model.params;
    close_pairs(shape_a, shape_b, b_in_a, params.margin_m, scratch.pairs);
    scratch.patches.count = scratch.patches.dropped = 0;
    for (const PiecePair& pair : scratch.pairs) {
        const ConvexHull& piece_a = shape_a.piece[pair.a];
        const ConvexHull& piece_b = shape_b.piece[pair.b];
        KnownPair known{a, b, pair, recall(bodies.state.known, cursor, a, b, pair)};
        const PairContact contact =
            convex_contact(piece_a, piece_b, b_in_a, params.margin_m, known.memory);
        scratch.next.add(known);
        if (!(contact.depth_m > 0.0))
            continue;
        out.deepest_m = std::max(out.deepest_m, contact.scale * contact.depth_m);
        overlap_patches(piece_a, piece_b, bodies.pose(a), b_in_a, contact, scratch.patches);
    }
    cluster_contacts({scratch.patches.begin(), scratch.patches.end()}, params.cluster,
                     scratch.contacts);
    for (const RepresentativeContact& contact : scratch.contacts)
        out.contacts.add({contact, bodies.tool(a), bodies.tool(b)});
    out.dropped += scratch.pairs.dropped + scratch.patches.dropped;
}

void find_contacts(const RigidModel& model, RigidState& state, RigidScratch& scratch,
                   RigidTick& out) noexcept {
    const Bodies bodies{model, state};
    const auto fixed = static_cast<std::uint32_t>(model.scenery.size());
    const auto all = fixed + static_cast<std::uint32_t>(model.tool.size());
    scratch.next.count = scratch.next.dropped = 0;
    std::uint32_t cursor = 0;
    for (std::uint32_t b = fixed; b < all; ++b)
        for (std::uint32_t a = 0; a < b; ++a)
            meet(bodies, a, b, cursor, scratch, out);
    std::copy(scratch.next.begin(), scratch.next.end(), state.known.begin());
    state.known.count = scratch.next.count;
    out.dropped += scratch.next.dropped + out.contacts.dropped;
}

// In the free the tools go with the devices; near something they follow at a speed that cannot pass
// through it.
void follow(const RigidModel& model, std::span<const RigidPose> device, RigidState& state,
            RigidTick& out) noexcept {
    std::array<CoupledTool, kMostRigidTools> tools{};
    const std::size_t n = model.tool.size();
    const bool near = state.known.count > 0;
    for (std::size_t t = 0; t < n; ++t) {
        tools[t] = {.device = device[t], .tool = state.tool[t], .spring = model.spring[t]};
        tools[t].most_step_m = model.params.most_step_m;
        tools[t].most_turn_rad = model.params.most_turn_rad;
        if (!near) {
            const RigidPose& last = state.device[t];
            tools[t].most_step_m += glm::length(device[t].position_m - last.position_m);
            tools[t].most_turn_rad += glm::length(turn_between(last.rotation, device[t].rotation));
        }
        state.device[t] = device[t];
    }
    out.solved = balance({tools.data(), n}, {out.contacts.begin(), out.contacts.end()},
                         model.params.contact_npm);
    for (std::size_t t = 0; t < n; ++t) {
        state.tool[t] = tools[t].tool;
        out.wrench[t] = tools[t].wrench;
        // no more stiffness than the device's damping can hold
        const double share = passivity_share(tools[t].felt, model.device[t]);
        out.passivity_share = std::max(out.passivity_share, share);
        if (share > model.params.passivity_share) {
            out.wrench[t].force_n *= model.params.passivity_share / share;
            out.wrench[t].torque_nm *= model.params.passivity_share / share;
        }
    }
}

void require(bool good, const std::string& what) {
    if (!good)
        throw std::invalid_argument("rigid model: " + what);
}

} // namespace

RigidModel make_rigid_model(std::vector<RigidBody> scenery, std::vector<RigidBody> tool,
                            std::span<const DeviceDamping> device, const RigidParams& params) {
    require(!tool.empty() && tool.size() <= kMostRigidTools, std::to_string(tool.size()) +
                                                                 " tools, must be 1 to " +
                                                                 std::to_string(kMostRigidTools));
    require(device.size() >= tool.size(), "as many devices as tools are needed");
    require(params.contact_npm > 0.0 && params.margin_m > 0.0 && params.passivity_share > 0.0,
            "contact stiffness, margin and passivity share must be above 0");
    RigidModel model;
    for (std::size_t t = 0; t < tool.size(); ++t) {
        require(device[t].force_nspm > 0.0 && device[t].torque_nmsprad > 0.0 &&
                    device[t].tick_s > 0.0,
                "damping and tick of tool " + tool[t].shape.name + " must be above 0");
        model.device[t] = device[t];
        model.spring[t] = safe_spring(device[t], params.passivity_share);
    }
    model.scenery = std::move(scenery);
    model.tool = std::move(tool);
    model.params = params;
    return model;
}

void step_rigid(const RigidModel& model, std::span<const RigidPose> device, RigidState& state,
                RigidScratch& scratch, RigidTick& out) noexcept {
    out = {};
    out.solved = device.size() >= model.tool.size();
    if (!out.solved)
        return;
    if (!state.placed) {
        std::copy_n(device.begin(), model.tool.size(), state.tool.begin());
        std::copy_n(device.begin(), model.tool.size(), state.device.begin());
    }
    state.placed = true;
    find_contacts(model, state, scratch, out);
    follow(model, device, state, out);
}

} // namespace haptics
