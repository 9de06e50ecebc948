// sim/view/resolution.h
// How large the 3-D picture is drawn: full size while there is time, smaller while there is not.
// Pure; the caller measures. Used by Window.
#pragma once

#include <algorithm>
#include <cmath>

namespace view {

/// Shrinks at once to what should be quick enough, grows by small steps. A step up that had to be
/// taken back makes the next one wait twice as long, so that the picture does not flicker between
/// two sizes.
class Resolution {
  public:
    static constexpr double kSlow_ms = 26.0, kAim_ms = 20.0, kFast_ms = 13.0, kStep = 0.05;
    static constexpr int kPatience = 12, kMostPatience = 64 * kPatience; // pictures

    /// One picture took `draw_ms`. Never below 800 x 600 in a window that is larger.
    void observe(double draw_ms, int width_px, int height_px) noexcept {
        const double least = least_share(width_px, height_px);
        mean_ms_ += (draw_ms - mean_ms_) / 10.0;
        ++since_change_;
        if (since_change_ >= kPatience && mean_ms_ > kSlow_ms && share_ > least) {
            if (grew_)
                growing_patience_ = std::min(kMostPatience, 2 * growing_patience_);
            // the cost of a picture goes with its area
            change(
                std::max(least, std::min(share_ - kStep, share_ * std::sqrt(kAim_ms / mean_ms_))));
            grew_ = false;
        } else if (since_change_ >= growing_patience_ && mean_ms_ < kFast_ms && share_ < 1.0) {
            change(std::min(1.0, share_ + kStep));
            grew_ = true;
        }
        share_ = std::clamp(share_, least, 1.0);
    }
    double share() const noexcept { return share_; }
    double mean_ms() const noexcept { return mean_ms_; }

    static double least_share(int width_px, int height_px) noexcept {
        return std::min(1.0,
                        std::max(800.0 / std::max(1, width_px), 600.0 / std::max(1, height_px)));
    }

  private:
    void change(double share) noexcept {
        mean_ms_ *= share * share / (share_ * share_); // what it should be now
        share_ = share;
        since_change_ = 0;
    }
    double share_ = 1.0, mean_ms_ = 0.0;
    int since_change_ = 0, growing_patience_ = 5 * kPatience;
    bool grew_ = false; // the last change was a step up
};

} // namespace view
