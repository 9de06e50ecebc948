// sim/view/page_parts.h
// What every page is put together from. Called by the pages between NewFrame and Render.
#pragma once

#include "sim/view/look.h"

#include <string>

namespace view {

/// A panel in the middle, `wide` and `tall` in body heights, at most the window less a margin.
/// ImGui::End() closes it. `fresh`: it takes the keyboard.
void begin_panel(const char* name, float wide, float tall, bool fresh);
void heading(const Fonts& fonts, const std::string& text);
void quiet(const std::string& text);
/// Large letters in a small window leave this page little room: it closes up.
bool is_narrow();
void bullet(const std::string& text);
/// A large button, smaller on a narrow page; `first` takes the keyboard when the page appears.
bool button(const Fonts& fonts, const char* label, bool first, float wide = 11.0F);

} // namespace view
