// SPDX-License-Identifier: GPL-2.0-or-later
// Motion along one coordinate within velocity, acceleration and jerk: changes of speed in the least time.
#pragma once

#include <array>
#include <cstddef>

namespace mw::trajectory {

/// Units of the coordinate per s, s^2 and s^3, all above 0.
struct MotionLimits {
    double velocity = 0, acceleration = 0, jerk = 0;
};

/// The jerk that a motion can use which is steered once in a servo cycle of `dt`: the acceleration turns over
/// some cycles. Steered faster, it would swing between its limits.
inline double usable_jerk(double jerk, double acceleration, double dt) noexcept {
    constexpr double CYCLES = 4;
    const double steered = acceleration / (CYCLES * dt);
    return jerk < steered ? jerk : steered;
}

struct MotionState {
    double x = 0, v = 0, a = 0;

    /// With a constant jerk for the time `t`.
    MotionState after(double jerk, double t) const noexcept {
        return {x + t * (v + t * (0.5 * a + t * jerk / 6.0)), v + t * (a + 0.5 * t * jerk), a + t * jerk};
    }
};

/// Speed after the acceleration has gone to 0 with this jerk.
inline double settled_speed(const MotionState &state, double jerk) noexcept {
    return state.v + 0.5 * state.a * (state.a < 0 ? -state.a : state.a) / jerk;
}

/// The fastest change to another speed, without acceleration at its end: parts of constant jerk.
struct SpeedChange {
    struct Part {
        double jerk = 0, duration = 0;
    };
    static constexpr std::size_t PARTS = 3;
    std::array<Part, PARTS> parts{};
    double duration = 0;
    double distance = 0;
};

/// From the speed and acceleration of `from` to the speed `to_v`. An acceleration above the limit is brought
/// within it first.
SpeedChange speed_change(const MotionState &from, double to_v, double acceleration, double jerk) noexcept;

/// Follows the change for at most `left` [s]; returns the time that is left.
double follow(MotionState &state, const SpeedChange &change, double left) noexcept;

/// The highest value from `low` to `high` for which `is_allowed` holds, where it holds for every lower one;
/// `low` if it holds for none.
template <class IsAllowed>
double highest_allowed(double low, double high, IsAllowed is_allowed) noexcept {
    constexpr int STEPS = 32;  // below the rounding of what is compared
    if (!(low < high) || is_allowed(high)) {
        return low < high ? high : low;
    }
    for (int n = 0; n < STEPS; ++n) {
        const double middle = 0.5 * (low + high);
        (is_allowed(middle) ? low : high) = middle;
    }
    return low;
}

/// A stop that has begun, or another change of speed: followed by its time.
class SpeedChangeRun {
  public:
    void begin(const SpeedChange &change) noexcept {
        change_ = change;
        part_ = 0;
        time_ = 0;
    }
    /// The state `dt` later; true once the change is complete, at its last speed.
    bool advance(MotionState &state, double dt) noexcept;

  private:
    SpeedChange change_;
    std::size_t part_ = SpeedChange::PARTS;
    double time_ = 0;  ///< in the part
};

}  // namespace mw::trajectory
