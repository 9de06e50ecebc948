// sim/view/noise.cpp
// Three octaves of value noise on a repeating lattice.
#include "sim/view/noise.h"

#include <algorithm>
#include <cstddef>

namespace view {
namespace {

/// A lattice value in 0..1 from integers (finaliser of MurmurHash3).
double lattice(int x, int y, int channel, int side) {
    const auto wrap = [side](int i) { return static_cast<std::uint32_t>(i % side); };
    std::uint32_t h =
        wrap(x) + 256U * (wrap(y) + 256U * static_cast<std::uint32_t>(channel + 8 * side));
    h ^= h >> 16U;
    h *= 0x85ebca6bU;
    h ^= h >> 13U;
    h *= 0xc2b2ae35U;
    h ^= h >> 16U;
    return static_cast<double>(h) / 4294967295.0;
}

double smooth(double f) {
    return f * f * (3.0 - 2.0 * f);
}

/// `x`, `y` in 0..1, `side` lattice cells.
double octave(double x, double y, int channel, int side) {
    const int i = static_cast<int>(x * side), j = static_cast<int>(y * side);
    const double u = smooth(x * side - i), v = smooth(y * side - j);
    const auto at = [&](int a, int b) { return lattice(i + a, j + b, channel, side); };
    return (1.0 - v) * ((1.0 - u) * at(0, 0) + u * at(1, 0)) +
           v * ((1.0 - u) * at(0, 1) + u * at(1, 1));
}

} // namespace

std::vector<std::uint8_t> noise_tile() {
    std::vector<std::uint8_t> tile;
    tile.reserve(std::size_t{4} * kNoiseSide * kNoiseSide);
    for (int j = 0; j < kNoiseSide; ++j)
        for (int i = 0; i < kNoiseSide; ++i)
            for (int channel = 0; channel < 4; ++channel) {
                const double x = (i + 0.5) / kNoiseSide, y = (j + 0.5) / kNoiseSide;
                const double value = 0.55 * octave(x, y, channel, 16) +
                                     0.30 * octave(x, y, channel, 32) +
                                     0.15 * octave(x, y, channel, 64);
                tile.push_back(static_cast<std::uint8_t>(std::clamp(255.0 * value, 0.0, 255.0)));
            }
    return tile;
}

} // namespace view
