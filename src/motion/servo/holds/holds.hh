// SPDX-License-Identifier: GPL-2.0-or-later
// Pauses and speed of the path: pause, step, feed hold, reverse run, overrides.
#pragma once

#include <cstdint>

#include "motion/interface/command.hh"
#include "motion/interface/status.hh"
#include "motion/servo/command_result.hh"

namespace mw::motion {

struct HoldInputs {
    double adaptive_feed = 1;
    bool isFeedHeld = false, isFeedInhibited = false;
    std::uint32_t steps_done = 0;  ///< count of StepOnce commands whose stop was reached
};

class Holds {
  public:
    CommandResult take(const Pause &command) noexcept;
    CommandResult take(const Resume &command) noexcept;
    CommandResult take(const StepOnce &command) noexcept;
    /// `isPathRecorded`: a recorded path for reverse run exists.
    CommandResult take(const SetReverse &command, bool isPathRecorded) noexcept;
    CommandResult take(const SetMaxVelocity &command) noexcept;
    /// Sets the override of feed and rapids; `max_feed_scale` is the machine's maximum.
    CommandResult take(const SetScale &command, double max_feed_scale) noexcept;
    CommandResult take(const SetSwitch &command) noexcept;

    /// One cycle.
    void step(const HoldInputs &in) noexcept;
    /// Motion was stopped and no path remains to continue.
    void release() noexcept;

    // Values of the last cycle.
    /// Reverse run, by command or by adaptive feed below 0.
    bool isReverseWanted() const noexcept { return reverse_wanted_; }
    /// Pause or feed hold.
    bool isHoldWanted() const noexcept { return hold_wanted_; }
    /// Speed of reverse run as a fraction of the commanded speed.
    double reverse_rate() const noexcept { return reverse_rate_; }
    double net_feed_scale() const noexcept { return net_feed_scale_; }

    /// The feed override acts on jogs and homing as well.
    double jog_scale() const noexcept { return feed_override_enabled_ ? feed_scale_ : 1.0; }
    double rapid_scale() const noexcept { return rapid_scale_; }
    /// [machine units/s]
    double max_velocity() const noexcept { return max_velocity_; }
    bool isAdaptiveFeedEnabled() const noexcept { return adaptive_feed_enabled_; }
    bool isPaused() const noexcept { return paused_; }
    bool isStepping() const noexcept { return stepping_; }
    /// Counts StepOnce.
    std::uint32_t steps() const noexcept { return steps_; }

    void fill(Status &status) const noexcept;

  private:
    double feed_scale_ = 1, rapid_scale_ = 1, max_velocity_ = 1e300;
    bool feed_override_enabled_ = true, adaptive_feed_enabled_ = false, feed_hold_enabled_ = true;
    bool paused_ = false, stepping_ = false;
    bool reversed_ = false;  ///< by command
    std::uint32_t steps_ = 0;
    bool reverse_wanted_ = false, hold_wanted_ = false;
    double reverse_rate_ = 0, net_feed_scale_ = 1;
};

}  // namespace mw::motion
