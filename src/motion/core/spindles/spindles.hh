// SPDX-License-Identifier: GPL-2.0-or-later
// Spindles: speed with override and limits, constant surface speed, brake, orientation.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "motion/api/command.hh"
#include "motion/api/settings.hh"
#include "motion/core/io.hh"
#include "motion/core/verdict.hh"

namespace mw::motion {

struct Spindle {
    double speed_rpm = 0, css_factor = 0, css_max_rpm = 0, css_x_offset = 0;
    double scale = 1;
    double out_rpm = 0;
    bool isOn = false, isOverrideEnabled = true, isBrakeOn = false;
    bool isOrienting = false, isLocked = false;
    double orient_angle = 0;
    int orient_mode = 0, orient_state = 0, orient_fault = 0;
};

struct Spindles {
    static constexpr int ORIENT_NONE = 0, ORIENT_IN_PROGRESS = 1, ORIENT_COMPLETE = 2, ORIENT_FAULTED = 3;

    int count = 0;
    std::array<Spindle, MAX_SPINDLES> spindle{};

    Spindle &operator[](int n) noexcept { return spindle[static_cast<std::size_t>(n)]; }
    const Spindle &operator[](int n) const noexcept { return spindle[static_cast<std::size_t>(n)]; }
};

Verdict take(Spindles &spindles, const SpindleOn &command, bool isEnabled) noexcept;
Verdict take(Spindles &spindles, const SpindleOff &command) noexcept;
Verdict take(Spindles &spindles, const SpindleOrient &command, bool isEnabled) noexcept;
Verdict take(Spindles &spindles, const SpindleBrake &command) noexcept;
/// Of one spindle or, with -1, of all.
Verdict take(Spindles &spindles, const SetScale &command) noexcept;
Verdict take(Spindles &spindles, const SetSwitch &command) noexcept;
/// The machine goes off.
void switch_off(Spindles &spindles) noexcept;

/// One cycle; `x` is the commanded machine X, for constant surface speed. Bit per spindle whose orientation
/// has failed in this cycle: `orient_fault` says with what.
std::uint32_t step(Spindles &spindles, const Inputs &in, const Settings &settings, double x) noexcept;

/// Off, or at speed.
bool isReady(const Spindle &spindle, const SpindleInputs &in) noexcept;
void fill(const Spindles &spindles, const Inputs &in, bool isEnabled, Outputs &out) noexcept;

}  // namespace mw::motion
