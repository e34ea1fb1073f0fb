// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace mw::mesa {

/// Bytes in the order of their arrival, without allocation. One thread uses it.
template <std::size_t CAPACITY>
class ByteQueue {
  public:
    std::size_t size() const noexcept { return size_; }
    std::size_t space() const noexcept { return CAPACITY - size_; }
    void clear() noexcept { size_ = 0; }

    /// Adds all bytes, or none if there is not enough space.
    bool push(std::span<const std::uint8_t> bytes) noexcept {
        if (bytes.size() > space()) {
            return false;
        }
        for (const std::uint8_t byte : bytes) {
            bytes_[(first_ + size_) % CAPACITY] = byte;
            ++size_;
        }
        return true;
    }
    /// Removes the oldest bytes; returns their number.
    std::size_t pop(std::span<std::uint8_t> bytes) noexcept {
        std::size_t count = 0;
        for (; count < bytes.size() && size_ > 0; ++count) {
            bytes[count] = bytes_[first_];
            first_ = (first_ + 1) % CAPACITY;
            --size_;
        }
        return count;
    }

  private:
    std::array<std::uint8_t, CAPACITY> bytes_{};
    std::size_t first_ = 0, size_ = 0;
};

/// A word with the first byte in its low bits.
inline std::uint32_t word_of(std::span<const std::uint8_t> bytes) noexcept {
    std::uint32_t word = 0;
    unsigned shift = 0;
    for (const std::uint8_t byte : bytes) {
        word |= std::uint32_t{byte} << shift;
        shift += 8;
    }
    return word;
}
inline std::array<std::uint8_t, 4> bytes_of(std::uint32_t word) noexcept {
    return {static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8U),
            static_cast<std::uint8_t>(word >> 16U), static_cast<std::uint8_t>(word >> 24U)};
}

}  // namespace mw::mesa
