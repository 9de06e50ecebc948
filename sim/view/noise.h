// sim/view/noise.h
// A tile of repeating noise and vessels for the tissue's colour and film. Pure; always the same.
#pragma once

#include <cstdint>
#include <vector>

namespace view {

inline constexpr int kNoiseSide = 256;

/// kNoiseSide^2 RGBA bytes, x fastest, repeating. RGB: independent smooth noise about one half, its
/// coarsest cells 1/16 of a side. A: vessels that branch, 0 beside them to 255 in their middle.
std::vector<std::uint8_t> noise_tile();

} // namespace view
