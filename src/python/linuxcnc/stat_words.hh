// SPDX-License-Identifier: GPL-2.0-or-later
// What clients read of the status in words that the machine itself does not use: made from its facts.
#pragma once

#include "msgs/status.hh"

namespace mw::python {

/// Of `stat.state` and wait_complete().
enum class RcsState : int { NONE = 0, DONE = 1, EXEC = 2, ERROR = 3 };
/// The last command was refused or has failed: ERROR, until the next one. DONE: nothing is under way.
RcsState rcs_state(const msgs::MachineStatus &status);

/// Of `stat.exec_state`: what task waits for.
enum class ExecState : int {
    NONE = 0,
    ERROR = 1,
    DONE = 2,
    WAITING_FOR_MOTION = 3,
    WAITING_FOR_IO = 5,
    WAITING_FOR_MOTION_AND_IO = 7,
    WAITING_FOR_DELAY = 8,
    WAITING_FOR_SYSTEM_CMD = 9,
    WAITING_FOR_SPINDLE_ORIENTED = 10,
};
ExecState exec_state(const msgs::MachineStatus &status);

}  // namespace mw::python
