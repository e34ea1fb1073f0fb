// SPDX-License-Identifier: GPL-2.0-or-later
// How fast a spindle reverses: learned from its reversals, so that a tap can start the reversal in time.
#pragma once

#include <array>
#include <cstdint>

namespace mw::motion {

/// Commanded speed and encoder values of a spindle in a servo cycle.
struct SpindleMotion {
    double wanted = 0;  ///< [turns/s]
    double turns = 0;
    double speed = 0;  ///< as the pin shows it, perhaps without a sign [turns/s]
    double period_s = 1e-3;
};

/// A reversal takes v^2 / 2 ramp revolutions. The ramp is learned from each reversal; before the first one,
/// from the start of the spindle.
struct SpindleReversal {
    enum class Watching : std::uint8_t { NOTHING, REVERSAL, START };
    std::array<double, 2> learned{};  ///< from running with the counts, and against them [turns/s^2]
    double guessed = 0;               ///< from a start
    Watching watching = Watching::NOTHING;
    double wanted = 0;      ///< of the last cycle [turns/s]
    double last_turns = 0;  ///< of the last cycle
    double from_turns = 0;  ///< at the command to reverse
    double speed = 0;       ///< at that time; of a start: half of the commanded speed [turns/s]
    double direction = 1;   ///< direction of the counts at that time
    double farthest = 0;    ///< counted in that direction
    double seconds = 0;     ///< since then
    bool isBegun = false;   ///< the encoder has given values
};

void watch(SpindleReversal &turn_back, const SpindleMotion &now) noexcept;
/// `given`: value of the INI file, 0 for none. 0: not known.
std::array<double, 2> ramps_of(const SpindleReversal &turn_back, double given) noexcept;

}  // namespace mw::motion
