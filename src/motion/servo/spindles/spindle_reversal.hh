// SPDX-License-Identifier: GPL-2.0-or-later
// The reversal of a spindle, learned from earlier reversals, so that a tap can command it in time.
#pragma once

#include <cstdint>

#include "trajectory/path/spindle_braking.hh"

namespace mw::motion {

/// Commanded speed and encoder values of a spindle in a servo cycle.
struct SpindleMotion {
    double wanted = 0;  ///< [turns/s]
    double turns = 0;
    double speed = 0;  ///< from the counts, signed [turns/s]
    double step = 0;   ///< of the encoder [turns]
    double period_s = 1e-3;
    double shown_speed = 0;  ///< from the pin: may be late or unsigned, but smooth [turns/s]
};

/// Delay and ramp are learned from each reversal at steady speed; before the first one, from the start of the
/// spindle.
struct SpindleReversal {
    enum class Watching : std::uint8_t { NOTHING, REVERSAL, START };
    trajectory::SpindleBrakings learned{};
    trajectory::SpindleBraking guessed;  ///< from a start
    Watching watching = Watching::NOTHING;
    double wanted = 0;      ///< commanded speed of the last cycle [turns/s]
    double from_turns = 0;  ///< at the command
    double speed = 0;       ///< speed at the command to reverse; for a start, the commanded speed [turns/s]
    double direction = 1;   ///< direction of the counts at the command to reverse
    double farthest = 0;    ///< counted in that direction
    double arrived_s = 0;   ///< time after the command at which the count reached it
    double left_s = 0;      ///< time at which it was last there
    double quarter_s = 0;   ///< for a start: time at which a quarter of the speed was reached
    double seconds = 0;     ///< since the command
};

void watch(SpindleReversal &reversal, const SpindleMotion &now) noexcept;
/// `given_ramp`: value from the INI file [turns/s^2], 0 for none.
trajectory::SpindleBrakings brakings_of(const SpindleReversal &reversal, double given_ramp) noexcept;

}  // namespace mw::motion
