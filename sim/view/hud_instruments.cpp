// sim/view/hud_instruments.cpp
// Who holds each tool and what it feels, who holds the endoscope and how level its picture is.
#include "sim/view/hud_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace view {
namespace {

/// The bar spans 0 .. 1.25 limit: band in green, if there is one, limit as a red mark, the force as
/// a fill.
void draw_bar(const Pen& pen, const ToolView& tool, const ForceLimits& limits, ImVec2 from,
              float width) {
    const float tall = 0.75F * pen.em;
    const double full_n = 1.25 * std::max({limits.limit_n, limits.band_max_n, 1e-3});
    const auto x_of = [&](double n) {
        return from.x + width * static_cast<float>(std::clamp(n / full_n, 0.0, 1.0));
    };
    const double n = glm::length(tool.force_n);
    const bool band = limits.band_max_n > limits.band_min_n, over = n > limits.limit_n;
    const bool inside = band && n >= limits.band_min_n && n <= limits.band_max_n;
    pen.list.AddRectFilled(from, {from.x + width, from.y + tall}, ink::track, 3.0F);
    if (band)
        pen.list.AddRectFilled({x_of(limits.band_min_n), from.y},
                               {x_of(limits.band_max_n), from.y + tall},
                               IM_COL32(52, 110, 62, 255));
    const ImU32 fill = over ? ink::bad : inside ? ink::good : IM_COL32(214, 216, 218, 255);
    pen.list.AddRectFilled({from.x, from.y + 0.22F * tall}, {x_of(n), from.y + 0.78F * tall}, fill,
                           2.0F);
    const float mark = x_of(limits.limit_n);
    pen.list.AddLine({mark, from.y - 0.2F * pen.em}, {mark, from.y + tall + 0.2F * pen.em},
                     ink::bad, 2.5F);
    if (!band)
        return;
    for (const double edge : {limits.band_min_n, limits.band_max_n})
        pen.list.AddLine({x_of(edge), from.y}, {x_of(edge), from.y + tall}, ink::good, 1.5F);
}

std::string holder(const ViewFrame& frame, const ToolView& tool) {
    if (tool.faulted)
        return "device fault";
    if (tool.assistant)
        return "assistant";
    if (!frame.felt || !frame.forces_on)
        return "not felt"; // the frame already says which tool is yours
    return tool.active ? "you" : "";
}

void draw_force(const Pen& pen, const ViewFrame& frame, const ToolView& tool, ImVec2 from,
                ImVec2 to) {
    const float em = pen.em;
    panel(pen, from, to);
    if (tool.active)
        pen.list.AddRect(from, to, role_ink(tool.role), 6.0F, 0, 2.5F);
    draw_badge(pen.list, {from.x + 1.6F * em, from.y + 1.9F * em}, 0.9F * em, tool.role,
               role_letter(tool.role));
    if (tool.touching) // what the tick says to the ear
        pen.list.AddCircle({from.x + 1.6F * em, from.y + 1.9F * em}, 1.35F * em, ink::text, 32,
                           0.12F * em);
    const float left = from.x + 3.1F * em, right = to.x - 0.9F * em;
    const std::string value = fmt::format("{:.2f} N", glm::length(tool.force_n));
    const bool over = glm::length(tool.force_n) > frame.force.limit_n;
    draw_text(pen.list, pen.fonts.large,
              {right - text_size(pen.fonts.large, value).x, from.y + 0.35F * em},
              over ? ink::bad : ink::text, value);
    const bool below = right - left < 10.0F * em; // no room beside the number
    draw_text(pen.list, pen.fonts.body, {left, from.y + (below ? 2.0F : 0.6F) * em},
              tool.faulted ? ink::bad : ink::quiet, holder(frame, tool));
    draw_bar(pen, tool, frame.force, {left, to.y - 1.35F * em}, right - left);
}

const char* holder(const ScopeView& scope) {
    return scope.faulted     ? "device fault"
           : scope.active    ? "you"
           : scope.assistant ? "assistant"
                             : "mount";
}

/// Where level is in the picture: a line in a circle with fixed wings. Beyond 15 degrees it is
/// thick, in another colour, and has a triangle above.
void draw_horizon(const Pen& pen, ImVec2 centre, float radius, double horizon_rad) {
    constexpr double kMost_rad = 15.0 * std::numbers::pi / 180.0;
    const bool tilted = std::abs(horizon_rad) > kMost_rad;
    const ImU32 colour = tilted ? ink::warn : ink::text;
    const float r = radius, wing = 0.35F * r;
    pen.list.AddCircle(centre, r, ink::quiet, 32, 1.5F);
    for (const float side : {-1.0F, 1.0F})
        pen.list.AddLine({centre.x + side * r, centre.y}, {centre.x + side * (r + wing), centre.y},
                         ink::quiet, 2.0F);
    const ImVec2 along(r * static_cast<float>(std::cos(horizon_rad)),
                       -r * static_cast<float>(std::sin(horizon_rad)));
    pen.list.AddLine({centre.x - along.x, centre.y - along.y},
                     {centre.x + along.x, centre.y + along.y}, colour, tilted ? 4.0F : 2.0F);
    if (tilted)
        pen.list.AddTriangleFilled({centre.x - 0.4F * r, centre.y - 1.55F * r},
                                   {centre.x + 0.4F * r, centre.y - 1.55F * r},
                                   {centre.x, centre.y - 1.05F * r}, colour);
}

void draw_scope(const Pen& pen, const ScopeView& scope, ImVec2 from, ImVec2 to) {
    const float em = pen.em, tall = to.y - from.y;
    const bool flat = tall < 3.0F * em, below = !flat && to.x - from.x < 14.0F * em;
    panel(pen, from, to);
    if (scope.active)
        pen.list.AddRect(from, to, role_ink(Role::scope), 6.0F, 0, 2.5F);
    const float middle = from.y + (flat ? 0.5F * tall : 1.9F * em);
    draw_badge(pen.list, {from.x + 1.6F * em, middle}, 0.9F * em, Role::scope,
               role_letter(Role::scope));
    const float radius = (flat ? 0.8F : 1.0F) * em;
    draw_horizon(pen, {to.x - 1.6F * radius - 0.5F * em, middle + 0.2F * em}, radius,
                 scope.horizon_rad);
    const std::string turn =
        fmt::format("{:.0f}\u00b0", std::abs(scope.horizon_rad) * 180.0 / std::numbers::pi);
    const float left = from.x + 3.1F * em;
    const ImVec2 who = below  ? ImVec2(from.x + 0.7F * em, from.y + 3.5F * em)
                       : flat ? ImVec2(left, middle - 0.55F * em)
                              : ImVec2(left, from.y + 0.6F * em);
    draw_text(pen.list, pen.fonts.body, who, scope.faulted ? ink::bad : ink::quiet, holder(scope));
    if (flat)
        return;
    const ImVec2 size = text_size(pen.fonts.body, turn);
    draw_text(pen.list, pen.fonts.body,
              below ? ImVec2(to.x - 0.7F * em - size.x, who.y) : ImVec2(left, from.y + 2.0F * em),
              ink::quiet, turn);
}

} // namespace

