// assets/bake/import/phase_clock.h
// Names the phases of an import as they begin, and how long each took. Called by import only.
#pragma once

#include "assets/bake/bake.h"

#include <chrono>
#include <fmt/format.h>

namespace bake {

class PhaseClock {
  public:
    explicit PhaseClock(std::function<void(const std::string&)> tell) : tell_(std::move(tell)) {}
    void begin(const std::string& name) {
        end();
        phases_.push_back({name, 0.0});
        start_ = Clock::now();
        open_ = true;
        say(name + " ...");
    }
    void end() {
        if (open_) {
            phases_.back().seconds = std::chrono::duration<double>(Clock::now() - start_).count();
            say(fmt::format("{}: {:.2f} s", phases_.back().name, phases_.back().seconds));
        }
        open_ = false;
    }
    void say(const std::string& line) const {
        if (tell_) {
            tell_(line);
        }
    }
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(Clock::now() - born_).count();
    }
    [[nodiscard]] const std::vector<Phase>& phases() const { return phases_; }

  private:
    using Clock = std::chrono::steady_clock;
    std::function<void(const std::string&)> tell_;
    std::vector<Phase> phases_;
    Clock::time_point born_ = Clock::now(), start_;
    bool open_ = false;
};

} // namespace bake
