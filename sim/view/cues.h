// sim/view/cues.h
// What can be heard: made from two pictures in a row, so nothing sounds that is not also seen.
// Pure; render thread.
#pragma once

#include "sim/view/frame.h"

namespace view {

struct Cues {
    bool contact = false; // a tool has begun to touch: its force bar moves
    bool error = false;   // the error counter has gone up
    bool success = false; // a target is done: its mark turns grey
};

/// What a picture says that the one before did not. The first frame of an attempt sounds nothing.
class Listener {
  public:
    Cues hear(const ViewFrame& frame) noexcept;
    /// The next frame is a first one.
    void forget() noexcept { known_ = false; }

  private:
    bool known_ = false;
    std::array<bool, kTools> touching_{};
    int errors_ = 0, done_ = 0;
};

} // namespace view
