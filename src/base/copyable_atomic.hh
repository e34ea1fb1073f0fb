// SPDX-License-Identifier: GPL-2.0-or-later
// An atomic inside a structure that is copied as a whole while no thread writes to it.
#pragma once

#include <atomic>

namespace mw {

/// As std::atomic. A copy copies the value and does not order it with other writes.
template <class T>
class CopyableAtomic : public std::atomic<T> {
  public:
    constexpr CopyableAtomic(T value = T{}) noexcept : std::atomic<T>(value) {}
    CopyableAtomic(const CopyableAtomic &other) noexcept
        : std::atomic<T>(other.load(std::memory_order_relaxed)) {}
    CopyableAtomic &operator=(const CopyableAtomic &other) noexcept {
        this->store(other.load(std::memory_order_relaxed), std::memory_order_relaxed);
        return *this;
    }
    using std::atomic<T>::operator=;
};

}  // namespace mw
