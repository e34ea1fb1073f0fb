// SPDX-License-Identifier: GPL-2.0-or-later
// Passes that are locked to a spindle angle: threads and rigid taps.
#include <algorithm>

#include "trajectory/follow/executor.hh"

namespace mw::trajectory {

void Executor::begin_pass() noexcept {
    const CurvePlan &plan = curve_.plan();
    FollowedSpindle &followed = spindles_[static_cast<std::size_t>(plan.pass.spindle)];
    tapping_ = plan.pass.is_tap;
    if (tapping_) {
        tap_.begin(plan.pass.tap, followed.reading(), period_);
    } else {
        pass_.begin(store_, plan.pass, followed.reading(), period_);
    }
    followed.track.set_rate(tapping_ ? tap_.rate() : pass_.rate());
    step_locked();
}

/// Advances a tap by one cycle. True while the tool moves along the line of the tap, or waits.
bool Executor::advance_tap(const SpindleReading &spindle) noexcept {
    const Pass &pass = curve_.plan().pass;
    if (state_.isDropping) {
        tap_.stop(spindle);
    }
    tap_.step(spindle, period_);
    out_.tap = {pass.spindle, tap_.spindle_factor(), tap_.isLost()};
    if (tap_.isOver() && !state_.isDropping && !tap_.isLost()) {
        tapping_ = false;
        curve_.set_place(pass.end_s, 0);
    } else {
        const double x = std::clamp(tap_.x(), 0.0, pass.tap.depth);
        curve_.set_place(pass.start_s + x, tap_.v());
    }
    state_.v = tap_.v();
    return !tap_.isOver();
}

bool Executor::advance_pass(const SpindleReading &spindle) noexcept {
    if (state_.isDropping) {
        pass_.stop();
    }
    const bool is_moving = pass_.step(store_, spindle, period_);
    curve_.set_place(pass_.s(), pass_.v());
    state_.v = pass_.v();
    return is_moving;
}

/// Advances a locked pass by one cycle.
void Executor::step_locked() noexcept {
    const Pass &pass = curve_.plan().pass;
    const SpindleReading spindle = spindles_[static_cast<std::size_t>(pass.spindle)].reading();
    const bool is_moving = pass.is_tap ? advance_tap(spindle) : advance_pass(spindle);
    state_.x = curve_.s();
    if (!is_moving) {
        come_to_rest();
    }
}

}  // namespace mw::trajectory