void draw_instruments(const Pen& pen, const ViewFrame& frame) {
    const float em = pen.em, gap = 0.8F * em, bottom = pen.height - 2.5F * em;
    const auto tools = std::count_if(frame.tools.begin(), frame.tools.end(),
                                     [](const ToolView& tool) { return tool.present; });
    const bool beside = frame.scope.present && !pen.narrow(); // else in a row of its own
    const auto here = static_cast<float>(tools + (beside ? 1 : 0));
    const float most = (pen.width - 2.0F * em + gap) / (beside ? 4.0F : 3.0F) - gap;
    const float wide = std::min(most, 19.0F * em);
    const float tall = wide < 14.0F * em ? 5.1F * em : 3.7F * em;
    float x = 0.5F * (pen.width - here * (wide + gap) + gap);
    for (const ToolView& tool : frame.tools) {
        if (!tool.present)
            continue;
        draw_force(pen, frame, tool, {x, bottom - tall}, {x + wide, bottom});
        x += wide + gap;
    }
    if (beside)
        draw_scope(pen, frame.scope, {x, bottom - tall}, {x + wide, bottom});
    else if (frame.scope.present)
        draw_scope(pen, frame.scope, {pen.width - 12.0F * em, bottom - tall - 3.0F * em},
                   {pen.width - em, bottom - tall - 0.4F * em});
}

} // namespace view
