// sim/view/png.h
// Writes a picture to a file. Called by Window::screenshot().
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace view {

/// RGB bytes, rows from the bottom up as OpenGL reads them. Throws WindowError with the path.
void write_png(const std::string& path, std::span<const std::uint8_t> rgb, int width_px,
               int height_px);

} // namespace view
