// sim/view/look.h
// Fonts, colours and small marks that every page shares. Called by Window and the pages, in the
// render thread, with a current Dear ImGui context.
#pragma once

#include "sim/view/frame.h"
#include "sim/view/picture.h"

#include <string>
#include <string_view>

#include <imgui.h>

namespace view {

struct Fonts {
    ImFont* body = nullptr;
    ImFont* large = nullptr;
    ImFont* title = nullptr;
};

/// Rebuilds the font atlas for this height of body text and uploads it. Falls back to the
/// built-in face if the system has no DejaVu Sans.
Fonts load_fonts(float body_px);
/// Where the digits 0-9 and the letters of the roles lie in the atlas, in the title face.
Digits digits_of(const Fonts& fonts);
/// Colours, rounding and spacing for this height of body text.
void set_look(float body_px);

namespace ink {
inline constexpr ImU32 text = IM_COL32(238, 238, 236, 255), quiet = IM_COL32(176, 180, 184, 255);
inline constexpr ImU32 panel = IM_COL32(16, 20, 24, 205), track = IM_COL32(58, 64, 70, 255);
inline constexpr ImU32 good = IM_COL32(96, 196, 110, 255), bad = IM_COL32(240, 96, 84, 255);
inline constexpr ImU32 warn = IM_COL32(250, 200, 80, 255);
} // namespace ink

ImU32 role_ink(Role role, float alpha = 1.0F);
const char* role_letter(Role role); // "L", "R", "A", "E"
const char* role_word(Role role);   // "left", "right", "assist", "endoscope"
std::string role_name(Role role);   // "left tool", "endoscope"

/// The role's shape, filled, with its text in the middle; `radius_px` as of the circle.
void draw_badge(ImDrawList& list, ImVec2 centre, float radius_px, Role role, std::string_view text);
void draw_text(ImDrawList& list, ImFont* font, ImVec2 at, ImU32 colour, std::string_view text);
ImVec2 text_size(ImFont* font, std::string_view text);

} // namespace view
