// SPDX-License-Identifier: GPL-2.0-or-later
// Offsets of X and Y from the path: to the position for changing consumables, and off the cut before a
// restart.
#include <cmath>

#include "components/plasma/plasma_core.hh"

namespace mw::plasma {

/// Moves to and from the position for changing consumables; the step of each axis is set at the start.
bool Sideways::moveStraight(std::int32_t x, std::int32_t y) noexcept {
    if (!active_) {
        const double dx = static_cast<double>(x) - out_.x_offset_counts;
        const double dy = static_cast<double>(y) - out_.y_offset_counts;
        const double way = std::hypot(dx, dy);
        const double share = way > 0.0 ? steps_exactly(in_.xy_feed_rate) / way : 0.0;
        step_x_ = std::fabs(dx) * share;
        step_y_ = std::fabs(dy) * share;
        active_ = true;
    }
    if (out_.x_offset_counts == x && out_.y_offset_counts == y) {
        active_ = false;
        return true;
    }
    const auto approach = [](std::int32_t from, std::int32_t to, double step) {
        const auto whole = static_cast<std::int64_t>(step);
        const std::int64_t left = std::int64_t{to} - from;
        return static_cast<std::int32_t>(from + (left > whole ? whole : left < -whole ? -whole : left));
    };
    out_.x_offset_counts = approach(out_.x_offset_counts, x, step_x_);
    out_.y_offset_counts = approach(out_.y_offset_counts, y, step_y_);
    return false;
}

void Sideways::consumables_out() noexcept {
    if (!out_.consumable_changing) {
        out_.consumable_changing = true;
        out_.xy_offset_enable = true;
        return;
    }
    if (in_.breakaway || in_.float_switch || was_ohmic_) {
        return;
    }
    if (moveStraight(in_.x_offset, in_.y_offset)) {
        state_ = State::IDLE;
    }
}

void Sideways::consumables_back() noexcept {
    if (in_.breakaway || in_.float_switch || was_ohmic_) {
        return;
    }
    if (moveStraight(0, 0)) {
        out_.consumable_changing = false;
        out_.feed_hold = false;
        state_ = State::IDLE;
    }
}

/// Moves off the path by the offset from the operator, plus the distance between laser and torch.
void Sideways::recovery_out() noexcept {
    if (!in_.program_is_paused) {
        state_ = State::IDLE;
        return;
    }
    out_.cut_recovering = true;
    out_.xy_offset_enable = true;
    if (!in_.cut_recovery) {
        state_ = State::RECOVERY_BACK;
        return;
    }
    const std::int32_t laser_before = out_.laser_recovery_state;
    follow_laser();
    const bool is_laser = out_.laser_recovery_state >= 2;
    if (is_laser ? laser_before < 2 : out_.laser_recovery_state == 1) {
        return;
    }
    const auto approach = [&](std::int32_t from, std::int64_t to) {
        const auto step = static_cast<std::int64_t>(std::round(steps_exactly(in_.cut_feed_rate) * 0.5));
        const std::int64_t left = to - from;
        return static_cast<std::int32_t>(from + (left > step ? step : left < -step ? -step : left));
    };
    const std::int64_t x = to_counts(0.0 + in_.x_offset + (is_laser ? in_.laser_x_offset : 0));
    const std::int64_t y = to_counts(0.0 + in_.y_offset + (is_laser ? in_.laser_y_offset : 0));
    out_.x_offset_counts = approach(out_.x_offset_counts, x);
    out_.y_offset_counts = approach(out_.y_offset_counts, y);
    is_at_target_ = out_.x_offset_counts == x && out_.y_offset_counts == y;
}

/// The steps follow each other, one per cycle: requested, moving, arrived.
void Sideways::follow_laser() noexcept {
    if (in_.laser_recovery_start <= 0) {
        return;
    }
    if (out_.laser_recovery_state < 2) {
        out_.laser_recovery_state += 1;
        is_at_target_ = false;
    } else if (out_.laser_recovery_state == 2 && is_at_target_) {
        out_.laser_recovery_state = 3;
    }
}

/// Moves from under the laser to under the torch before a cut starts again.
void Sideways::leave_laser() noexcept {
    if (out_.laser_recovery_state < 5) {
        out_.laser_recovery_state = out_.laser_recovery_state < 4 ? 4 : 5;
        return;
    }
    if (moveSideways(in_.x_offset, in_.y_offset, steps_of(in_.setup_feed_rate))) {
        out_.laser_recovery_state = 0;
    }
}

/// Moves back to the path: at the feed rate of the cut with the torch on, otherwise at half of it.
void Sideways::recovery_back() noexcept {
    const double rate = in_.cut_feed_rate * (stop_ == Stop::PAUSED ? 0.5 : 1.0);
    if (!moveSideways(0.0, 0.0, steps_exactly(rate))) {
        return;
    }
    out_.cut_recovering = false;
    out_.laser_recovery_state = 0;
    if (stop_ == Stop::PAUSED) {
        state_ = State::IDLE;
    } else {
        start_cut();
    }
}

}  // namespace mw::plasma
