// SPDX-License-Identifier: GPL-2.0-or-later
// Which command is taken in which situation: one table, from which docs/reference/states.md is made.
#pragma once

#include <string>

#include "base/result.hh"
#include "machine/task/run/command_classes.hh"
#include "machine/task/run/run_state.hh"

namespace mw::task {

/// What the machine is doing, as far as it decides which commands are taken.
enum class Situation : std::uint8_t {
    ESTOP,
    OFF,
    MANUAL,
    AUTO_IDLE,
    AUTO_RUNNING,   ///< reading, cutting, waiting, stepping
    AUTO_HELD,      ///< by the operator, M0, M1 or M60
    AUTO_PROPOSED,  ///< an approach waits for its confirmation
    AUTO_AWAY,      ///< the axes of a held program are released
    MDI_IDLE,
    MDI_RUNNING,
    MDI_HELD,
    COUNT
};
Situation situation_of(State state, Mode mode, const RunState &run);

/// Null: taken; else the reason why not.
const char *refusal_of(CommandClass what, Situation situation);
/// The same as a result.
Result<> admit(CommandClass what, Situation situation);

/// docs/reference/states.md.
std::string states_page();

}  // namespace mw::task
