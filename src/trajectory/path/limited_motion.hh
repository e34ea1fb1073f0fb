// SPDX-License-Identifier: GPL-2.0-or-later
// Motion of one coordinate within velocity, acceleration and jerk: fastest changes of speed.
#pragma once

#include <array>
#include <cstddef>

namespace mw::trajectory {

/// Limits in units of the coordinate per s, s^2 and s^3, all above 0.
struct MotionLimits {
    double velocity = 0, acceleration = 0, jerk = 0;
};

/// Usable jerk [unit/s^3] of a motion that is controlled once per servo cycle of `dt` [s]. The acceleration
/// then takes several cycles to reach its limit. With more jerk it would oscillate between its limits.
inline double usable_jerk(double jerk, double acceleration, double dt) noexcept {
    constexpr double CYCLES = 4;
    const double steered = acceleration / (CYCLES * dt);
    return jerk < steered ? jerk : steered;
}

struct MotionState {
    double x = 0, v = 0, a = 0;

    /// State after the time `t` [s] with constant jerk.
    MotionState after(double jerk, double t) const noexcept {
        return {x + t * (v + t * (0.5 * a + t * jerk / 6.0)), v + t * (a + 0.5 * t * jerk), a + t * jerk};
    }
};

/// Speed after the acceleration has gone to 0 with this jerk.
inline double settled_speed(const MotionState &state, double jerk) noexcept {
    return state.v + 0.5 * state.a * (state.a < 0 ? -state.a : state.a) / jerk;
}

/// The fastest change to another speed, with acceleration 0 at its end. It has parts of constant jerk.
struct SpeedChange {
    struct Part {
        double jerk = 0, duration = 0;
    };
    static constexpr std::size_t PARTS = 3;
    std::array<Part, PARTS> parts{};
    double duration = 0;
    double distance = 0;
};

/// Change from the speed and acceleration of `from` to the speed `to_v`. If the acceleration exceeds its
/// limit, it is reduced to the limit first.
SpeedChange speed_change(const MotionState &from, double to_v, double acceleration, double jerk) noexcept;

/// Follows the change for at most `left` [s]. Returns the rest of this time, 0 if the change is not complete.
double follow(MotionState &state, const SpeedChange &change, double left) noexcept;

/// Largest value between `low` and `high` that is_allowed accepts, or `low` if it accepts none. If it accepts
/// a value, it must accept every lower one.
template <class IsAllowed>
double highest_allowed(double low, double high, IsAllowed is_allowed) noexcept {
    constexpr int STEPS = 32;  // the result is then exact to rounding
    if (!(low < high) || is_allowed(high)) {
        return low < high ? high : low;
    }
    for (int n = 0; n < STEPS; ++n) {
        const double middle = 0.5 * (low + high);
        (is_allowed(middle) ? low : high) = middle;
    }
    return low;
}

/// Follows a change of speed over several servo cycles.
class SpeedChangeRun {
  public:
    void begin(const SpeedChange &change) noexcept {
        change_ = change;
        part_ = 0;
        time_ = 0;
    }
    /// Advances `state` by `dt` [s]. True when the change is complete; the state then has the final speed.
    bool advance(MotionState &state, double dt) noexcept;

  private:
    SpeedChange change_;
    std::size_t part_ = SpeedChange::PARTS;
    double time_ = 0;  ///< time in the current part [s]
};

}  // namespace mw::trajectory
