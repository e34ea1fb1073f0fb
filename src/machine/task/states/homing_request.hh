// SPDX-License-Identifier: GPL-2.0-or-later
// Homing as the operator has asked for it: of one joint or of all.
#pragma once

#include <deque>
#include <vector>

#include "machine/task/states/request.hh"
#include "motion/interface/status.hh"

namespace mw::task {

/// One thread.
class HomingRequest {
  public:
    /// `joint` -1: all, in their order. An earlier one must have ended.
    void begin(int joint, mailbox::Serial command, motion::CommandId order);
    /// Of one joint while another is being homed: its turn comes when that one is homed. Refused for a joint
    /// that is being homed or waits already, and where all are being homed.
    Result<Progress> wait(int joint, mailbox::Serial command);
    struct Turn {
        int joint = -1;
        mailbox::Serial command = 0;
    };
    /// The one whose turn it is, once nothing is under way.
    std::optional<Turn> take_turn();
    /// Nobody's turn comes any more; the commands that waited.
    std::vector<mailbox::Serial> drop();
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
    std::deque<Turn> waiting_;
};

}  // namespace mw::task
