// SPDX-License-Identifier: GPL-2.0-or-later
// What is added to a joint's position on the way to its motor: play of the drive (backlash) or a table of the
// errors of its screw, taken up within the limits of the joint (C11).
#pragma once

#include <array>
#include <cstdint>

#include "base/raw_array.hh"
#include "motion/interface/command.hh"
#include "motion/interface/settings.hh"
#include "trajectory/follow/axis_motion.hh"

namespace mw::motion {

/// What the motor is moved by at each position, on the way up and on the way down. Linear between points,
/// beyond the ends as at the ends. 240 kB.
struct ScrewTable {
    int count = 0;   ///< of points in force, 0: no table
    int filled = 0;  ///< of points of a table that is not whole yet
    double steepest = 0;
    double widest = 0;  ///< largest difference between the way up and the way down
    RawArray<double, MAX_SCREW_POINTS> nominal, forward, reverse;  ///< the first `filled` of each
};

/// One point more, or the end of the table. A table that is not whole counts for nothing.
Reason take(ScrewTable &table, const LoadCompensation &point) noexcept;

/// At `position` on the way up (`side` > 0) or down (< 0); 0 as long as there is no way (0).
double look_up(const ScrewTable &table, int side, double position) noexcept;

/// Mean of the last samples: what changes its acceleration by at most 2 A has a jerk of at most 2 A over the
/// length of the mean.
class MovingMean {
  public:
    static constexpr std::uint32_t MOST_SAMPLES = 400;

    /// The mean after `x`. Another length is taken when all samples are equal.
    double step(double x, std::uint32_t length) noexcept;
    /// All samples are `x`.
    void reset(double x) noexcept;
    /// All samples become larger.
    void shift(double by) noexcept { origin_ += by; }
    bool isAtRest() const noexcept { return length_ <= 1 || standing_ >= length_; }
    /// Samples of the mean when the next one is to be of `wanted`.
    std::uint32_t length(std::uint32_t wanted) const noexcept {
        return standing_ >= length_ ? wanted : length_;
    }

  private:
    void add(double x) noexcept;

    std::array<double, MOST_SAMPLES> way_{};  ///< from origin_
    double origin_ = 0, sum_ = 0, rest_ = 0, last_ = 0;
    std::uint32_t next_ = 0, length_ = 1;
    std::uint32_t standing_ = MOST_SAMPLES;  ///< samples that were equal, up to here
};

/// What a joint needs in each cycle that has neither lies side by side, between the samples of the mean and
/// the points of the table.
struct Correction {
    double followed = 0, followed_velocity = 0;  ///< before the jerk is limited
    double slide = 0;                            ///< where play has left the slide, by what the motor did
    MovingMean mean;
    int side = 0;                       ///< +1 or -1 once the joint has moved
    bool isHeld = false;                ///< switched on again: what is missing waits until the joint moves
    bool isSlideKnown = false;          ///< play was once taken up since the motor was moved by others
    double position = 0, velocity = 0;  ///< what is added
    double raw = 0;                     ///< what is to be added
    double extreme = 0;                 ///< the farthest place since the joint has turned back last
    double last_position = 0;           ///< of the joint
    /// Backlash: what is added. Table: what is still missing, beside what the table says.
    trajectory::AxisMotion follower;
    ScrewTable table;

    bool isAtRest() const noexcept { return follower.isAtRest() && velocity == 0.0 && mean.isAtRest(); }
};

/// No play, no table, and nothing left to take back: a joint so only remembers which way it goes.
inline bool isIdle(const Correction &c, double backlash) noexcept {
    return backlash == 0.0 && c.table.count == 0 && !c.isHeld && c.position == 0.0 && c.isAtRest();
}
/// The side changes where the joint really turns back, not by the rounding of a stop.
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
/// One cycle of a joint that isIdle.
inline void follow_idle(Correction &c, double position) noexcept {
    follow_side(c, position);
    c.raw = 0;
    c.last_position = position;
}
/// One cycle of a joint that is to be at `position`.
void step(Correction &correction, const Settings &settings, int joint, double position,
          double period_s) noexcept;
/// While the machine is off: what the table says where the motor is moved to by others.
void follow(Correction &correction, double position) noexcept;
/// The joint's position is `position` from here, and the motor stays. What is added grows by what is
/// returned.
double renumber(Correction &correction, double position) noexcept;
/// Nothing is added; what was is returned.
double clear(Correction &correction) noexcept;

}  // namespace mw::motion
