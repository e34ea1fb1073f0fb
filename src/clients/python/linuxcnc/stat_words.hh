// SPDX-License-Identifier: GPL-2.0-or-later
// Values of the status that only clients of LinuxCNC use.
#pragma once

#include "messages/declarations/status.hh"

namespace mw::python {

/// Value of `stat.state` and of wait_complete().
enum class RcsState : int { NONE = 0, DONE = 1, EXEC = 2, ERROR = 3 };
/// ERROR after the last command was rejected or has failed, until the next command. DONE: no work is active.
RcsState rcs_state(const messages::MachineStatus &status);

}  // namespace mw::python
