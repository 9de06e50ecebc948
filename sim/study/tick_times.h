// sim/study/tick_times.h
// How single calls of some hundred nanoseconds are timed: the same clock, the same eviction of the
// caches and the same statistics for trocar's bench and for the peers' programs. Benches only; one
// thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>
#if defined(__x86_64__)
#include <x86intrin.h>
#endif

namespace sim {

/// The processor's counter, fenced so that nothing timed leaks out (Paoloni 2010, How to Benchmark
/// Code Execution Times on Intel IA-32 and IA-64): its rate is the invariant TSC's. Elsewhere the
/// steady clock.
class TickClock {
  public:
    /// Measures its rate against the steady clock for 20 ms, and its own overhead.
    TickClock();

    std::uint64_t start() const noexcept {
#if defined(__x86_64__)
        _mm_lfence();
        const std::uint64_t now = __rdtsc();
        _mm_lfence();
        return now;
#else
        return static_cast<std::uint64_t>(
            std::chrono::steady_clock::now().time_since_epoch().count());
#endif
    }
    std::uint64_t stop() const noexcept {
#if defined(__x86_64__)
        unsigned processor = 0;
        const std::uint64_t now = __rdtscp(&processor);
        _mm_lfence();
        return now;
#else
        return start();
#endif
    }
    double ns(std::uint64_t from, std::uint64_t to) const noexcept {
        return static_cast<double>(to - from) * ns_per_count_;
    }
    /// Median of what an empty interval reads; part of every time, not taken off.
    double overhead_ns() const noexcept {
        return overhead_ns_;
    }

  private:
    double ns_per_count_ = 1.0, overhead_ns_ = 0.0;
};

/// Of a list of times. Percentiles are order statistics (the smallest time that the share is not
/// above), no interpolation. All 0 if there are none.
struct TickTimes {
    std::size_t n = 0;
    double mean_ns = 0.0, p50_ns = 0.0, p99_ns = 0.0, p9999_ns = 0.0, max_ns = 0.0;
};
TickTimes tick_times(std::vector<double> ns);

/// Whether somebody else got the processor during a call, which then says nothing about it. Asked
/// of the system only for calls of 0.1 ms and more, so that it disturbs no others: what is
/// shorter was not taken away for a scheduler's slice.
class PreemptionWatch {
  public:
    PreemptionWatch();
    bool preempted(double ns) noexcept;

  private:
    long switches_ = 0; // involuntary ones of this thread, so far
};

/// Drives everything out of the caches, code too, by writing twice the last level's size (as the
/// system tells it; 64 MB if it does not).
class CacheEvictor {
  public:
    CacheEvictor();
    void evict() noexcept;
    std::size_t bytes() const noexcept { return buffer_.size(); }

  private:
    std::vector<unsigned char> buffer_;
};

} // namespace sim
