// SPDX-License-Identifier: GPL-2.0-or-later
// A motor with its load under a servo drive that follows positions: inertia, friction, a bounded torque, and
// play between motor and load. Realtime-safe.
#pragma once

#include <algorithm>
#include <cmath>

namespace mw::plants {

/// All forces are divided by the moving mass, so they are accelerations.
struct AxisSettings {
    double peak_acceleration = 1e5;  ///< torque of the drive over the inertia [unit/s^2]
    double coulomb_friction = 0;     ///< against every motion [unit/s^2]
    double viscous_friction = 0;     ///< [1/s]
    double backlash = 0;             ///< play between motor and load [unit]
    double position_gain = 300;      ///< of the drive [1/s]
    double velocity_gain = 1500;     ///< of the drive [1/s]; at most 1 / step
};

class Axis {
  public:
    explicit Axis(const AxisSettings &settings = {}, double position = 0) noexcept
        : settings_(settings), motor_(position), load_(position), last_command_(position) {}

    /// Other forces, friction and play from here on; what is no number stays as it was.
    void set(const AxisSettings &settings) noexcept {
        for (double AxisSettings::*const one :
             {&AxisSettings::peak_acceleration, &AxisSettings::coulomb_friction,
              &AxisSettings::viscous_friction, &AxisSettings::backlash, &AxisSettings::position_gain,
              &AxisSettings::velocity_gain}) {
            settings_.*one = std::isfinite(settings.*one) ? settings.*one : settings_.*one;
        }
    }
    /// `dt` seconds towards `command`; one that is no number, or beyond what the steps can be reckoned with,
    /// is none. Without power only friction acts.
    void run(double command, bool isPowered, double dt) noexcept {
        const bool isNumber = std::abs(command) < FARTHEST;
        const double feed = isNumber ? (command - last_command_) / dt : 0.0;
        const double target = isNumber ? command : last_command_;
        const double from = last_command_;
        last_command_ = target;
        const double step = dt / STEPS;
        for (int i = 0; i < STEPS; ++i) {
            // The drive fills in between the commands of the servo cycle.
            const double wanted = from + (target - from) * i / STEPS;
            const double speed = feed + settings_.position_gain * (wanted - motor_);
            const double torque = isPowered ? settings_.velocity_gain * (speed - velocity_) : 0.0;
            const double most = settings_.peak_acceleration;
            move(std::clamp(torque, -most, most), step);
        }
        const double play = 0.5 * settings_.backlash;
        load_ = std::clamp(load_, motor_ - play, motor_ + play);
    }
    /// Switched on again: the drive begins where the motor stands.
    void hold_here() noexcept { last_command_ = motor_; }

    /// Without power: somebody turns it to `position`, where it stands.
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
        // Friction holds what does not move, and never turns a motion round.
        const double hold = settings_.coulomb_friction;
        if (velocity_ == 0.0) {
            force = std::abs(force) <= hold ? 0.0 : force - std::copysign(hold, force);
            velocity_ += force * step;
        } else {
            const double next = velocity_ + (force - std::copysign(hold, velocity_)) * step;
            const bool isTurning = next * velocity_ < 0.0;
            velocity_ = isTurning && std::abs(force) <= hold ? 0.0 : next;
        }
        motor_ += velocity_ * step;
    }

    AxisSettings settings_;
    double motor_, load_;
    double velocity_ = 0;
    double last_command_;
};

}  // namespace mw::plants
