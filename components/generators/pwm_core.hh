// SPDX-License-Identifier: GPL-2.0-or-later
// Pulses with a duty cycle, without HAL. Realtime-safe.
#pragma once

#include <cmath>

namespace mw::pwm {

/// One output. `plan` sets the duty cycle; `tick` runs one step of the time base.
class Generator {
  public:
    /// `duty` is 0 to 1. `period_ticks` is the period of the pulses; 0 spreads the pulses (pulse density).
    /// With `dithered` the average over many periods is exact; otherwise each period has the nearest possible
    /// width.
    void plan(double duty, long period_ticks, bool dithered) noexcept {
        duty_ = duty;
        period_ticks_ = period_ticks;
        dithered_ = dithered;
    }

    bool tick() noexcept {
        if (period_ticks_ <= 0) {
            tick_ = 0;
            owed_ += duty_;
            const bool high = owed_ > 0.0;
            owed_ -= high ? 1.0 : 0.0;
            return high;
        }
        if (tick_ >= period_ticks_) {
            tick_ = 0;
        }
        if (tick_ == 0) {
            start_period();
        }
        return tick_++ < high_ticks_;
    }

    /// Sets all outputs low, at the start of a period.
    void stop() noexcept {
        tick_ = 0;
        owed_ = 0.0;
        high_ticks_ = 0;
    }

  private:
    void start_period() noexcept {
        const double wanted = duty_ * static_cast<double>(period_ticks_) + (dithered_ ? owed_ : 0.0);
        high_ticks_ = std::lround(wanted);
        owed_ = dithered_ ? wanted - static_cast<double>(high_ticks_) : 0.0;
    }

    double duty_ = 0.0;
    long period_ticks_ = 0;
    long tick_ = 0;
    long high_ticks_ = 0;
    double owed_ = 0.0;
    bool dithered_ = false;
};

}  // namespace mw::pwm
