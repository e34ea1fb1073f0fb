// SPDX-License-Identifier: GPL-2.0-or-later
// What clients read of the status in words that the machine itself does not use: made from its facts.
#pragma once

#include "messages/declarations/status.hh"

namespace mw::python {

/// Of `stat.state` and wait_complete().
enum class RcsState : int { NONE = 0, DONE = 1, EXEC = 2, ERROR = 3 };
/// The last command was refused or has failed: ERROR, until the next one. DONE: nothing is under way.
RcsState rcs_state(const messages::MachineStatus &status);

}  // namespace mw::python
