// SPDX-License-Identifier: GPL-2.0-or-later
// One coordinate that follows a target which may change at any time, within speed and acceleration.
// Each cycle evaluates the time-optimal profile from the present position and speed, so samples keep the
// limits. AxisTrajectory adds a jerk limit: the mean of such a profile's last samples is commanded.
#pragma once

#include <array>
#include <cstdint>

namespace mw::trajectory {

struct AxisMotion {
    double position = 0;
    double velocity = 0;
    double target = 0;
    double max_velocity = 0;      ///< of this move [unit/s]
    double max_acceleration = 0;  ///< [unit/s^2]

    bool isAtRest() const noexcept { return velocity == 0.0 && position == target; }

    /// Stays at `at`, at rest.
    void reset(double at) noexcept {
        position = at;
        velocity = 0;
        target = at;
        isBraking_ = false;
    }
    /// It is at `at`, by another zero: the target moves by `shift`.
    void renumber(double at, double shift) noexcept {
        position = at;
        target += shift;
        brake_target_ += shift;
    }
    /// Brakes; ends where that leads, which is the target. May be told again and again.
    void stop() noexcept;
    /// Advances by `dt` [s]. [servo]
    void step(double dt) noexcept;

  private:
    void brake(double dt) noexcept;

    /// It brakes with what it has in each cycle, until somebody sends it elsewhere than `brake_target_`.
    bool isBraking_ = false;
    double brake_target_ = 0;
};

/// The same with a jerk limit. A mean over tau swings its acceleration by at most 2 A within tau, whatever
/// the target does, so tau = 2 A / J keeps the limit; the place ends where the leader does, tau later.
class AxisTrajectory : public AxisMotion {
    /// Of the mean; 1: the leader itself is commanded. First: asked in every cycle, with what it derives
    /// from.
    std::uint32_t length_ = 1;

  public:
    /// 0: none. Taken when a move begins at rest. [unit/s^3]
    double max_jerk = 0;
    /// Of the mean of a move that begins at rest; 0: 2 A / J. Who gives it keeps other limits by
    /// `max_acceleration`: J tau / 2 at most. [s]
    double mean_s = 0;

    bool isAtRest() const noexcept { return length_ <= 1 && AxisMotion::isAtRest(); }
    void reset(double at) noexcept {
        AxisMotion::reset(at);
        length_ = 1;
    }
    void stop() noexcept;
    /// Advances by `dt` [s]. [servo]
    void step(double dt) noexcept;
    /// Farthest place where it may come to rest when it brakes after one more step.
    double rest_after(double dt) const noexcept;
    /// What is commanded is its mean of the last samples, or itself.
    const AxisMotion &leader() const noexcept { return length_ > 1 ? leader_ : *this; }
    /// The time of the mean; 0: the leader itself is commanded.
    double mean_in_force_s(double dt) const noexcept { return length_ > 1 ? length_ * dt : 0.0; }
    /// Widens `low` to `high` by where it may come to on its way to the target.
    void add_reach(double &low, double &high) const noexcept;

  private:
    static constexpr std::uint32_t MOST_SAMPLES = 400;
    void begin(double dt) noexcept;
    void add(double x) noexcept;

    AxisMotion leader_;
    std::uint32_t next_ = 0, standing_ = 0;
    double jerk_ = 0, most_acceleration_ = 0, origin_ = 0, sum_ = 0, rest_ = 0;
    std::array<double, MOST_SAMPLES> way_{};  ///< of the leader from origin_, the last samples
};

/// Position that braking at `acceleration` from here leads to.
double stop_position(double position, double velocity, double acceleration) noexcept;

}  // namespace mw::trajectory
