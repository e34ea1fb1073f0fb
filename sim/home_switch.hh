// SPDX-License-Identifier: GPL-2.0-or-later
// A simulated home switch with hysteresis, and an index pulse that comes a while after it is asked for.
// Realtime-safe.
#pragma once

namespace mw::sim {

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
    /// True once `isAsked` has been true for `delay` seconds.
    bool run(bool isAsked, double delay, double dt) noexcept {
        waited_ = isAsked ? waited_ + dt : 0.0;
        const bool isDue = isAsked && waited_ >= delay;
        if (isDue) {
            waited_ = 0.0;
        }
        return isDue;
    }

  private:
    double waited_ = 0.0;
};

}  // namespace mw::sim
