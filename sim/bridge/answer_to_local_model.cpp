#include "sim/bridge/answer_to_local_model.h"

#include "haptics/contact/surface_walk.h"
#include "sim/bridge/mesh_lean.h"
#include "tissue/response/mode_shapes.h"
#include "tissue/response/rod_basis.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

namespace sim {
namespace {

struct Tangents {
    glm::dvec3 first, second;
};

// Any two directions across n, chosen from n alone.
Tangents tangents_of(const glm::dvec3& n) noexcept {
    const glm::dvec3 axis = std::abs(n.x) < 0.6 ? glm::dvec3{1, 0, 0} : glm::dvec3{0, 1, 0};
    const glm::dvec3 first = glm::normalize(glm::cross(n, axis));
    return {first, glm::cross(n, first)};
}

double arm_of_star_m(const Body& body, int triangle) noexcept {
    const tissue::ContactSurface& skin = body.organ->surface;
    return skin.footprint_radius_m[skin.triangles[triangle][0]] / 3.0;
}

// The star: where a contact that jaws do not hold may have slid to when the answer is used. Its arm
// is a third of the kernel's radius, half the nodal size; up to three quarters of that size serve.
tissue::BasisContact basis_contact(const Body& body, const FemContact& contact,
                                   bool held) noexcept {
    const Tangents t = tangents_of(contact.normal);
    tissue::BasisContact out{.centre = tissue_point(contact.at),
                             .star = {},
                             .normal = contact.normal,
                             .tangent1 = t.first,
                             .tangent2 = t.second,
                             .held = held};
    if (held)
        return out;
    const double arm_m = arm_of_star_m(body, contact.at.triangle);
    const std::array<glm::dvec3, 4> arms{arm_m * t.first, -arm_m * t.first, arm_m * t.second,
                                         -arm_m * t.second};
    for (int k = 0; k < 4; ++k) {
        out.star[k] = tissue_point(haptics::walk(BodySurface{body}, contact.at, arms[k]).point);
    }
    return out;
}

glm::dvec3 rest_place(const Body& body, const tissue::ContactPoint& at) noexcept {
    const tissue::ContactSurface& skin = body.organ->surface;
    const tissue::Triangle& c = skin.triangles[at.triangle];
    return at.weight.x * skin.rest_m[c[0]] + at.weight.y * skin.rest_m[c[1]] +
           at.weight.z * skin.rest_m[c[2]];
}

// How far a body may move from where the columns of its modes were solved for, while their contact
// stays: what solves cost is a multiple of the step, and K in the space is that of every step. Less
// for tets that are linear: with 5 mm a held point's answer would be off by 1 %.
double basis_drift_m(tissue::Tier tier) noexcept {
    return tier == tissue::Tier::quadratic ? 5e-3 : 1e-3;
}

// Columns of a factor that is still there are what solving anew would give.
bool of_this_factor(const SoftBody& soft, const BasisPlace& place) noexcept {
    return tissue::tier_of(soft.solid) != tissue::Tier::quadratic &&
           place.of == soft.linearisations;
}

// How much the columns of a contact are worn: 1 is where it has left the middle of its star, or
// the body has drifted so far. None: infinitely.
double wear(const Body& body, const tissue::BasisContact& contact) noexcept {
    constexpr double kMiddle = 0.4; // of an arm
    const SoftBody& soft = *body.soft;
    const BasisPlace& place = soft.basis_place[contact.slot];
    if (!place.known || place.held != contact.held)
        return std::numeric_limits<double>::infinity();
    const double middle_m =
        kMiddle * arm_of_star_m(body, static_cast<int>(contact.centre.triangle));
    const double slid = glm::distance(rest_place(body, contact.centre), place.rest_m) / middle_m;
    const double drifted =
        (soft.moved_m - place.moved_m) / basis_drift_m(tissue::tier_of(soft.solid));
    return of_this_factor(soft, place) ? slid : std::max(slid, drifted);
}

// Which columns to solve for: one contact's in a step, so that steps are alike, or those that
// cannot wait, three quarters of an arm away. Those of three arms away are of no use. False: all
// are kept.
bool choose_columns(const Body& body, std::span<tissue::BasisContact> contacts) noexcept {
    constexpr double kWorn = 1.0, kWornOut = 1.875, kElsewhere = 7.5;
    tissue::BasisContact* worst = nullptr;
    double most = kWorn;
    bool any = false;
    for (tissue::BasisContact& contact : contacts) {
        const double worn = wear(body, contact);
        contact.kept = tissue::KeptColumns::all;
        if (worn >= kElsewhere)
            contact.kept = tissue::KeptColumns::none;
        else if (worn >= kWornOut)
            contact.kept = tissue::KeptColumns::about;
        any |= contact.kept != tissue::KeptColumns::all;
        if (contact.kept == tissue::KeptColumns::all && worn >= most) {
            most = worn;
            worst = &contact;
        }
    }
    if (!any && worst)
        worst->kept = tissue::KeptColumns::about;
    const SoftBody& soft = *body.soft;
    for (tissue::BasisContact& contact : contacts) {
        if (contact.kept == tissue::KeptColumns::all &&
            !of_this_factor(soft, soft.basis_place[contact.slot]))
            contact.kept = tissue::KeptColumns::space;
    }
    return any || worst;
}

// Forgets tools that have gone. True if there were any.
bool forget_gone(SoftBody& soft, std::span<const tissue::BasisContact> contacts) noexcept {
    bool gone = false;
    for (int slot = 0; slot < kTools; ++slot) {
        const bool here = std::any_of(contacts.begin(), contacts.end(),
                                      [&](const auto& c) { return c.slot == slot; });
        if (!here)
            gone |= std::exchange(soft.basis_place[slot].known, false);
    }
    return gone;
}

void compute_basis(Body& body, std::span<tissue::BasisContact> contacts) noexcept {
    SoftBody& soft = *body.soft;
    const bool gone = forget_gone(soft, contacts);
    const bool there = !choose_columns(body, contacts) && !gone && soft.basis.modes > 0;
    if (there && soft.basis_of == soft.linearisations) {
        std::visit(
            [&](auto& s) { tissue::refresh_contact_basis(s.model, s.state, s.system, soft.basis); },
            soft.solid);
        return;
    }
    auto* quadratic = std::get_if<tissue::QuadraticSolid>(&soft.solid);
    if (quadratic && there) {
        tissue::follow_contact_basis(quadratic->model, quadratic->state, quadratic->system,
                                     soft.basis);
    } else {
        std::visit(
            [&](auto& s) {
                tissue::compute_contact_basis(s.model, body.organ->surface, s.state, s.system,
                                              contacts, soft.basis);
            },
            soft.solid);
        for (const tissue::BasisContact& contact : contacts) {
            if (!tissue::serve(contact.kept))
                soft.basis_place[contact.slot] = {true, contact.held,
                                                  rest_place(body, contact.centre), soft.moved_m,
                                                  soft.linearisations};
        }
    }
    tissue::turn_shapes(soft.basis, tissue::unknowns(soft.solid), soft.shape_by_unknown);
    ++soft.basis_count;
    soft.basis_of = soft.linearisations;
}

// Modes of one body into the common list. Returns where they begin.
int add_modes(Body& body, std::span<tissue::BasisContact> contacts,
              haptics::LocalModels& local) noexcept {
    SoftBody& soft = *body.soft;
    compute_basis(body, contacts);
    const int first = local.modes;
    const int count = std::min(soft.basis.modes, haptics::kMaxModes - first);
    for (int m = 0; m < count; ++m) {
        local.lambda[first + m] = soft.basis.lambda[m];
        local.damping[first + m] = body.material.damping_mass_1ps +
                                   body.material.damping_stiffness_s * soft.basis.lambda[m];
        local.residual[first + m] = soft.basis.residual[m];
        local.rate[first + m] = soft.basis.rate[m];
    }
    local.modes = first + count;
    return first;
}

void fill_shapes(const Body& body, const tissue::Patch& patch, int body_index, ShownShapes& shown,
                 haptics::ToolPatch& out) noexcept {
    const SoftBody& soft = *body.soft;
    const bool as_before =
        shown.body == body_index && shown.basis == soft.basis_count && shown.vertex == patch.vertex;
    if (!as_before) {
        for (std::size_t v = 0; v < patch.vertex.size(); ++v) {
            auto& shape = shown.shape[v];
            tissue::vertex_shapes(tissue::dofs(soft.solid), body.organ->surface, patch.vertex[v],
                                  soft.shape_by_unknown, soft.basis.modes,
                                  {shape[0].data(), shape[1].data(), shape[2].data()});
        }
        shown.body = body_index;
        shown.basis = soft.basis_count;
        shown.vertex.assign(patch.vertex.begin(), patch.vertex.end());
    }
    std::copy_n(shown.shape.begin(), patch.vertex.size(), out.shape.begin());
}

// `triangle`: of the contact, with which all of the patch has turned.
void fill_patch(const Body& body, const tissue::Patch& patch, int tool, int triangle,
                haptics::ToolPatch& out) noexcept {
    out.vertices = static_cast<int>(patch.vertex.size());
    out.triangles = static_cast<int>(patch.triangle.size());
    const glm::dmat3 turn = body.lean_mpn.empty() ? glm::dmat3{1.0} : turn_on(body, triangle);
    for (int v = 0; v < out.vertices; ++v) {
        const std::uint32_t s = patch.vertex[v];
        out.vertex[v] = {.anchor_m = body.skin_m[s],
                         .normal = body.skin_normal[s],
                         .radius_over_thickness = body.tip[tool].radius_m * body.thinness_1pm[s],
                         .normal_mpn = body.normal_mpn[s],
                         .tangential_mpn = body.tangential_mpn[s],
                         .lean_mpn = body.lean_mpn.empty() ? tissue::SymmetricTensor{}
                                                           : turned(body.lean_mpn[s], turn)};
    }
    for (int t = 0; t < out.triangles; ++t) {
        out.triangle[t] = {
            .vertex = patch.corner[t], .neighbour = patch.neighbour[t], .id = patch.triangle[t]};
    }
}

void fill_tool(TissueRig& rig, int tool, haptics::ToolPatch& out) noexcept {
    const FemContact& contact = rig.contact[tool];
    out.near = contact.body >= 0;
    out.vertices = out.triangles = 0;
    out.force_n = contact.force_n;
    out.contact = {};
    out.memory = {};
    out.closing = contact.closing;
    if (!out.near)
        return;
    const Body& body = rig.bodies[contact.body];
    out.body = static_cast<std::uint8_t>(contact.body);
    out.friction = body.material.friction;
    out.table = body.tip[tool].table.get();
    out.floor_mpn = rig.floor_mpn[tool];
    const double span_s = (rig.config.latency_periods + 2.0) * rig.config.step_s;
    tissue::Patch& patch = rig.patch[tool];
    tissue::gather_patch(body.organ->surface, body.skin_m,
                         static_cast<std::uint32_t>(contact.at.triangle),
                         rig.config.patch_radius_m + contact.speed_mps * span_s, patch);
    fill_patch(body, patch, tool, contact.at.triangle, out);
    if (body.soft)
        fill_shapes(body, patch, contact.body, rig.shown[tool], out);
    out.contact = {patch.triangle_local[contact.at.triangle], contact.at.weight};
    out.memory = rig.memory[tool];
}

} // namespace

void make_local_models(TissueRig& rig, haptics::LocalModels& local) noexcept {
    local.modes = 0;
    for (haptics::ToolPatch& tool : local.tool)
        tool.first_mode = tool.modes = 0;
    for (std::size_t b = 0; b < rig.bodies.size(); ++b) {
        if (!rig.bodies[b].soft)
            continue;
        std::array<tissue::BasisContact, kTools> contacts;
        std::size_t count = 0;
        for (int i = 0; i < kTools; ++i) {
            if (rig.contact[i].body != static_cast<int>(b))
                continue;
            contacts[count] = basis_contact(rig.bodies[b], rig.contact[i], rig.memory[i].grasped);
            contacts[count++].slot = i;
        }
        if (count == 0)
            continue;
        const int first = add_modes(rig.bodies[b], std::span(contacts).first(count), local);
        for (int i = 0; i < kTools; ++i) {
            if (rig.contact[i].body != static_cast<int>(b))
                continue;
            local.tool[i].first_mode = first;
            local.tool[i].modes = local.modes - first;
        }
    }
    for (int i = 0; i < kTools; ++i)
        fill_tool(rig, i, local.tool[i]);
}

} // namespace sim
