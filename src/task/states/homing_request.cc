// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/states/homing_request.hh"

namespace mw::task {

void HomingRequest::begin(int joint, mailbox::Serial command, motion::CommandId order) {
    joint_ = joint;
    request_.begin(command);
    request_.set_order(order);
}

std::optional<Ending> HomingRequest::step(bool isAnswered, const motion::Status &motion) {
    if (!isUnderWay() || !isAnswered || motion.isHoming) {
        return std::nullopt;
    }
    const bool isHomed =
        joint_ < 0 ? motion.isAllHomed : motion.joint[static_cast<std::size_t>(joint_)].isHomed;
    return request_.end(isHomed ? Progress::DONE : Progress::FAILED, isHomed ? "" : "homing did not finish");
}

}  // namespace mw::task
