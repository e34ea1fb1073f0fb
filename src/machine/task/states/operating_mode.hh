// SPDX-License-Identifier: GPL-2.0-or-later
// Manual, auto or MDI: changed together with motion's mode.
#pragma once

#include "machine/task/states/request.hh"
#include "motion/interface/status.hh"

namespace mw::task {

/// A run goes on in coordinated mode only. One thread.
class OutOfModeWatch {
  public:
    /// Once a cycle; true: motion has been out of that mode for too long.
    bool step(bool isOut, std::int64_t now_ns);

  private:
    std::optional<std::int64_t> since_ns_;
};

/// A change is done when motion has made it. One thread.
class OperatingMode {
  public:
    /// `motion_mode` was ordered by `order`; an earlier change must have ended. `mayMoveJoints`: manual mode
    /// it is also where joints can be moved and axes cannot.
    void begin(Mode mode, motion::Mode motion_mode, mailbox::Serial command, motion::CommandId order,
               std::int64_t now_ns, bool mayMoveJoints = false);
    bool isChanging() const { return request_.isUnderWay(); }
    motion::CommandId order() const { return request_.order(); }
    /// Once a cycle. `isAnswered`: motion has answered the order.
    std::optional<Ending> step(bool isAnswered, motion::Mode motion_mode, std::int64_t now_ns);
    /// Once a cycle, as nothing runs: a motion controller that has left the coordinated mode by itself (homes
    /// lost, sides of a gantry apart) takes no path. Whoever wants one asks for the mode again.
    void follow(motion::Mode motion_mode);
    std::optional<Ending> refuse(motion::CommandId order, const std::string &reason) {
        return request_.refuse(order, reason);
    }
    std::optional<Ending> give_up(const std::string &reason) {
        return request_.end(Progress::FAILED, reason);
    }
    Mode mode() const { return mode_; }

    /// A stop was asked for, of a run or a jog.
    void note_stop(std::int64_t now_ns) { braked_ns_ = now_ns; }
    /// A jog was asked for: what moves from now on is more than braking.
    void note_jog() { braked_ns_.reset(); }
    /// Once a cycle. Braking lasts as long as `isMoving` after a stop: a heavy axis brakes for seconds.
    void watch_rest(bool isMoving, std::int64_t now_ns);
    /// Motion has refused `order` because the machine moves. True: it brakes after a stop, and the change
    /// waits until it stands.
    bool waits_for_rest(motion::CommandId order, std::int64_t now_ns);
    bool isWaitingForRest() const { return isChanging() && isWaitingForRest_; }
    /// It stands: `order` asks for the mode again.
    void ask_again(motion::CommandId order, std::int64_t now_ns);
    motion::Mode wanted_motion_mode() const { return wanted_motion_mode_; }

    /// Motion has refused `order`, axes, where joints will do.
    bool isForJointsToo(motion::CommandId order) const {
        return isChanging() && order == request_.order() && mayMoveJoints_ &&
               wanted_motion_mode_ == motion::Mode::TELEOP;
    }
    /// `order` asks for joint mode instead.
    void fall_back(motion::CommandId order) {
        wanted_motion_mode_ = motion::Mode::FREE;
        request_.set_order(order);
    }

    /// Of runs: they need coordinated mode.
    OutOfModeWatch &run_watch() { return run_watch_; }

  private:
    bool isBraking(std::int64_t now_ns) const;

    OutOfModeWatch run_watch_;
    Mode mode_ = Mode::MANUAL, wanted_ = Mode::MANUAL;
    motion::Mode wanted_motion_mode_ = motion::Mode::FREE;
    std::optional<std::int64_t> braked_ns_;  ///< of the last cycle in which it braked after a stop
    bool isWaitingForRest_ = false, mayMoveJoints_ = false;
    Request request_;
};

}  // namespace mw::task
