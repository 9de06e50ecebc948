// sim/view/tones.cpp
#include "sim/view/tones.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace view {
namespace {

/// Adds a tone that fades in over 2 ms and out to its end, with a weak octave above.
void add_tone(std::vector<float>& sound, double from_s, double seconds, double hz, double loud) {
    const auto first = static_cast<std::size_t>(from_s * kSampleRate_hz);
    const auto count = static_cast<std::size_t>(seconds * kSampleRate_hz);
    sound.resize(std::max(sound.size(), first + count), 0.0F);
    for (std::size_t i = 0; i < count; ++i) {
        const double t = static_cast<double>(i) / kSampleRate_hz;
        const double left = 1.0 - t / seconds;
        const double shape = std::min(1.0, t / 0.002) * left * left;
        const double wave = 2.0 * std::numbers::pi * hz * t;
        sound[first + i] +=
            static_cast<float>(loud * shape * (0.8 * std::sin(wave) + 0.2 * std::sin(2.0 * wave)));
    }
}

void add(std::vector<float>& sum, const std::vector<float>& more) {
    sum.resize(std::max(sum.size(), more.size()), 0.0F);
    for (std::size_t i = 0; i < more.size(); ++i)
        sum[i] = std::clamp(sum[i] + more[i], -1.0F, 1.0F);
}

} // namespace

std::vector<float> contact_tone() {
    std::vector<float> sound;
    add_tone(sound, 0.0, 0.025, 1400.0, 0.25);
    return sound;
}

std::vector<float> error_tone() {
    std::vector<float> sound;
    add_tone(sound, 0.0, 0.16, 220.0, 0.5);
    add_tone(sound, 0.14, 0.18, 165.0, 0.5);
    return sound;
}

std::vector<float> success_tone() {
    std::vector<float> sound;
    add_tone(sound, 0.0, 0.14, 660.0, 0.35);
    add_tone(sound, 0.10, 0.20, 990.0, 0.35);
    return sound;
}

std::vector<float> mixed(const Cues& cues) {
    std::vector<float> sum;
    if (cues.contact)
        add(sum, contact_tone());
    if (cues.error)
        add(sum, error_tone());
    if (cues.success)
        add(sum, success_tone());
    return sum;
}

} // namespace view
