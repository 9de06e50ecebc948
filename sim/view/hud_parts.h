// sim/view/hud_parts.h
// What the HUD's panels share. Used by hud.cpp and hud_instruments.cpp, in the render thread.
#pragma once

#include "sim/view/frame.h"
#include "sim/view/look.h"

namespace view {

struct Pen {
    ImDrawList& list;
    const Fonts& fonts;
    float em, width, height; // body text height and window, pixels

    /// Large letters in a small window: what stands side by side goes below one another.
    bool narrow() const { return width < 42.0F * em; }
};

inline void panel(const Pen& pen, ImVec2 from, ImVec2 to) {
    pen.list.AddRectFilled(from, to, ink::panel, 6.0F);
}

/// Along the lower edge: a force panel for each tool, one for the endoscope.
void draw_instruments(const Pen& pen, const ViewFrame& frame);

} // namespace view
