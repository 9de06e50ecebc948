// tasks/hand/late.h
// What somebody knows now of what was so a while ago: eye and hand take their time. Part of every
// hand; one entry a tick, no allocation after set-up.
#pragma once

#include "tasks/exercise/observation.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tasks {

template <class Percept> class Late {
  public:
    explicit Late(double longest_s) : past_(ticks_in(longest_s) + 1) {}
    void push(const Percept& now) {
        at_ = (at_ + 1) % past_.size();
        past_[at_] = now;
    }
    Percept& now() { return past_[at_]; }
    /// `delay_s` above the longest is the longest.
    const Percept& before(double delay_s) const {
        const std::size_t delay = std::min(ticks_in(delay_s), past_.size() - 1);
        return past_[(at_ + past_.size() - delay) % past_.size()];
    }

  private:
    static std::size_t ticks_in(double seconds) {
        return static_cast<std::size_t>(std::lround(seconds / kTick_s));
    }
    std::vector<Percept> past_; // ring
    std::size_t at_ = 0;
};

} // namespace tasks
