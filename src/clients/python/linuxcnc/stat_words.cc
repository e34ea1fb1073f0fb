// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/python/linuxcnc/stat_words.hh"

namespace mw::python {

using messages::WaitFor;

RcsState rcs_state(const messages::MachineStatus &status) {
    if (status.cycle == 0) {
        return RcsState::NONE;
    }
    switch (status.last_progress) {
    case messages::Progress::REFUSED:
    case messages::Progress::FAILED: return RcsState::ERROR;
    case messages::Progress::STARTED:
    case messages::Progress::DONE: break;
    }
    const messages::TrajectoryStatus &trajectory = status.trajectory;
    const bool commanded = status.last_progress == messages::Progress::STARTED ||
                           status.task.interp_state != messages::InterpState::IDLE ||
                           status.task.waiting.what != WaitFor::NOTHING;
    // Jogs of axes do not count as active work, because screens send further commands during a jog. A line
    // has ended with its last move, independent of the feedback.
    const bool moving = trajectory.queue_depth > 0 || trajectory.isHoming ||
                        (!trajectory.isInPosition && trajectory.mode == messages::MotionMode::FREE);
    return commanded || moving ? RcsState::EXEC : RcsState::DONE;
}

}  // namespace mw::python
