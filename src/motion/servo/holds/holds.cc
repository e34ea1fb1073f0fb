// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/holds/holds.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/follow/retrace.hh"

namespace mw::motion {

namespace {

/// Rounding of a scale at its limit.
constexpr double SCALE_ROUNDING = 1e-9;

}  // namespace

void Holds::step(const HoldInputs &in) noexcept {
    // A value that is not a number counts as 0: a broken sensor must not let the machine run.
    const double wanted = std::isfinite(in.adaptive_feed) ? std::clamp(in.adaptive_feed, -1.0, 1.0) : 0.0;
    const double adaptive = adaptive_feed_enabled_ ? wanted : 1.0;
    reverse_wanted_ = (adaptive < 0) != reversed_;
    reverse_rate_ = trajectory::Retrace::HIGHEST_RATE * std::abs(adaptive);
    // Commands that wait during reverse run keep their speed.
    net_feed_scale_ = jog_scale() * std::abs(adaptive);
    const bool isFeedHeld = (feed_hold_enabled_ && in.isFeedHeld) || in.isFeedInhibited;
    hold_wanted_ = paused_ || isFeedHeld;
    const bool isStepOver = stepping_ && in.steps_done == steps_;
    if (isStepOver) {
        stepping_ = false;
        paused_ = true;
    }
}

CommandResult Holds::take(const Pause &) noexcept {
    paused_ = true;
    stepping_ = false;
    return {};
}

CommandResult Holds::take(const Resume &) noexcept {
    paused_ = false;
    stepping_ = false;
    return {};
}

CommandResult Holds::take(const StepOnce &) noexcept {
    paused_ = false;
    stepping_ = true;
    ++steps_;
    return {};
}

CommandResult Holds::take(const SetReverse &command, bool isPathRecorded) noexcept {
    const bool isRefused = command.isReverse && !isPathRecorded;
    reversed_ = command.isReverse && !isRefused;
    return {isRefused ? Reason::NO_WAY_BACK : Reason::NONE};
}

CommandResult Holds::take(const SetMaxVelocity &command) noexcept {
    if (!(command.velocity >= 0)) {
        return {Reason::OUT_OF_RANGE};
    }
    max_velocity_ = command.velocity;
    return {};
}

CommandResult Holds::take(const SetScale &command, double max_feed_scale) noexcept {
    const bool isRapid = command.what == Scale::RAPID;
    const double most = (isRapid ? 1.0 : max_feed_scale) * (1 + SCALE_ROUNDING);
    if (!(command.factor >= 0) || !std::isfinite(command.factor) || command.factor > most) {
        return {Reason::OUT_OF_RANGE};
    }
    (isRapid ? rapid_scale_ : feed_scale_) = command.factor;
    return {};
}

CommandResult Holds::take(const SetSwitch &command) noexcept {
    switch (command.what) {
    case Switch::FEED_OVERRIDE: feed_override_enabled_ = command.isEnabled; break;
    case Switch::ADAPTIVE_FEED: adaptive_feed_enabled_ = command.isEnabled; break;
    case Switch::FEED_HOLD: feed_hold_enabled_ = command.isEnabled; break;
    case Switch::SPINDLE_OVERRIDE: break;
    }
    return {};
}

void Holds::release() noexcept {
    paused_ = false;
    stepping_ = false;
    reversed_ = false;
}

void Holds::fill(Status &status) const noexcept {
    status.feed_scale = feed_scale_;
    status.rapid_scale = rapid_scale_;
    status.net_feed_scale = net_feed_scale_;
    status.isFeedOverrideEnabled = feed_override_enabled_;
    status.isAdaptiveFeedEnabled = adaptive_feed_enabled_;
    status.isFeedHoldEnabled = feed_hold_enabled_;
    status.isPaused = paused_;
    status.isStepping = stepping_;
    status.isReverse = reverse_wanted_;
}

}  // namespace mw::motion
