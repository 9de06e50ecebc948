// sim/view/tones.h
// The three sounds as samples. Pure; made once when the window opens.
#pragma once

#include "sim/view/cues.h"

#include <vector>

namespace view {

inline constexpr int kSampleRate_hz = 44100;

/// Mono, -1..1, beginning and ending in silence.
std::vector<float> contact_tone(); // a tick of 25 ms
std::vector<float> error_tone();   // two low tones, falling, 0.3 s
std::vector<float> success_tone(); // two high tones, rising, 0.3 s

/// All that `cues` asks for, one upon the other, never louder than 1; empty if it asks for nothing.
std::vector<float> mixed(const Cues& cues);

} // namespace view
