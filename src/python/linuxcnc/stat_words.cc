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

}  // namespace mw::python
