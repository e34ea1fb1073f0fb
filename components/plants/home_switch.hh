// SPDX-License-Identifier: GPL-2.0-or-later
// A simulated home switch with hysteresis, and an index pulse that comes a while after it is asked for.
// Realtime-safe.
#pragma once

namespace mw::plants {

class HomeSwitch {
  public:
    /// `position` of the axis and of the switch `at`, and the way back that releases it, in machine units.
    /// A switch at a positive position is tripped at and beyond it, one at a negative position at and below
    /// it.
    bool run(double position, double at, double hysteresis) noexcept {
        const double direction = at < 0.0 ? -1.0 : 1.0;
        const double beyond = direction * (position - at);
        if (beyond >= 0.0) {
            isTripped_ = true;
        } else if (direction * position <= direction * at - hysteresis) {
            isTripped_ = false;
        }
        return isTripped_;
    }

  private:
    bool isTripped_ = false;
};

class DelayedIndex {
  public:
    /// True `delay` seconds after the period in which `isAsked` became true.
    bool run(bool isAsked, double delay, double dt) noexcept {
        waited_ = isAsked && was_asked_ ? waited_ + dt : 0.0;
        const bool isDue = isAsked && waited_ >= delay;
        was_asked_ = isAsked && !isDue;
        return isDue;
    }

  private:
    bool was_asked_ = false;
    double waited_ = 0.0;
};

}  // namespace mw::plants
