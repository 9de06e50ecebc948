// sim/view/noise.cpp
// Three octaves of value noise on a repeating lattice; vessels as walks that turn and branch.
#include "sim/view/noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

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

/// A number 0..1 that differs from call to call.
class Dice {
  public:
    double roll() { return lattice(next_++, 7, 5, 4096); }

  private:
    int next_ = 0;
};

struct Walker {
    double x, y, heading_rad, radius, left; // texels
};

/// One soft round spot, over the edges onto the other side.
void spot(std::vector<float>& vessel, const Walker& at) {
    const int reach = static_cast<int>(std::ceil(at.radius + 1.0));
    const int i0 = static_cast<int>(std::floor(at.x)), j0 = static_cast<int>(std::floor(at.y));
    for (int j = j0 - reach; j <= j0 + reach; ++j)
        for (int i = i0 - reach; i <= i0 + reach; ++i) {
            const double away = std::hypot(i + 0.5 - at.x, j + 0.5 - at.y);
            const auto value = static_cast<float>(std::clamp(at.radius + 0.5 - away, 0.0, 1.0));
            float& texel = vessel[static_cast<std::size_t>(j & (kNoiseSide - 1)) * kNoiseSide +
                                  static_cast<std::size_t>(i & (kNoiseSide - 1))];
            texel = std::max(texel, value);
        }
}

/// Trunks that wind across the tile, thin out, and send off thinner branches.
std::vector<float> vessels() {
    std::vector<float> vessel(std::size_t{kNoiseSide} * kNoiseSide, 0.0F);
    Dice dice;
    std::vector<Walker> walkers;
    for (int i = 0; i < 9; ++i)
        walkers.push_back({kNoiseSide * dice.roll(), kNoiseSide * dice.roll(),
                           2.0 * std::numbers::pi * dice.roll(), 1.1 + 0.7 * dice.roll(),
                           90.0 + 90.0 * dice.roll()});
    while (!walkers.empty()) {
        Walker w = walkers.back();
        walkers.pop_back();
        double turn_rad = 0.0;
        for (; w.left > 0.0 && w.radius > 0.25; w.left -= 0.5) {
            spot(vessel, w);
            turn_rad = 0.92 * turn_rad + 0.045 * (dice.roll() - 0.5);
            w.heading_rad += turn_rad;
            w.radius *= 0.9965;
            w.x += 0.5 * std::cos(w.heading_rad);
            w.y += 0.5 * std::sin(w.heading_rad);
            if (dice.roll() < 0.018) { // 25 to 55 degrees aside
                const double aside = (dice.roll() < 0.5 ? -1.0 : 1.0) * (0.45 + 0.5 * dice.roll());
                walkers.push_back({w.x, w.y, w.heading_rad + aside, 0.68 * w.radius,
                                   w.left * (0.4 + 0.4 * dice.roll())});
            }
        }
    }
    return vessel;
}

} // namespace

std::vector<std::uint8_t> noise_tile() {
    std::vector<std::uint8_t> tile;
    tile.reserve(std::size_t{4} * kNoiseSide * kNoiseSide);
    const std::vector<float> vessel = vessels();
    for (int j = 0; j < kNoiseSide; ++j)
        for (int i = 0; i < kNoiseSide; ++i) {
            for (int channel = 0; channel < 3; ++channel) {
                const double x = (i + 0.5) / kNoiseSide, y = (j + 0.5) / kNoiseSide;
                const double value = 0.55 * octave(x, y, channel, 16) +
                                     0.30 * octave(x, y, channel, 32) +
                                     0.15 * octave(x, y, channel, 64);
                tile.push_back(static_cast<std::uint8_t>(std::clamp(255.0 * value, 0.0, 255.0)));
            }
            tile.push_back(static_cast<std::uint8_t>(255.0F * vessel[tile.size() / 4]));
        }
    return tile;
}

} // namespace view
