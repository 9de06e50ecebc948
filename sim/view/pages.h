// sim/view/pages.h
// Menu, instruction card, pause and score as Dear ImGui windows. Called by Window between
// NewFrame and Render, in the render thread. Arrow keys move, Enter and Space press.
#pragma once

#include "sim/view/input.h"
#include "sim/view/look.h"
#include "sim/view/screens.h"

namespace view {

/// Draws the page of `screens.screen` (none for run and demo). A pressed button overrules what the
/// keys said in `input`. `fresh`: first picture of this screen, so the keyboard starts at its top.
void draw_page(const Screens& screens, const Fonts& fonts, bool fresh, UserInput& input);

} // namespace view
