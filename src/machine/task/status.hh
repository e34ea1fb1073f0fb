// SPDX-License-Identifier: GPL-2.0-or-later
// The output of task: the status of the machine, and lines for the operator.
#pragma once

#include <cstdint>
#include <string>

#include "machine/task/command.hh"
#include "messages/declarations/status.hh"

namespace mw::task {

/// The status that is published once a cycle.
using Status = messages::MachineStatus;

/// The reason why all work was stopped: the argument of [RS274NGC]ON_ABORT_COMMAND.
enum class AbortReason : std::uint8_t {
    EXECUTION_ERROR = 1,  ///< a move was rejected, or an action of the program failed
    ESTOP_CHAIN = 2,
    MOTION_FAULT = 3,  ///< following error, limit switch, amplifier
    STATE_OFF = 4,
    STATE_ESTOP_RESET = 5,
    STATE_ESTOP = 6,
    STATE_NOT_ON = 7,  ///< the machine switched itself off
    ABORT = 8,         ///< aborted by the operator
    INTERPRETER_ERROR = 9,
    INTERPRETER_ERROR_MDI = 10,
};

}  // namespace mw::task
