// sim/view/resolution.h
// How large the 3-D picture is drawn: full size while there is time, smaller while there is not.
// Pure; the caller measures. Used by Window.
#pragma once

#include <algorithm>

namespace view {

/// Changes the picture's side length by steps, slowly upwards, so that it does not flicker.
class Resolution {
  public:
    static constexpr double kSlow_ms = 26.0, kFast_ms = 13.0, kStep = 0.05;
    static constexpr int kPatience = 12; // pictures between two changes

    /// One picture took `draw_ms`. Never below half size, nor below 800 x 600 in a larger window.
    void observe(double draw_ms, int width_px, int height_px) noexcept {
        const double least = least_share(width_px, height_px);
        mean_ms_ += (draw_ms - mean_ms_) / 10.0;
        if (++since_change_ >= kPatience && mean_ms_ > kSlow_ms && share_ > least)
            change(-2.0 * kStep);
        else if (since_change_ >= 5 * kPatience && mean_ms_ < kFast_ms && share_ < 1.0)
            change(kStep);
        share_ = std::clamp(share_, least, 1.0);
    }
    double share() const noexcept { return share_; }
    double mean_ms() const noexcept { return mean_ms_; }

    static double least_share(int width_px, int height_px) noexcept {
        return std::min(
            1.0, std::max({0.5, 800.0 / std::max(1, width_px), 600.0 / std::max(1, height_px)}));
    }

  private:
    void change(double by) noexcept {
        share_ += by;
        since_change_ = 0;
    }
    double share_ = 1.0, mean_ms_ = 0.0;
    int since_change_ = 0;
};

} // namespace view
