// sim/loop/stopwatch.h
// Durations of one kind of work, kept as a histogram so that the tail is exact and a recording
// costs a few nanoseconds. One writer; read after the writer has stopped.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace sim {

template <std::size_t kBins> class Durations {
  public:
    explicit Durations(double bin_us) : bin_us_(bin_us) {}

    void add(double us) noexcept {
        const auto bin = static_cast<std::size_t>(std::max(0.0, us / bin_us_));
        ++count_[std::min(bin, kBins - 1)];
        ++total_;
        max_us_ = std::max(max_us_, us);
        sum_us_ += us;
    }
    /// Upper edge of the bin that holds the given share of all; the maximum in the last bin.
    double at_share(double share) const noexcept {
        std::uint64_t seen = 0;
        for (std::size_t i = 0; i < kBins; ++i) {
            seen += count_[i];
            if (total_ > 0 && static_cast<double>(seen) >= share * static_cast<double>(total_)) {
                return i + 1 == kBins ? max_us_ : std::min(max_us_, bin_us_ * double(i + 1));
            }
        }
        return 0.0;
    }
    double max_us() const noexcept { return max_us_; }
    double mean_us() const noexcept { return total_ ? sum_us_ / double(total_) : 0.0; }
    std::uint64_t total() const noexcept { return total_; }

  private:
    double bin_us_;
    std::array<std::uint32_t, kBins> count_{};
    std::uint64_t total_ = 0;
    double max_us_ = 0.0, sum_us_ = 0.0;
};

using TickDurations = Durations<4000>; // 0.5 us bins to 2 ms
using StepDurations = Durations<5000>; // 20 us bins to 100 ms

} // namespace sim
