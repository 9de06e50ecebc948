// haptics/collision/seen_lately.h
// Which things a query has looked at lately, so that one that lies in several cells is rarely
// looked at twice. On the stack of the query: nothing is shared.
#pragma once

#include <array>
#include <cstdint>

namespace haptics {

class SeenLately {
  public:
    SeenLately() noexcept { number_.fill(0xffffffffu); }
    bool first_time(std::uint32_t number) noexcept {
        std::uint32_t& kept = number_[number % number_.size()];
        const bool first = kept != number;
        kept = number;
        return first;
    }

  private:
    std::array<std::uint32_t, 64> number_;
};

} // namespace haptics
