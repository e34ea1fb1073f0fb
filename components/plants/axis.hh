// SPDX-License-Identifier: GPL-2.0-or-later
// A motor with its load under a servo drive that follows positions: inertia, friction, a bounded torque, and
// backlash between motor and load. Realtime-safe.
#pragma once

#include <algorithm>
#include <cmath>

namespace mw::plants {

/// All forces are divided by the moving mass, so they are accelerations.
struct AxisSettings {
    double peak_acceleration = 1e5;  ///< torque of the drive divided by the inertia [unit/s^2]
    double coulomb_friction = 0;     ///< against any motion [unit/s^2]
    double viscous_friction = 0;     ///< [1/s]
    double backlash = 0;             ///< play between motor and load [unit]
    double position_gain = 300;      ///< of the drive [1/s]
    double velocity_gain = 1500;     ///< of the drive [1/s]; at most 1 / step
};

class Axis {
  public:
    explicit Axis(const AxisSettings &settings = {}, double position = 0) noexcept
        : settings_(settings), motor_(position), load_(position), last_command_(position) {}

    /// Sets new forces, friction and play; a value that is not a number is ignored.
    void set(const AxisSettings &settings) noexcept {
        for (double AxisSettings::*const one :
             {&AxisSettings::peak_acceleration, &AxisSettings::coulomb_friction,
              &AxisSettings::viscous_friction, &AxisSettings::backlash, &AxisSettings::position_gain,
              &AxisSettings::velocity_gain}) {
            settings_.*one = std::isfinite(settings.*one) ? settings.*one : settings_.*one;
        }
    }
    /// Moves for `dt` seconds towards `command`. A command that is not a number, or too large for the steps,
    /// is ignored. Without power only friction acts.
    void run(double command, bool powered, double dt) noexcept {
        const bool is_number = std::abs(command) < FARTHEST;
        const double feed = is_number ? (command - last_command_) / dt : 0.0;
        const double target = is_number ? command : last_command_;
        const double from = last_command_;
        last_command_ = target;
        const double step = dt / STEPS;
        for (int i = 0; i < STEPS; ++i) {
            // The drive interpolates between the commands of the servo cycle.
            const double wanted = from + (target - from) * i / STEPS;
            const double speed = feed + settings_.position_gain * (wanted - motor_);
            const double torque = powered ? settings_.velocity_gain * (speed - velocity_) : 0.0;
            const double most = settings_.peak_acceleration;
            move(std::clamp(torque, -most, most), step);
        }
        const double play = 0.5 * settings_.backlash;
        load_ = std::clamp(load_, motor_ - play, motor_ + play);
    }
    /// After the power is switched on again, the drive starts at the position of the motor.
    void hold_here() noexcept { last_command_ = motor_; }

    /// Without power: moves the motor to `position` by hand; it then stops.
    void turn_by_hand(double position) noexcept {
        motor_ = position;
        velocity_ = 0;
        last_command_ = position;
    }

    double motor() const noexcept { return motor_; }
    double load() const noexcept { return load_; }
    double velocity() const noexcept { return velocity_; }

  private:
    static constexpr int STEPS = 4;
    static constexpr double FARTHEST = 1e100;

    void move(double force, double step) noexcept {
        force -= settings_.viscous_friction * velocity_;
        // Friction holds an axis at standstill, and never reverses a motion.
        const double hold = settings_.coulomb_friction;
        if (velocity_ == 0.0) {
            force = std::abs(force) <= hold ? 0.0 : force - std::copysign(hold, force);
            velocity_ += force * step;
        } else {
            const double next = velocity_ + (force - std::copysign(hold, velocity_)) * step;
            const bool turning = next * velocity_ < 0.0;
            velocity_ = turning && std::abs(force) <= hold ? 0.0 : next;
        }
        motor_ += velocity_ * step;
    }

    AxisSettings settings_;
    double motor_, load_;
    double velocity_ = 0;
    double last_command_;
};

}  // namespace mw::plants
