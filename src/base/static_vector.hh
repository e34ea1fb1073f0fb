// SPDX-License-Identifier: GPL-2.0-or-later
// A vector with storage inside the object, for realtime code: bounded, never allocates, trivially copyable
// when T is.
#pragma once

#include <array>
#include <cstddef>

namespace mw {

template <class T, std::size_t N>
class StaticVector {
  public:
    /// Appends the value; false (and no change) when full.
    constexpr bool push_back(const T &value) noexcept {
        if (size_ == N) {
            return false;
        }
        items_[size_++] = value;
        return true;
    }
    constexpr void pop_back() noexcept { --size_; }
    constexpr void clear() noexcept { size_ = 0; }
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr bool empty() const noexcept { return size_ == 0; }
    static constexpr std::size_t capacity() noexcept { return N; }
    constexpr T &operator[](std::size_t i) noexcept { return items_[i]; }
    constexpr const T &operator[](std::size_t i) const noexcept { return items_[i]; }
    constexpr T &back() noexcept { return items_[size_ - 1]; }
    constexpr const T &back() const noexcept { return items_[size_ - 1]; }
    constexpr T *begin() noexcept { return items_.data(); }
    constexpr T *end() noexcept { return items_.data() + size_; }
    constexpr const T *begin() const noexcept { return items_.data(); }
    constexpr const T *end() const noexcept { return items_.data() + size_; }

  private:
    std::array<T, N> items_{};
    std::size_t size_ = 0;
};

}  // namespace mw
