// SPDX-License-Identifier: GPL-2.0-or-later
// Random numbers of plants: the same from the same seed on every machine and compiler. Realtime-safe.
#pragma once

#include <cstdint>

namespace mw::plants {

/// A Weyl sequence with a mixing function (Steele, Lea, Flood: "Fast splittable pseudorandom number
/// generators", 2014).
class Random {
  public:
    explicit Random(std::uint64_t seed) noexcept : state_(seed) {}

    std::uint64_t next() noexcept {
        state_ += 0x9e3779b97f4a7c15U;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31U);
    }
    /// Uniform in [low, high).
    double real(double low, double high) noexcept {
        constexpr double STEP = 1.0 / 9007199254740992.0;  // 2^-53
        return low + (high - low) * (static_cast<double>(next() >> 11U) * STEP);
    }
    /// Uniform in low..high, both included.
    int whole(int low, int high) noexcept {
        const auto count = static_cast<std::uint64_t>(static_cast<std::int64_t>(high) - low + 1);
        return low + static_cast<int>(next() % count);
    }
    bool chance(double p) noexcept { return real(0, 1) < p; }

  private:
    std::uint64_t state_;
};

}  // namespace mw::plants
