// SPDX-License-Identifier: GPL-2.0-or-later
// A stepper motor with its load: it follows steps within its torque, moves a table with play, and is
// between two end stops. Realtime-safe.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mw::plants {

struct StepperSettings {
    double units_per_step = 0.005;    ///< of the table; a negative value reverses the direction
    double backlash = 0;              ///< [unit]
    double peak_acceleration = 5000;  ///< pull-out torque at standstill, divided by inertia [unit/s^2]
    double fastest = 500;             ///< speed at which the pull-out torque is zero [unit/s]
    double lower_end = -1e9, upper_end = 1e9;  ///< position of the end stops [unit]
    double microsteps = 4;                     ///< steps of the drive for a full step of the motor
};

/// The rotor is an inertia in the field of the steps. The torque of the field is a sine of the lag with a
/// period of four full steps. Its amplitude decreases with speed, because the inductance of the windings
/// reduces the current. This applies to driving and braking. Drag (friction and iron losses) is part of the
/// data sheet's pull-out torque: it reduces a driving torque and increases a braking torque. So pull-out is
/// T(v) = T0 (1 - v / fastest) when driving, and T(v) + 2 drag when braking, not T0. At a lag of more than
/// two full steps the torque reverses: the rotor loses synchronism, the torque averages to zero, and drag
/// stops it. Source: Kenjo and Sugawara, Stepping Motors and their Microprocessor Controls, 1994, chapter 4.
class StepperAxis {
  public:
    void set(const StepperSettings &settings) noexcept { settings_ = settings; }
    void place(double position) noexcept {
        rotor_ = field_ = table_ = position;
        velocity_ = slip_velocity_ = 0;
    }

    /// Time of `dt` seconds in which the phases are advanced by `steps`.
    void run(int steps, bool powered, double dt) noexcept {
        const double advance = steps * settings_.units_per_step;
        field_ += advance;
        slip_velocity_ += (advance / dt - velocity_ - slip_velocity_) * std::min(1.0, dt / SMOOTHING_S);
        const double pitch =
            FULL_STEPS_OF_A_PERIOD * settings_.microsteps * std::abs(settings_.units_per_step);
        if (powered) {
            turn(pitch, dt);
        } else {
            field_ = rotor_;
            velocity_ = slip_velocity_ = 0;
        }
        hit();
        const double play = settings_.backlash / 2;
        table_ = std::clamp(table_, rotor_ - play, rotor_ + play);
    }

    double table() const noexcept { return table_; }
    bool hasSlipped() const noexcept { return slipped_; }
    bool hasHit() const noexcept { return hit_; }

  private:
    static constexpr double FULL_STEPS_OF_A_PERIOD = 4;
    /// Drag as a part of the pull-out torque at standstill.
    static constexpr double DRAG_PART = 0.1;
    /// Damping ratio of the rotor in its field, and the time in which their relative speed is averaged [s].
    static constexpr double DAMPING = 0.25, SMOOTHING_S = 0.0005;

    void turn(double pitch, double dt) noexcept {
        const double peak = settings_.peak_acceleration, drag = DRAG_PART * peak;
        const double amplitude = peak * std::max(0.0, 1 - std::abs(velocity_) / settings_.fastest) + drag;
        const double per_unit = 2 * std::numbers::pi / pitch;
        const double lag = field_ - rotor_;
        const double stiffness = amplitude * std::cos(lag * per_unit) * per_unit;
        const double damping = 2 * DAMPING * std::sqrt(peak * per_unit);
        // The implicit step is stable for any stiffness. The torque, including damping, is limited to the
        // amplitude.
        const double torque =
            amplitude * std::sin(lag * per_unit) + damping * slip_velocity_ - stiffness * velocity_ * dt;
        const double driving =
            std::clamp(torque / (1 + (damping + std::max(0.0, stiffness) * dt) * dt), -amplitude, amplitude);
        velocity_ += driving * dt;
        // Drag stops the rotor and does not reverse it.
        velocity_ -= std::clamp(velocity_, -drag * dt, drag * dt);
        rotor_ += velocity_ * dt;
        if (std::abs(field_ - rotor_) > pitch / 2) {
            field_ -= pitch * std::round((field_ - rotor_) / pitch);
            slipped_ = true;
        }
    }

    void hit() noexcept {
        const double inside = std::clamp(rotor_, settings_.lower_end, settings_.upper_end);
        if (inside != rotor_) {
            rotor_ = inside;
            velocity_ = 0;
            hit_ = true;
        }
    }

    StepperSettings settings_;
    double field_ = 0, rotor_ = 0, table_ = 0, velocity_ = 0, slip_velocity_ = 0;
    bool slipped_ = false, hit_ = false;
};

}  // namespace mw::plants
