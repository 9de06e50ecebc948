// sim/view/sound.h
// The loudspeaker, by SDL. Without one everything here does nothing. Called by Window, in the
// render thread; SDL's own thread takes the samples from its queue, so play() never waits.
#pragma once

#include "sim/view/cues.h"

#include <cstdint>

namespace view {

class Speaker {
  public:
    /// Opens the device unless `wanted` is false; one that is missing or refuses is no error.
    Speaker(bool wanted, bool muted);
    ~Speaker();
    Speaker(const Speaker&) = delete;
    Speaker& operator=(const Speaker&) = delete;

    /// Newest first: what still waits is dropped, so that no sound comes late.
    void play(const Cues& cues);
    void toggle() noexcept { muted_ = !muted_; }
    bool muted() const noexcept { return muted_; }

  private:
    std::uint32_t device_ = 0; // 0: none
    bool opened_ = false, muted_ = false;
};

} // namespace view
