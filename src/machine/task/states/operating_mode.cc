// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/states/operating_mode.hh"

namespace mw::task {

void OperatingMode::begin(Mode mode, motion::Mode motion_mode, mailbox::Serial command,
                          motion::CommandId order, std::int64_t now_ns, bool may_move_joints) {
    wanted_ = mode;
    wanted_motion_mode_ = motion_mode;
    request_.begin(command, now_ns + CHANGE_TIMEOUT_NS);
    request_.set_order(order);
    is_waiting_for_rest_ = false;
    may_move_joints_ = may_move_joints;
}

bool OperatingMode::isBraking(std::int64_t now_ns) const {
    return braked_ns_.has_value() && now_ns - *braked_ns_ <= CHANGE_TIMEOUT_NS;
}

void OperatingMode::watch_rest(bool moving, std::int64_t now_ns) {
    if (moving && isBraking(now_ns)) {
        braked_ns_ = now_ns;
    }
}

bool OperatingMode::waits_for_rest(motion::CommandId order, std::int64_t now_ns) {
    if (!isChanging() || order != request_.order() || !isBraking(now_ns)) {
        return false;
    }
    is_waiting_for_rest_ = true;
    return true;
}

void OperatingMode::ask_again(motion::CommandId order, std::int64_t now_ns) {
    request_.set_order(order);
    request_.set_deadline(now_ns + CHANGE_TIMEOUT_NS);
    is_waiting_for_rest_ = false;
}

std::optional<Ending> OperatingMode::step(bool answered, motion::Mode motion_mode, std::int64_t now_ns) {
    if (isChanging() && !is_waiting_for_rest_ && answered && motion_mode == wanted_motion_mode_) {
        mode_ = wanted_;
        return request_.end(Progress::DONE);
    }
    if (isWaitingForRest() && isBraking(now_ns)) {
        return std::nullopt;
    }
    if (request_.isLate(now_ns)) {
        return request_.end(Progress::FAILED, "the motion controller has not changed its mode");
    }
    return std::nullopt;
}

void OperatingMode::follow(motion::Mode motion_mode) {
    if (!isChanging() && motion_mode != motion::Mode::COORD) {
        mode_ = Mode::MANUAL;
    }
}

bool OutOfModeWatch::step(bool is_out, std::int64_t now_ns) {
    constexpr std::int64_t LONGEST_NS = 1000000000;
    since_ns_ = is_out ? std::optional(since_ns_.value_or(now_ns)) : std::nullopt;
    return is_out && now_ns - *since_ns_ > LONGEST_NS;
}

}  // namespace mw::task
