// sim/loop/pacer.h
// Wakes a thread every period on the monotonic clock, and counts what came late. After a stall it
// does not race to catch up: time starts again from now, because a hand does not rewind.
#pragma once

#include <cstdint>

namespace sim {

class Pacer {
  public:
    explicit Pacer(double period_s) noexcept;

    /// Sleeps to the next wake-up. Late by a whole period or more counts as missed.
    void wait() noexcept;
    std::uint64_t missed() const noexcept { return missed_; }

  private:
    std::int64_t period_ns_;
    std::int64_t next_ns_;
    std::uint64_t missed_ = 0;
};

/// Real-time priority for the calling thread if the system allows it; false if it does not.
bool raise_priority(int priority) noexcept;

} // namespace sim
