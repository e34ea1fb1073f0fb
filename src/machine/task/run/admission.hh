// SPDX-License-Identifier: GPL-2.0-or-later
// Accepted commands in each situation: one table, from which docs/reference/states.md is generated.
#pragma once

#include <string>

#include "base/result.hh"
#include "machine/task/run/command_classes.hh"
#include "machine/task/run/run_state.hh"

namespace mw::task {

/// State of the machine that determines which commands are accepted.
enum class Situation : std::uint8_t {
    ESTOP,
    OFF,
    MANUAL,
    AUTO_IDLE,
    AUTO_RUNNING,   ///< reading, moving, waiting, stepping
    AUTO_HELD,      ///< paused by the operator, M0, M1 or M60
    AUTO_PROPOSED,  ///< an approach waits for confirmation
    AUTO_AWAY,      ///< the axes of a paused program are released
    MDI_IDLE,
    MDI_RUNNING,
    MDI_HELD,
    COUNT
};
Situation situation_of(State state, Mode mode, const RunState &run);

/// Null: accepted; else the reason for the rejection.
const char *refusal_of(CommandClass what, Situation situation);
/// As refusal_of(), as a Result.
Result<> admit(CommandClass what, Situation situation);

/// docs/reference/states.md.
std::string states_page();

}  // namespace mw::task
