// SPDX-License-Identifier: GPL-2.0-or-later
// A stepper motor with its load: it follows steps within its torque, moves a table with play, and is
// between two end stops. Realtime-safe.
#pragma once

#include <algorithm>
#include <cmath>

namespace mw::plants {

struct StepperSettings {
    double units_per_step = 0.005;             ///< of the table; negative: the other way round
    double backlash = 0;                       ///< [unit]
    double peak_acceleration = 1e9;            ///< torque divided by inertia [unit/s^2]
    double fastest = 1e9;                      ///< speed at which no torque is left [unit/s]
    double lower_end = -1e9, upper_end = 1e9;  ///< where the table hits an end stop [unit]
};

/// The rotor is an inertia in the magnetic field of the steps: it falls out of step when it lags by two full
/// steps.
class StepperAxis {
  public:
    void set(const StepperSettings &settings) noexcept { settings_ = settings; }
    void place(double position) noexcept { rotor_ = field_ = table_ = position; }

    /// Time of `dt` seconds in which the phases are advanced by `steps`.
    void run(int steps, bool powered, double dt) noexcept {
        if (!powered) {
            field_ = rotor_;
            velocity_ = 0;
            return;
        }
        const double step = settings_.units_per_step;
        field_ += steps * step;
        // The rotor follows the field of the steps with a bounded force. Less of it is left at speed, except
        // for braking.
        const double lag = field_ - rotor_;
        const double wanted = (lag / TIME_S - velocity_) / TIME_S;
        const double part = wanted * velocity_ < 0 ? 1.0 : 1 - std::abs(velocity_) / settings_.fastest;
        const double most = settings_.peak_acceleration * std::max(0.0, part);
        velocity_ += std::clamp(wanted, -most, most) * dt;
        rotor_ += velocity_ * dt;
        const double pitch = STEPS_OF_A_PERIOD * std::abs(step);
        if (std::abs(field_ - rotor_) > pitch * LOST_AT) {
            // It has slipped by whole periods of the field.
            field_ -= pitch * std::round((field_ - rotor_) / pitch);
            slipped_ = true;
        }
        hit();
        const double play = settings_.backlash / 2;
        table_ = std::clamp(table_, rotor_ - play, rotor_ + play);
    }

    double table() const noexcept { return table_; }
    bool hasSlipped() const noexcept { return slipped_; }
    bool hasHit() const noexcept { return hit_; }

  private:
    /// Time of the rotor to follow the field [s].
    static constexpr double TIME_S = 0.0005;
    /// Microsteps of one period of the field, and the part of it at which the rotor slips.
    static constexpr double STEPS_OF_A_PERIOD = 64, LOST_AT = 0.5;

    void hit() noexcept {
        const double inside = std::clamp(rotor_, settings_.lower_end, settings_.upper_end);
        if (inside != rotor_) {
            rotor_ = inside;
            velocity_ = 0;
            hit_ = true;
        }
    }

    StepperSettings settings_;
    double field_ = 0, rotor_ = 0, table_ = 0, velocity_ = 0;
    bool slipped_ = false, hit_ = false;
};

}  // namespace mw::plants
