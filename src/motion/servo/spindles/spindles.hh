// SPDX-License-Identifier: GPL-2.0-or-later
// Spindles: speed with override and limits, constant surface speed, brake, orientation, reversal for a tap.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "motion/interface/command.hh"
#include "motion/interface/settings.hh"
#include "motion/servo/command_result.hh"
#include "motion/servo/io.hh"
#include "motion/servo/spindles/spindle_reversal.hh"

namespace mw::motion {

struct Spindle {
    double speed_rpm = 0, css_factor = 0, css_max_rpm = 0, css_x_offset = 0;
    double scale = 1;
    double out_rpm = 0;
    double commanded_rpm = 0;  ///< within the limits of the spindle, before the override
    double turns = 0;          ///< last valid count
    double speed_rps = 0;      ///< measured; 0 while the pin is not a number
    bool isOn = false, isOverrideEnabled = true, isBrakeOn = true;
    bool isOrienting = false, isLocked = false;
    double orient_angle = 0;
    int orient_mode = 0, orient_state = 0, orient_fault = 0;
    double tap_factor = 1;  ///< factor of the speed during a tap
    double tap_scale = 1;   ///< override at the start of the tap
    bool isTapping = false;
    SpindleReversal reversal;
};

/// Request of an active tap to its spindle.
struct TapTurning {
    int spindle = -1;   ///< -1: no tap is active
    double factor = 1;  ///< factor of the speed at which the spindle was started; 0: off, and it does not
                        ///< switch itself on
};

/// State of a spindle from its counts.
struct CountedSpindle {
    double turns_per_s = 0;
    double step = 0;  ///< of its encoder [turns]
};

struct SpindleCycle {
    double x = 0;  ///< commanded machine X, for constant surface speed
    TapTurning tap;
    double period_s = 1e-3;
    std::array<CountedSpindle, MAX_SPINDLES> counted{};
};
/// True if the spindle may run in both directions.
bool isReversible(const Settings &settings, int n) noexcept;
/// Off, or at speed.
bool isReady(const Spindle &spindle, const SpindleInputs &in) noexcept;

class Spindles {
  public:
    static constexpr int ORIENT_NONE = 0, ORIENT_IN_PROGRESS = 1, ORIENT_COMPLETE = 2, ORIENT_FAULTED = 3;

    explicit Spindles(int count) noexcept : count_(count) {}

    CommandResult take(const SpindleOn &command, bool isEnabled) noexcept;
    CommandResult take(const SpindleOff &command) noexcept;
    CommandResult take(const SpindleOrient &command, bool isEnabled) noexcept;
    CommandResult take(const SpindleBrake &command) noexcept;
    /// Sets the override of one spindle or, with -1, of all.
    CommandResult take(const SetScale &command) noexcept;
    CommandResult take(const SetSwitch &command) noexcept;
    /// The machine goes off.
    void switch_off() noexcept;

    /// Reads the pins of the spindles. Returns a bit per spindle whose feedback is not a number.
    std::uint32_t read_feedback(const Inputs &in) noexcept;
    /// One cycle. Returns a bit per spindle whose orientation failed in it; `orient_fault` has the code.
    std::uint32_t step(const Inputs &in, const Settings &settings, const SpindleCycle &cycle) noexcept;

    const Spindle &operator[](int n) const noexcept { return spindle_[static_cast<std::size_t>(n)]; }
    /// The way a spindle stops after a command to reverse.
    trajectory::SpindleBrakings brakings(int n, const Settings &settings) const noexcept;
    void fill(const Inputs &in, bool isEnabled, Outputs &out) const noexcept;

  private:
    bool hasSpindle(int n) const noexcept { return n >= 0 && n < count_; }
    Spindle &at(int n) noexcept { return spindle_[static_cast<std::size_t>(n)]; }

    int count_;
    std::array<Spindle, MAX_SPINDLES> spindle_{};
};

}  // namespace mw::motion
