// SPDX-License-Identifier: GPL-2.0-or-later
#include "python/linuxcnc/stat_words.hh"

namespace mw::python {

using msgs::WaitFor;

RcsState rcs_state(const msgs::MachineStatus &status) {
    if (status.cycle == 0) {
        return RcsState::NONE;
    }
    switch (status.last_progress) {
    case msgs::Progress::REFUSED:
    case msgs::Progress::FAILED: return RcsState::ERROR;
    case msgs::Progress::STARTED:
    case msgs::Progress::DONE: break;
    }
    const msgs::TrajectoryStatus &trajectory = status.trajectory;
    const bool isCommanded = status.last_progress == msgs::Progress::STARTED ||
                             status.task.interp_state != msgs::InterpState::IDLE ||
                             status.task.waiting.what != WaitFor::NOTHING;
    // Jogs of axes are no work that is under way: screens give further commands meanwhile. A line has ended
    // with its last move, however the feedback follows.
    const bool isMoving = trajectory.queue_depth > 0 || trajectory.isHoming ||
                          (!trajectory.isInPosition && trajectory.mode == msgs::MotionMode::FREE);
    return isCommanded || isMoving ? RcsState::EXEC : RcsState::DONE;
}

ExecState exec_state(const msgs::MachineStatus &status) {
    if (status.cycle == 0) {
        return ExecState::NONE;
    }
    if (status.task.interp_state == msgs::InterpState::IDLE) {
        return ExecState::DONE;
    }
    const bool isMoving = status.trajectory.queue_depth > 0;
    switch (status.task.waiting.what) {
    case WaitFor::DWELL:
    case WaitFor::DIGITAL_INPUT:
    case WaitFor::ANALOG_INPUT: return ExecState::WAITING_FOR_DELAY;
    case WaitFor::TOOL_PREPARED:
    case WaitFor::TOOL_PREPARED_OFF:
    case WaitFor::TOOL_CHANGED:
    case WaitFor::TOOL_CHANGED_OFF:
        return isMoving ? ExecState::WAITING_FOR_MOTION_AND_IO : ExecState::WAITING_FOR_IO;
    case WaitFor::SPINDLE_ORIENTED: return ExecState::WAITING_FOR_SPINDLE_ORIENTED;
    case WaitFor::USER_CODE: return ExecState::WAITING_FOR_SYSTEM_CMD;
    case WaitFor::SETTING: return ExecState::WAITING_FOR_MOTION;
    case WaitFor::HOMING:
    case WaitFor::NOTHING: break;
    }
    const bool isHeldAtStop = status.task.isStoppedByProgram && !isMoving;
    return isHeldAtStop ? ExecState::DONE : ExecState::WAITING_FOR_MOTION_AND_IO;
}

}  // namespace mw::python
