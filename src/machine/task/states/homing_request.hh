// SPDX-License-Identifier: GPL-2.0-or-later
// Homing as requested by the operator: of one joint or of all.
#pragma once

#include <deque>
#include <vector>

#include "machine/task/states/request.hh"
#include "motion/interface/status.hh"

namespace mw::task {

/// All calls come from one thread.
class HomingRequest {
  public:
    /// `joint` -1: all, in sequence. An earlier request must have ended.
    void begin(int joint, mailbox::Serial command, motion::CommandId order);
    /// Queues one joint while another joint is being homed. Rejected for a joint that is being homed or
    /// already waits, and while all joints are being homed.
    Result<Progress> wait(int joint, mailbox::Serial command);
    struct Turn {
        int joint = -1;
        mailbox::Serial command = 0;
    };
    /// The next joint if no homing is active.
    std::optional<Turn> take_turn();
    /// Clears the queue; returns the commands that waited.
    std::vector<mailbox::Serial> drop();
    bool isUnderWay() const { return request_.isUnderWay(); }
    motion::CommandId order() const { return request_.order(); }
    int joint() const { return joint_; }
    /// Called once in each cycle. `answered`: motion has answered the command.
    std::optional<Ending> step(bool answered, const motion::Status &motion);
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
