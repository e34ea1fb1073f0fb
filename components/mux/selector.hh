// SPDX-License-Identifier: GPL-2.0-or-later
// Selects the input of a multiplexer from a number that must be steady for a time before it counts.
// Realtime-safe.
#pragma once

#include <cstdint>

namespace mw::mux {

class Selector {
  public:
    /// `wanted` is the requested selection and `debounce_us` the time for which it must be stable [us]. With
    /// `skips_zero` a selection of 0 changes nothing. Returns the active selection, below `size`.
    std::uint32_t run(std::uint32_t wanted, std::uint32_t size, std::uint32_t debounce_us, bool skipsZero,
                      std::int64_t period_ns) noexcept {
        is_suppressed_ = skipsZero && wanted == 0;
        if (is_suppressed_) {
            waited_ns_ = 0;
            return bounded(selected_, size);
        }
        if (wanted != wanted_) {
            wanted_ = wanted;
            waited_ns_ = 0;
        } else if (wanted != selected_) {
            waited_ns_ += period_ns;
        }
        if (waited_ns_ >= std::int64_t{debounce_us} * 1000) {
            selected_ = wanted_;
            waited_ns_ = 0;
        }
        return bounded(selected_, size);
    }

    /// False while the output keeps its value: a new selection is being debounced, or a selection of 0 is
    /// skipped.
    bool is_settled() const noexcept { return wanted_ == selected_ && !is_suppressed_; }
    /// The requested selection, without limits.
    std::uint32_t selected() const noexcept { return selected_; }
    std::uint32_t waited_us() const noexcept { return static_cast<std::uint32_t>(waited_ns_ / 1000); }

  private:
    static std::uint32_t bounded(std::uint32_t selection, std::uint32_t size) noexcept {
        return selection < size ? selection : size - 1;
    }

    bool is_suppressed_ = false;
    std::uint32_t wanted_ = 0;
    std::uint32_t selected_ = 0;
    std::int64_t waited_ns_ = 0;
};

/// Two bits choose one of four inputs, one bit one of two; bit 0 is the first.
template <class... Bits>
constexpr unsigned index_of_bits(Bits... bits) noexcept {
    unsigned index = 0;
    unsigned shift = 0;
    ((index |= (bits ? 1U : 0U) << shift++), ...);
    return index;
}

}  // namespace mw::mux
