// SPDX-License-Identifier: GPL-2.0-or-later
// Pulses with a duty cycle, without HAL. Realtime-safe.
#pragma once

#include <cmath>

namespace mw::pwm {

/// One output. `plan` sets the duty cycle, `tick` is one step of the time base.
class Generator {
  public:
    /// `duty` 0 to 1; `period_ticks` 0 spreads the pulses (pulse density), else it is the period of the
    /// pulses. With `isDithered` the mean over many periods is exact, else each period is the nearest
    /// possible.
    void plan(double duty, long period_ticks, bool isDithered) noexcept {
        duty_ = duty;
        period_ticks_ = period_ticks;
        isDithered_ = isDithered;
    }

    bool tick() noexcept {
        if (period_ticks_ <= 0) {
            tick_ = 0;
            owed_ += duty_;
            const bool isHigh = owed_ > 0.0;
            owed_ -= isHigh ? 1.0 : 0.0;
            return isHigh;
        }
        if (tick_ >= period_ticks_) {
            tick_ = 0;
        }
        if (tick_ == 0) {
            start_period();
        }
        return tick_++ < high_ticks_;
    }

    /// All low, at the beginning of a period.
    void stop() noexcept {
        tick_ = 0;
        owed_ = 0.0;
        high_ticks_ = 0;
    }

  private:
    void start_period() noexcept {
        const double wanted = duty_ * static_cast<double>(period_ticks_) + (isDithered_ ? owed_ : 0.0);
        high_ticks_ = std::lround(wanted);
        owed_ = isDithered_ ? wanted - static_cast<double>(high_ticks_) : 0.0;
    }

    double duty_ = 0.0;
    long period_ticks_ = 0;
    long tick_ = 0;
    long high_ticks_ = 0;
    double owed_ = 0.0;
    bool isDithered_ = false;
};

}  // namespace mw::pwm
