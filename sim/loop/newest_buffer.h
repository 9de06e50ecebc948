// sim/loop/newest_buffer.h
// Hands the newest T from one writer thread to one reader thread. Neither ever waits. Values may
// be skipped, never torn, never reordered. The reader may keep one value in use while it looks at
// a newer one: that is what a coupling needs while a new local model catches up with the present.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>

namespace sim {

template <typename T> class NewestBuffer {
  public:
    NewestBuffer() : slots_(std::make_unique<std::array<Slot, 4>>()) {}

    /// Writer thread only. Fill this, then publish(). It may hold an old value: set every field.
    T& back() noexcept { return (*slots_)[write_].value; }

    /// Writer thread only. Makes back() the newest value.
    void publish() noexcept {
        write_ = middle_.exchange(write_ | kFresh, std::memory_order_acq_rel) & kIndex;
    }

    /// Reader thread only. Takes the newest value if there is one that was not taken before, else
    /// nullptr. Valid until the next fetch() unless kept.
    const T* fetch() noexcept {
        if (!(middle_.load(std::memory_order_relaxed) & kFresh))
            return nullptr;
        taken_ = middle_.exchange(taken_, std::memory_order_acq_rel) & kIndex;
        return &(*slots_)[taken_].value;
    }

    /// Reader thread only. The value fetched last stays valid until the next keep(); the one kept
    /// before is given back.
    void keep() noexcept { std::swap(taken_, kept_); }

    /// Reader thread only. The newest value ever published, fetched or not.
    const T& latest() noexcept {
        fetch();
        return (*slots_)[taken_].value;
    }

  private:
    static constexpr std::uint8_t kIndex = 0b011;
    static constexpr std::uint8_t kFresh = 0b100;
    static constexpr std::size_t kCacheLine = 64;

    struct alignas(kCacheLine) Slot {
        T value{};
    };

    // Each slot index is held by exactly one of write_, middle_, taken_ and kept_ at any time.
    std::unique_ptr<std::array<Slot, 4>> slots_;
    alignas(kCacheLine) std::atomic<std::uint8_t> middle_{1};
    alignas(kCacheLine) std::uint8_t write_ = 0;
    alignas(kCacheLine) std::uint8_t taken_ = 2;
    std::uint8_t kept_ = 3;

    static_assert(std::atomic<std::uint8_t>::is_always_lock_free);
};

} // namespace sim
