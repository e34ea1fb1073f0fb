// SPDX-License-Identifier: GPL-2.0-or-later
// Manual, auto or MDI: changed together with the mode of motion.
#pragma once

#include "machine/task/states/request.hh"
#include "motion/interface/status.hh"

namespace mw::task {

/// A run continues only in coordinated mode. All calls come from one thread.
class OutOfModeWatch {
  public:
    /// Called once in each cycle; true if motion has not been in that mode for too long.
    bool step(bool is_out, std::int64_t now_ns);

  private:
    std::optional<std::int64_t> since_ns_;
};

/// A change is complete when motion has changed its mode. All calls come from one thread.
class OperatingMode {
  public:
    /// `order` has requested `motion_mode`; an earlier change must have ended. `may_move_joints`: manual mode
    /// is also possible with only joint jogging.
    void begin(Mode mode, motion::Mode motion_mode, mailbox::Serial command, motion::CommandId order,
               std::int64_t now_ns, bool may_move_joints = false);
    bool isChanging() const { return request_.isUnderWay(); }
    motion::CommandId order() const { return request_.order(); }
    /// Called once in each cycle. `answered`: motion has answered the command.
    std::optional<Ending> step(bool answered, motion::Mode motion_mode, std::int64_t now_ns);
    /// Called once in each cycle while nothing runs. A motion controller that has left coordinated mode by
    /// itself (lost homes, misaligned gantry) accepts no path, so the mode must be selected again.
    void follow(motion::Mode motion_mode);
    std::optional<Ending> refuse(motion::CommandId order, const std::string &reason) {
        return request_.refuse(order, reason);
    }
    std::optional<Ending> give_up(const std::string &reason) {
        return request_.end(Progress::FAILED, reason);
    }
    Mode mode() const { return mode_; }

    /// A stop of a run or jog was requested.
    void note_stop(std::int64_t now_ns) { braked_ns_ = now_ns; }
    /// Called when a jog was requested; later motion is then not only braking.
    void note_jog() { braked_ns_.reset(); }
    /// Called once in each cycle. Braking after a stop lasts as long as `moving`; a heavy axis brakes for
    /// seconds.
    void watch_rest(bool moving, std::int64_t now_ns);
    /// Motion has rejected `order` because the machine is moving. True: it brakes after a stop, and the
    /// change waits for standstill.
    bool waits_for_rest(motion::CommandId order, std::int64_t now_ns);
    bool isWaitingForRest() const { return isChanging() && is_waiting_for_rest_; }
    /// Called at standstill: `order` requests the mode again.
    void ask_again(motion::CommandId order, std::int64_t now_ns);
    motion::Mode wanted_motion_mode() const { return wanted_motion_mode_; }

    /// True if motion has rejected `order` for axes, and joints are sufficient.
    bool isForJointsToo(motion::CommandId order) const {
        return isChanging() && order == request_.order() && may_move_joints_ &&
               wanted_motion_mode_ == motion::Mode::TELEOP;
    }
    /// Called when `order` requests joint mode instead.
    void fall_back(motion::CommandId order) {
        wanted_motion_mode_ = motion::Mode::FREE;
        request_.set_order(order);
    }

  private:
    bool isBraking(std::int64_t now_ns) const;

    Mode mode_ = Mode::MANUAL, wanted_ = Mode::MANUAL;
    motion::Mode wanted_motion_mode_ = motion::Mode::FREE;
    std::optional<std::int64_t> braked_ns_;  ///< time of the last cycle in which the machine braked after a
                                             ///< stop
    bool is_waiting_for_rest_ = false, may_move_joints_ = false;
    Request request_;
};

}  // namespace mw::task
