// SPDX-License-Identifier: GPL-2.0-or-later
// How a spindle reverses: learned from its reversals, so that a tap can start the reversal in time.
#pragma once

#include <cstdint>

#include "trajectory/path/spindle_braking.hh"

namespace mw::motion {

/// Commanded speed and encoder values of a spindle in a servo cycle.
struct SpindleMotion {
    double wanted = 0;  ///< [turns/s]
    double turns = 0;
    double speed = 0;  ///< by the counts, with their sign [turns/s]
    double step = 0;   ///< of the encoder [turns]
    double period_s = 1e-3;
    double shown_speed = 0;  ///< by the pin: perhaps late or without a sign, but smooth [turns/s]
};

/// Delay and ramp are learned from each reversal from a steady speed; before the first one, from the start of
/// the spindle.
struct SpindleReversal {
    enum class Watching : std::uint8_t { NOTHING, REVERSAL, START };
    trajectory::SpindleBrakings learned{};
    trajectory::SpindleBraking guessed;  ///< from a start
    Watching watching = Watching::NOTHING;
    double wanted = 0;      ///< of the last cycle [turns/s]
    double from_turns = 0;  ///< at the command
    double speed = 0;       ///< at the command to reverse; of a start: the commanded speed [turns/s]
    double direction = 1;   ///< direction of the counts at the command to reverse
    double farthest = 0;    ///< counted in that direction
    double arrived_s = 0;   ///< when the count got there, after the command
    double left_s = 0;      ///< when it was there last
    double quarter_s = 0;   ///< of a start: when a quarter of the speed was reached
    double seconds = 0;     ///< since the command
};

void watch(SpindleReversal &reversal, const SpindleMotion &now) noexcept;
/// `given_ramp`: value of the INI file [turns/s^2], 0 for none.
trajectory::SpindleBrakings brakings_of(const SpindleReversal &reversal, double given_ramp) noexcept;

}  // namespace mw::motion
