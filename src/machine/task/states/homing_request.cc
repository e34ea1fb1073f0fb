// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/states/homing_request.hh"

namespace mw::task {

void HomingRequest::begin(int joint, mailbox::Serial command, motion::CommandId order) {
    joint_ = joint;
    request_.begin(command);
    request_.set_order(order);
}

Result<Progress> HomingRequest::wait(int joint, mailbox::Serial command) {
    bool free = joint >= 0 && joint_ >= 0 && joint != joint_;
    for (const Turn &turn : waiting_) {
        free &= turn.joint != joint;
    }
    if (!free) {
        return fail("homing is already active");
    }
    waiting_.push_back({joint, command});
    return Progress::STARTED;
}

std::optional<HomingRequest::Turn> HomingRequest::take_turn() {
    if (isUnderWay() || waiting_.empty()) {
        return std::nullopt;
    }
    const Turn turn = waiting_.front();
    waiting_.pop_front();
    return turn;
}

std::vector<mailbox::Serial> HomingRequest::drop() {
    std::vector<mailbox::Serial> dropped;
    for (const Turn &turn : waiting_) {
        dropped.push_back(turn.command);
    }
    waiting_.clear();
    return dropped;
}

std::optional<Ending> HomingRequest::step(bool answered, const motion::Status &motion) {
    if (!isUnderWay() || !answered || motion.isHoming) {
        return std::nullopt;
    }
    const bool homed =
        joint_ < 0 ? motion.isAllHomed : motion.joint[static_cast<std::size_t>(joint_)].isHomed;
    return request_.end(homed ? Progress::DONE : Progress::FAILED, homed ? "" : "homing did not finish");
}

}  // namespace mw::task
