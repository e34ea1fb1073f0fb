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

void step(Holds &holds, const HoldInputs &in) noexcept {
    // A value that is not a number is a feed of 0: a broken sensor must not let the machine run.
    const double wanted = std::isfinite(in.adaptive_feed) ? std::clamp(in.adaptive_feed, -1.0, 1.0) : 0.0;
    const double adaptive = holds.isAdaptiveFeedEnabled ? wanted : 1.0;
    holds.isReverseWanted = (adaptive < 0) != holds.isReverse;
    holds.reverse_rate = trajectory::Retrace::HIGHEST_RATE * std::abs(adaptive);
    // Commands that wait during reverse run keep their speed.
    holds.net_feed_scale = holds.jog_scale() * std::abs(adaptive);
    const bool isFeedHeld = (holds.isFeedHoldEnabled && in.isFeedHeld) || in.isFeedInhibited;
    holds.isStandingWanted = holds.isPaused || isFeedHeld;
    const bool isStepOver = holds.isStepping && in.steps_done == holds.steps;
    if (isStepOver) {
        holds.isStepping = false;
        holds.isPaused = true;
    }
}

CommandResult take(Holds &holds, const Pause &) noexcept {
    holds.isPaused = true;
    holds.isStepping = false;
    return {};
}

CommandResult take(Holds &holds, const Resume &) noexcept {
    holds.isPaused = false;
    holds.isStepping = false;
    return {};
}

CommandResult take(Holds &holds, const StepOnce &) noexcept {
    holds.isPaused = false;
    holds.isStepping = true;
    ++holds.steps;
    return {};
}

CommandResult take(Holds &holds, const SetReverse &command, bool isWayKnown) noexcept {
    const bool isRefused = command.isReverse && !isWayKnown;
    holds.isReverse = command.isReverse && !isRefused;
    return {isRefused ? Reason::NO_WAY_BACK : Reason::NONE};
}

CommandResult take(Holds &holds, const SetMaxVelocity &command) noexcept {
    if (!(command.velocity >= 0)) {
        return {Reason::OUT_OF_RANGE};
    }
    holds.max_velocity = command.velocity;
    return {};
}

CommandResult take(Holds &holds, const SetScale &command, double max_feed_scale) noexcept {
    const bool isRapid = command.what == Scale::RAPID;
    const double most = (isRapid ? 1.0 : max_feed_scale) * (1 + SCALE_ROUNDING);
    if (!(command.factor >= 0) || !std::isfinite(command.factor) || command.factor > most) {
        return {Reason::OUT_OF_RANGE};
    }
    (isRapid ? holds.rapid_scale : holds.feed_scale) = command.factor;
    return {};
}

CommandResult take(Holds &holds, const SetSwitch &command) noexcept {
    switch (command.what) {
    case Switch::FEED_OVERRIDE: holds.isFeedOverrideEnabled = command.isEnabled; break;
    case Switch::ADAPTIVE_FEED: holds.isAdaptiveFeedEnabled = command.isEnabled; break;
    case Switch::FEED_HOLD: holds.isFeedHoldEnabled = command.isEnabled; break;
    case Switch::SPINDLE_OVERRIDE: break;
    }
    return {};
}

void release(Holds &holds) noexcept {
    holds.isPaused = false;
    holds.isStepping = false;
    holds.isReverse = false;
}

void fill(const Holds &holds, Status &status) noexcept {
    status.feed_scale = holds.feed_scale;
    status.rapid_scale = holds.rapid_scale;
    status.net_feed_scale = holds.net_feed_scale;
    status.isFeedOverrideEnabled = holds.isFeedOverrideEnabled;
    status.isAdaptiveFeedEnabled = holds.isAdaptiveFeedEnabled;
    status.isFeedHoldEnabled = holds.isFeedHoldEnabled;
    status.isPaused = holds.isPaused;
    status.isStepping = holds.isStepping;
    status.isReverse = holds.isReverseWanted;
}

}  // namespace mw::motion
