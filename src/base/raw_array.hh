// SPDX-License-Identifier: GPL-2.0-or-later
// Uninitialised memory for many elements that are written before they are read.
#pragma once

#include <cstddef>
#include <new>
#include <type_traits>

namespace mw {

/// As std::array, but not initialised, so unused elements cost neither time nor physical memory. May be
/// copied as a whole at any time. Holds no pointers, so it may live in shared memory. An element must be
/// written before it is read.
template <class T, std::size_t N>
class RawArray {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

  public:
    RawArray() noexcept {}  // NOLINT(modernize-use-equals-default): a defaulted one would let T{} set all
    RawArray(const RawArray &) = default;
    RawArray &operator=(const RawArray &) = default;

    static constexpr std::size_t size() noexcept { return N; }
    T *data() noexcept { return std::launder(reinterpret_cast<T *>(bytes_)); }
    const T *data() const noexcept { return std::launder(reinterpret_cast<const T *>(bytes_)); }
    T &operator[](std::size_t i) noexcept { return data()[i]; }
    const T &operator[](std::size_t i) const noexcept { return data()[i]; }
    T *begin() noexcept { return data(); }
    T *end() noexcept { return data() + N; }
    const T *begin() const noexcept { return data(); }
    const T *end() const noexcept { return data() + N; }

  private:
    alignas(T) std::byte bytes_[N * sizeof(T)];
};

}  // namespace mw
