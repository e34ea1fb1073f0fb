// SPDX-License-Identifier: GPL-2.0-or-later
// Corrections between a joint's position and its motor: backlash, or a table of the errors of its screw,
// applied within the limits of the joint.
#pragma once

#include <array>
#include <cstdint>

#include "base/raw_array.hh"
#include "motion/interface/command.hh"
#include "motion/interface/settings.hh"
#include "trajectory/follow/axis_motion.hh"

namespace mw::motion {

/// Correction of the motor position for travel up and down. Linear between points, constant outside the ends.
/// 240 kB.
struct ScrewTable {
    int count = 0;   ///< points of the active table, 0: no table
    int filled = 0;  ///< of points of an incomplete table
    double steepest = 0;
    double widest = 0;  ///< largest difference between forward and reverse
    RawArray<double, MAX_SCREW_POINTS> nominal, forward, reverse;  ///< the first `filled` of each
};

/// Adds a point, or ends the table. An incomplete table has no effect.
Reason take(ScrewTable &table, const LoadCompensation &point) noexcept;

/// At `position` for forward (`side` > 0) or reverse travel (< 0); 0 without a direction (0).
double look_up(const ScrewTable &table, int side, double position) noexcept;

/// Average of the last samples: a signal that changes its acceleration by at most 2 A has a jerk of at most 2
/// A over the averaging time.
class MovingMean {
  public:
    static constexpr std::uint32_t MOST_SAMPLES = 400;

    /// The average after `x`. A new length takes effect when all samples are equal.
    double step(double x, std::uint32_t length) noexcept;
    /// All samples are `x`.
    void reset(double x) noexcept;
    /// Shifts all samples.
    void shift(double by) noexcept { origin_ += by; }
    bool isAtRest() const noexcept { return length_ <= 1 || standing_ >= length_; }
    /// Length of the average when the next one is to have `wanted` samples.
    std::uint32_t length(std::uint32_t wanted) const noexcept {
        return standing_ >= length_ ? wanted : length_;
    }

  private:
    void add(double x) noexcept;

    std::array<double, MOST_SAMPLES> way_{};  ///< from origin_
    double origin_ = 0, sum_ = 0, rest_ = 0, last_ = 0;
    std::uint32_t next_ = 0, length_ = 1;
    std::uint32_t standing_ = MOST_SAMPLES;  ///< number of equal samples at the end
};

/// Members that each cycle reads of a joint without corrections lie together, between the samples of the
/// average and the points of the table.
struct Correction {
    double followed = 0, followed_velocity = 0;  ///< before the jerk is limited
    double slide = 0;  ///< position of the slide within the backlash, from the motor
    MovingMean mean;
    int side = 0;               ///< +1 or -1 once the joint has moved
    bool isHeld = false;        ///< switched on again: the missing correction waits until the joint moves
    bool isSlideKnown = false;  ///< backlash was compensated since the motor was last moved by others
    double position = 0, velocity = 0;  ///< current correction
    double raw = 0;                     ///< correction to reach
    double extreme = 0;                 ///< extreme position since the last reversal of the joint
    double last_position = 0;           ///< of the joint
    /// Backlash: the correction. Table: the part of the correction that is still missing.
    trajectory::AxisMotion follower;
    ScrewTable table;

    bool isAtRest() const noexcept { return follower.isAtRest() && velocity == 0.0 && mean.isAtRest(); }
};

/// No backlash, no table and no correction left: the joint only records its direction.
inline bool isIdle(const Correction &c, double backlash) noexcept {
    return backlash == 0.0 && c.table.count == 0 && !c.isHeld && c.position == 0.0 && c.isAtRest();
}
/// The side changes when the joint reverses, not by the rounding of a stop.
inline constexpr double TURN_ROUNDING = 1e-9;
inline void follow_side(Correction &c, double position) noexcept {
    const double moved = position - c.extreme;
    const bool isMove = std::abs(moved) > TURN_ROUNDING * (1.0 + std::abs(position));
    const bool isOnward = c.side != 0 && moved * c.side > 0;
    if (isMove) {
        c.side = moved > 0 ? 1 : -1;
    }
    c.extreme = isMove || isOnward ? position : c.extreme;
}
/// One cycle of a joint for which isIdle is true.
inline void follow_idle(Correction &c, double position) noexcept {
    follow_side(c, position);
    c.raw = 0;
    c.last_position = position;
}
/// One cycle of a joint at `position`.
void step(Correction &correction, const Settings &settings, int joint, double position,
          double period_s) noexcept;
/// While the machine is off: the correction of the table where the motor is moved by others.
void follow(Correction &correction, double position) noexcept;
/// Changes the joint's position to `position` without motion of the motor. The correction grows by the
/// returned value.
double renumber(Correction &correction, double position) noexcept;
/// Removes the correction and returns it.
double clear(Correction &correction) noexcept;

}  // namespace mw::motion
