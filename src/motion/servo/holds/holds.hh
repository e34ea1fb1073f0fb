// SPDX-License-Identifier: GPL-2.0-or-later
// Pauses and speed of the path: pause, step, feed hold, reverse run, overrides.
#pragma once

#include <cstdint>

#include "motion/interface/command.hh"
#include "motion/interface/status.hh"
#include "motion/servo/command_result.hh"

namespace mw::motion {

struct Holds {
    double feed_scale = 1, rapid_scale = 1, max_velocity = 1e300;
    bool isFeedOverrideEnabled = true, isAdaptiveFeedEnabled = false, isFeedHoldEnabled = true;
    bool isPaused = false, isStepping = false;
    bool isReverse = false;   ///< reverse run by command
    std::uint32_t steps = 0;  ///< counts StepOnce

    // As of the last cycle.
    bool isReverseWanted = false;   ///< by command, or by adaptive feed below 0
    bool isStandingWanted = false;  ///< paused or feed hold
    double reverse_rate = 0;        ///< of the commanded speed, without its sign
    double net_feed_scale = 1;

    /// The feed override acts on jogs and homing as well.
    double jog_scale() const noexcept { return isFeedOverrideEnabled ? feed_scale : 1.0; }
};

struct HoldInputs {
    double adaptive_feed = 1;
    bool isFeedHeld = false, isFeedInhibited = false;
    std::uint32_t steps_done = 0;  ///< the StepOnce whose stop has been reached
};
/// One cycle.
void step(Holds &holds, const HoldInputs &in) noexcept;

CommandResult take(Holds &holds, const Pause &command) noexcept;
CommandResult take(Holds &holds, const Resume &command) noexcept;
CommandResult take(Holds &holds, const StepOnce &command) noexcept;
/// `isWayKnown`: a recorded path for reverse run exists.
CommandResult take(Holds &holds, const SetReverse &command, bool isWayKnown) noexcept;
CommandResult take(Holds &holds, const SetMaxVelocity &command) noexcept;
/// Of feed and rapids; `max_feed_scale` is the machine's maximum.
CommandResult take(Holds &holds, const SetScale &command, double max_feed_scale) noexcept;
CommandResult take(Holds &holds, const SetSwitch &command) noexcept;
/// Motion has been stopped: no path remains to continue.
void release(Holds &holds) noexcept;
void fill(const Holds &holds, Status &status) noexcept;

}  // namespace mw::motion
