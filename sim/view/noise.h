// sim/view/noise.h
// A tile of smooth repeating noise for the tissue's colour and film. Pure; the same every time.
#pragma once

#include <cstdint>
#include <vector>

namespace view {

inline constexpr int kNoiseSide = 256;

/// kNoiseSide^2 RGBA bytes, x fastest; four independent channels about one half, repeating.
/// Its coarsest cells are 1/16 of a side.
std::vector<std::uint8_t> noise_tile();

} // namespace view
