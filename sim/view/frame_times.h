// sim/view/frame_times.h
// How long pictures took, kept as counts so that a long session needs no more room than a short
// one. Pure; used by Window, in the render thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace view {

class FrameTimes {
  public:
    static constexpr double kBin_ms = 0.25, kMost_ms = 250.0; // longer ones count as the longest

    void record(double ms) noexcept {
        const double bin = std::clamp(ms, 0.0, kMost_ms) / kBin_ms;
        ++count_[std::min(count_.size() - 1, static_cast<std::size_t>(bin))];
        ++total_;
    }
    /// The upper edge of the bin that holds this share (0..1) of all pictures; 0 without any.
    double percentile_ms(double share) const noexcept {
        const double wanted = std::clamp(share, 0.0, 1.0) * static_cast<double>(total_);
        std::uint64_t seen = 0;
        for (std::size_t i = 0; i < count_.size(); ++i) {
            seen += count_[i];
            if (seen > 0 && static_cast<double>(seen) >= wanted)
                return kBin_ms * static_cast<double>(i + 1);
        }
        return 0.0;
    }
    std::uint64_t pictures() const noexcept { return total_; }

  private:
    std::array<std::uint32_t, static_cast<std::size_t>(kMost_ms / kBin_ms) + 1> count_{};
    std::uint64_t total_ = 0;
};

} // namespace view
