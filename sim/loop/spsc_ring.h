// sim/loop/spsc_ring.h
// Every value from one writer thread to one reader thread, in order, for the logbook. Unlike
// NewestBuffer nothing is skipped; when full, push() refuses, and the writer counts the drop.
#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

namespace sim {

template <typename T, std::size_t kCapacity> class SpscRing {
    static_assert((kCapacity & (kCapacity - 1)) == 0, "capacity must be a power of two");

  public:
    SpscRing() : values_(kCapacity) {}

    /// Writer thread only. False if the reader is kCapacity values behind.
    bool push(const T& value) noexcept {
        const std::size_t head = head_.load(std::memory_order_relaxed);
        if (head - tail_.load(std::memory_order_acquire) == kCapacity)
            return false;
        values_[head & (kCapacity - 1)] = value;
        head_.store(head + 1, std::memory_order_release);
        return true;
    }

    /// Reader thread only. False if there is nothing to read.
    bool pop(T& out) noexcept {
        const std::size_t tail = tail_.load(std::memory_order_relaxed);
        if (tail == head_.load(std::memory_order_acquire))
            return false;
        out = values_[tail & (kCapacity - 1)];
        tail_.store(tail + 1, std::memory_order_release);
        return true;
    }

  private:
    std::vector<T> values_;
    alignas(64) std::atomic<std::size_t> head_{0};
    alignas(64) std::atomic<std::size_t> tail_{0};
};

} // namespace sim
