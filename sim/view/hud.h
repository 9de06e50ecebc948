// sim/view/hud.h
// What lies over the picture during an attempt or a demonstration: time, next target, errors,
// force bars, messages. Called by Window between NewFrame and Render, in the render thread.
#pragma once

#include "sim/view/frame.h"
#include "sim/view/look.h"
#include "sim/view/screens.h"

#include <string>

namespace view {

void draw_hud(const ViewFrame& frame, Screen screen, const Fonts& fonts);

/// "1:05.3"; the tenth is cut, not rounded, so that a limit is not shown before it is reached.
std::string clock_text(double seconds);

} // namespace view
