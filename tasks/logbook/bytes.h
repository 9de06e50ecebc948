// tasks/logbook/bytes.h
// Numbers to bytes and back: base-128 varints and zigzag for the trace. Used by the trace codec;
// any thread, allocates when writing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace tasks {

/// Signed to unsigned so that small magnitudes stay small: 0, -1, 1, -2 -> 0, 1, 2, 3.
constexpr std::uint64_t zigzag(std::int64_t value) noexcept {
    return (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63);
}
constexpr std::int64_t unzigzag(std::uint64_t code) noexcept {
    return static_cast<std::int64_t>((code >> 1) ^ (0 - (code & 1)));
}

/// Seven bits per byte, lowest first; the top bit says that more follow. At most ten bytes.
inline void put_varint(std::vector<std::byte>& bytes, std::uint64_t value) {
    while (value >= 0x80) {
        bytes.push_back(static_cast<std::byte>(value | 0x80));
        value >>= 7;
    }
    bytes.push_back(static_cast<std::byte>(value));
}

/// Reads varints from bytes that nobody vouches for. Throws std::invalid_argument with the place.
class VarintReader {
  public:
    explicit VarintReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    std::uint64_t next() {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 64; shift += 7) {
            if (at_ == bytes_.size())
                throw std::invalid_argument("trace: ends inside a number, at byte " +
                                            std::to_string(at_));
            const auto byte = std::to_integer<std::uint64_t>(bytes_[at_++]);
            if (shift == 63 && byte > 1)
                break;
            value |= (byte & 0x7f) << shift;
            if (byte < 0x80)
                return value;
        }
        throw std::invalid_argument("trace: number longer than 64 bits before byte " +
                                    std::to_string(at_));
    }
    std::size_t left() const { return bytes_.size() - at_; }

  private:
    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
};

} // namespace tasks
