// SPDX-License-Identifier: GPL-2.0-or-later
// The state of the machine and its operating mode: the requests of clients, and their result.
#pragma once

#include "machine/task/control/work_end.hh"
#include "machine/task/states/machine_state.hh"

namespace mw::task {

/// Switching the machine off ends all work. The mode changes together with the mode of motion; after a stop
/// it changes when the axes have stopped. All calls come from one thread.
class ModeController {
  public:
    ModeController(MachinePort &port, io::DiscreteIo &io, WorkEnd &end, LongCalls &calls)
        : port_(port), io_(io), end_(end), calls_(calls) {}

    Result<Progress> set_state(mailbox::Serial command, State state);
    /// `homing`: joints are being homed, so manual mode keeps its jog mode.
    Result<Progress> set_mode(mailbox::Serial command, Mode mode, bool homing);
    /// Without a run it also selects manual mode, because screens send only this command when their page of
    /// manual controls opens.
    Result<Progress> set_teleop(mailbox::Serial command, bool teleop, bool running);
    /// Permits jogs during a paused program, which resumes later.
    Result<Progress> release_axes(mailbox::Serial command);

    /// Called once in each cycle before the commands: follows the e-stop chain, and a motion controller that
    /// switches off.
    void follow_machine();
    /// Called once in each cycle after the commands: ends requests that are done or late.
    void end_requests(bool running);
    /// True if motion has rejected a change of its mode that will be requested again or differently.
    bool isRetried(const motion::Answer &answer, const std::string &reason);
    void refuse(motion::CommandId order, const std::string &reason);
    /// Called when work was aborted: abandons a waiting mode.
    void abort() { port_.tell(mode_.give_up("aborted")); }
    /// A stop of a run or jog was requested.
    void note_stop() { mode_.note_stop(port_.now_ns()); }
    void note_jog() { mode_.note_jog(); }

    State state() const { return state_.state(); }
    Mode mode() const { return mode_.mode(); }
    bool isModeChanging() const { return mode_.isChanging(); }
    bool isChanging() const { return mode_.isChanging() || state_.isChanging(); }

  private:
    /// Axes when all joints are homed, else joints.
    motion::Mode jog_mode() const {
        return port_.motion().isAllHomed ? motion::Mode::TELEOP : motion::Mode::FREE;
    }
    void change(Mode mode, motion::Mode motion_mode, mailbox::Serial command, bool may_move_joints = false);

    MachinePort &port_;
    io::DiscreteIo &io_;
    WorkEnd &end_;
    LongCalls &calls_;
    MachineState state_;
    OperatingMode mode_;
};

}  // namespace mw::task
