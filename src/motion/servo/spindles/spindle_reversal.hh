// SPDX-License-Identifier: GPL-2.0-or-later
// How fast a spindle turns back: learned from what it does, so that a tap can tell it in time.
#pragma once

#include <array>
#include <cstdint>

namespace mw::motion {

/// What is wanted of a spindle and what its encoder shows, in a servo cycle.
struct SpindleMotion {
    double wanted = 0;  ///< [turns/s]
    double turns = 0;
    double speed = 0;  ///< as a pin shows it, perhaps without a sign [turns/s]
    double period_s = 1e-3;
};

/// Turning back takes v^2 / 2 ramp turns. Learned from each time that it was done; before the first from how
/// the spindle gained its speed.
struct SpindleReversal {
    enum class Watching : std::uint8_t { NOTHING, REVERSAL, START };
    std::array<double, 2> learned{};  ///< from turning on with the counts, against them [turns/s^2]
    double guessed = 0;               ///< from a start
    Watching watching = Watching::NOTHING;
    double wanted = 0;      ///< of the last cycle [turns/s]
    double last_turns = 0;  ///< of the last cycle
    double from_turns = 0;  ///< at the command to turn back
    double speed = 0;       ///< then; of a start: half of what is wanted [turns/s]
    double direction = 1;   ///< of the counts then
    double farthest = 0;    ///< counted in that direction
    double seconds = 0;     ///< since then
    bool isBegun = false;   ///< something has been seen of the spindle
};

void watch(SpindleReversal &turn_back, const SpindleMotion &now) noexcept;
/// `given`: what the INI file says, 0 for nothing. 0: not known.
std::array<double, 2> ramps_of(const SpindleReversal &turn_back, double given) noexcept;

}  // namespace mw::motion
