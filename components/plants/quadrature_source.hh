// SPDX-License-Identifier: GPL-2.0-or-later
// A simulated incremental encoder: turns a speed into phases A and B and an index pulse. Realtime-safe.
#pragma once

#include <cmath>
#include <cstdint>

namespace mw::plants {

class QuadratureSource {
  public:
    /// `counts_per_second` and `counts_per_turn` (four counts per pulse) apply until the next call. A speed
    /// that is not a number counts as 0.
    void set_speed(double counts_per_second, std::int32_t counts_per_turn) noexcept {
        counts_per_second_ = std::isnan(counts_per_second) ? 0.0 : counts_per_second;
        counts_per_turn_ = counts_per_turn > 0 ? counts_per_turn : 1;
    }

    /// One pulse period of `dt` seconds. At most one count, because a real edge cannot be skipped.
    void run(double dt) noexcept {
        double step = counts_per_second_ * dt;
        step = step > 1.0 ? 1.0 : (step < -1.0 ? -1.0 : step);
        fraction_ += step;
        // Sums of binary fractions end slightly below whole counts; such a small difference must not cost a
        // period.
        constexpr double HAIR = 1e-9;
        if (fraction_ >= 1.0 - HAIR) {
            fraction_ -= 1.0;
            move(1);
        } else if (fraction_ < -HAIR) {
            fraction_ += 1.0;
            move(-1);
        }
    }

    bool phase_a() const noexcept { return (counts_ & 3) < 2; }
    bool phase_b() const noexcept { return (counts_ & 3) == 1 || (counts_ & 3) == 2; }
    /// True for one count per turn.
    bool index() const noexcept { return in_turn_ == 0; }
    std::int32_t counts() const noexcept { return counts_; }

  private:
    void move(std::int32_t by) noexcept {
        counts_ =
            static_cast<std::int32_t>(static_cast<std::uint32_t>(counts_) + static_cast<std::uint32_t>(by));
        in_turn_ += by;
        if (in_turn_ >= counts_per_turn_) {
            in_turn_ = 0;
        } else if (in_turn_ < 0) {
            in_turn_ = counts_per_turn_ - 1;
        }
    }

    double counts_per_second_ = 0.0;
    std::int32_t counts_per_turn_ = 400;
    double fraction_ = 0.0;
    std::int32_t counts_ = 0;
    std::int32_t in_turn_ = 0;
};

}  // namespace mw::plants
