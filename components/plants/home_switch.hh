// SPDX-License-Identifier: GPL-2.0-or-later
// A simulated home switch with hysteresis, and an index pulse that follows some time after the request.
// Realtime-safe.
#pragma once

namespace mw::plants {

class HomeSwitch {
  public:
    /// `position` is that of the axis, `at` that of the switch, and `hysteresis` the distance back that
    /// releases it, in machine units. A switch at a positive position is closed at and past it; a switch at
    /// a negative position is closed at and below it.
    bool run(double position, double at, double hysteresis) noexcept {
        const double direction = at < 0.0 ? -1.0 : 1.0;
        const double beyond = direction * (position - at);
        if (beyond >= 0.0) {
            tripped_ = true;
        } else if (direction * position <= direction * at - hysteresis) {
            tripped_ = false;
        }
        return tripped_;
    }

  private:
    bool tripped_ = false;
};

class DelayedIndex {
  public:
    /// True `delay` seconds after the period in which `requested` became true.
    bool run(bool requested, double delay, double dt) noexcept {
        waited_ = requested && was_asked_ ? waited_ + dt : 0.0;
        const bool due = requested && waited_ >= delay;
        was_asked_ = requested && !due;
        return due;
    }

  private:
    bool was_asked_ = false;
    double waited_ = 0.0;
};

}  // namespace mw::plants
