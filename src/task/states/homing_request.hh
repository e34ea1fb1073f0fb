// SPDX-License-Identifier: GPL-2.0-or-later
// Homing as the operator has asked for it: of one joint or of all.
#pragma once

#include "motion/api/status.hh"
#include "task/states/request.hh"

namespace mw::task {

/// One thread.
class HomingRequest {
  public:
    /// `joint` -1: all, in their order. An earlier one must have ended.
    void begin(int joint, mailbox::Serial command, motion::CommandId order);
    bool isUnderWay() const { return request_.isUnderWay(); }
    motion::CommandId order() const { return request_.order(); }
    int joint() const { return joint_; }
    /// Once a cycle. `isAnswered`: motion has answered the order.
    std::optional<Ending> step(bool isAnswered, const motion::Status &motion);
    std::optional<Ending> refuse(motion::CommandId order, const std::string &reason) {
        return request_.refuse(order, reason);
    }
    std::optional<Ending> give_up(const std::string &reason) {
        return request_.end(Progress::FAILED, reason);
    }

  private:
    Request request_;
    int joint_ = -1;
};

}  // namespace mw::task
